#include "experiments/report/rollout_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

namespace possibility::experiments {
namespace {

using actions::PerturbedRollout;
using actions::RolloutDrift;
using actions::StretchRollout;

/// "falls at 4.21 s (walk)", with the first stretch that falls.
std::string OutcomeText(const actions::Plan& plan, const PerturbedRollout& rollout) {
  for (const StretchRollout& stretch : rollout.stretches) {
    const RolloutDrift& drift = stretch.drift;
    if (drift.survives()) continue;
    const std::string& action = plan.segments[stretch.segment].action;
    if (drift.fell_at) return fmt::format("falls at {:.2f} s ({})", *drift.fell_at, action);
    return fmt::format("{} ({})", drift.failure, action);
  }
  return "survives";
}

std::vector<std::string> Row(const actions::Plan& plan, const std::string& name,
                             const PerturbedRollout& rollout) {
  RolloutDrift worst;
  for (const StretchRollout& stretch : rollout.stretches) {
    const RolloutDrift& drift = stretch.drift;
    worst.worst_position = std::max(worst.worst_position, drift.worst_position);
    worst.worst_orientation = std::max(worst.worst_orientation, drift.worst_orientation);
    worst.worst_joint = std::max(worst.worst_joint, drift.worst_joint);
    worst.end_position = std::max(worst.end_position, drift.end_position);
    worst.torque_used = std::max(worst.torque_used, drift.torque_used);
    worst.slide = std::max(worst.slide, drift.slide);
  }
  return {name.empty() ? "none" : name,
          OutcomeText(plan, rollout),
          fmt::format("{:.4f}", worst.worst_position),
          fmt::format("{:.4f}", worst.worst_orientation),
          fmt::format("{:.4f}", worst.worst_joint),
          fmt::format("{:.4f}", worst.end_position),
          fmt::format("{:.2f}", worst.torque_used),
          fmt::format("{:.4f}", worst.slide)};
}

}  // namespace

TextTable RolloutTable(const actions::Plan& plan, const std::vector<std::string>& names,
                       const std::vector<PerturbedRollout>& rollouts) {
  TextTable table;
  table.text_columns = 2;
  table.header = {"perturbation", "outcome", "worst m", "worst rad",
                  "worst joint",  "end m",   "torque",  "slide m"};
  for (std::size_t i = 0; i < names.size(); ++i) {
    table.rows.push_back(Row(plan, names[i], rollouts[i]));
  }
  return table;
}

}  // namespace possibility::experiments
