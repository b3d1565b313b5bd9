#include "experiments/program/rollout_command.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "actions/verify/perturbed_rollouts.h"
#include "common/stopwatch.h"
#include "experiments/program/loaded_plan.h"
#include "experiments/program/perturbation_option.h"
#include "experiments/report/text_table.h"
#include "experiments/support/hardware_threads.h"
#include "experiments/support/standard_streams.h"
#include "models/input/input_error.h"
#include "models/input/json_text.h"

namespace possibility::experiments {
namespace {

using actions::PerturbedRollout;
using actions::RolloutDrift;
using actions::StretchRollout;

struct RolloutOptions {
  std::string plan;
  std::string robot;
  std::string scenario;
  std::vector<std::string> perturbations;
  bool json = false;
};

/// Rewrites "simulation 12 of 65  1:20 left" on stderr, if it is a terminal.
class RolloutProgress {
 public:
  void Show(int done, int all) const {
    if (isatty(STDERR_FILENO) == 0) return;
    const int left = static_cast<int>(stopwatch_.Seconds() / done * (all - done));
    PrintError("\rsimulation {} of {}  {}:{:02} left {}", done, all, left / 60, left % 60,
               done == all ? "\r\x1b[K" : "");
  }

 private:
  Stopwatch stopwatch_;
};

/// "falls at 4.21 s (walk)", with the first stretch that falls.
std::string OutcomeText(const actions::Plan& plan, const PerturbedRollout& rollout) {
  for (const StretchRollout& stretch : rollout.stretches) {
    const RolloutDrift& drift = stretch.drift;
    if (drift.survives()) continue;
    const std::string& action = plan.segments[stretch.segment].action;
    if (drift.fell_at) return fmt::format("falls at {:.2f} s ({})", *drift.fell_at, action);
    if (drift.slipped_at) return fmt::format("slips at {:.2f} s ({})", *drift.slipped_at, action);
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
    worst.friction_used = std::max(worst.friction_used, drift.friction_used);
  }
  return {name.empty() ? "none" : name,
          OutcomeText(plan, rollout),
          fmt::format("{:.4f}", worst.worst_position),
          fmt::format("{:.4f}", worst.worst_orientation),
          fmt::format("{:.4f}", worst.worst_joint),
          fmt::format("{:.4f}", worst.end_position),
          fmt::format("{:.2f}", worst.torque_used),
          fmt::format("{:.2f}", worst.friction_used)};
}

void PrintTable(const actions::Plan& plan, const std::vector<NamedPerturbation>& cases,
                const std::vector<PerturbedRollout>& rollouts) {
  TextTable table;
  table.text_columns = 2;
  table.header = {"perturbation", "outcome", "worst m", "worst rad",
                  "worst joint",  "end m",   "torque",  "friction"};
  for (std::size_t i = 0; i < cases.size(); ++i) {
    table.rows.push_back(Row(plan, cases[i].text, rollouts[i]));
  }
  PrintOut("{}", table.Markdown());
}

nlohmann::ordered_json ToJson(const StretchRollout& stretch) {
  const RolloutDrift& drift = stretch.drift;
  nlohmann::ordered_json json = {{"segment", stretch.segment},
                                 {"last_segment", stretch.last_segment},
                                 {"start_s", drift.start},
                                 {"end_s", drift.end},
                                 {"survives", drift.survives()},
                                 {"fell_at_s", nullptr},
                                 {"slipped_at_s", nullptr},
                                 {"worst_position_m", drift.worst_position},
                                 {"worst_orientation_rad", drift.worst_orientation},
                                 {"worst_joint", drift.worst_joint},
                                 {"end_position_m", drift.end_position},
                                 {"end_orientation_rad", drift.end_orientation},
                                 {"torque_used", drift.torque_used},
                                 {"friction_used", drift.friction_used},
                                 {"failure", drift.failure}};
  if (drift.fell_at) json["fell_at_s"] = *drift.fell_at;
  if (drift.slipped_at) json["slipped_at_s"] = *drift.slipped_at;
  return json;
}

void PrintJson(const LoadedPlan& loaded, const std::vector<NamedPerturbation>& cases,
               const std::vector<PerturbedRollout>& rollouts) {
  nlohmann::ordered_json json = {{"plan", loaded.file.string()},
                                 {"cases", nlohmann::ordered_json::array()}};
  for (std::size_t i = 0; i < cases.size(); ++i) {
    nlohmann::ordered_json entry = {{"perturbation", nlohmann::ordered_json::object()},
                                    {"survives", rollouts[i].survives()},
                                    {"stretches", nlohmann::ordered_json::array()}};
    for (const auto& [name, value] : cases[i].values) entry["perturbation"][name] = value;
    for (const StretchRollout& stretch : rollouts[i].stretches) {
      entry["stretches"].push_back(ToJson(stretch));
    }
    json["cases"].push_back(entry);
  }
  PrintOut("{}\n", models::JsonText(json));
}

/// A plan that breaks other rules has no motion worth simulating.
/// @throws InputError with the first violation.
void RequireRules(const LoadedPlan& loaded) {
  actions::VerifierSettings settings;
  settings.threads = HardwareThreads();
  settings.simulates = false;
  const actions::VerificationReport report =
      actions::Verify(loaded.plan, loaded.robot, loaded.scenario, settings);
  if (report.accepted()) return;
  const actions::Violation& violation = report.violations.front();
  throw InputError(
      fmt::format("{}: the plan is not simulated because it is rejected: {}, {} "
                  "(see possibility verify)",
                  loaded.file.string(), ToString(violation.kind), violation.quantity));
}

ExitCode RunRollout(const RolloutOptions& options) {
  std::vector<NamedPerturbation> cases;
  for (const std::string& text : options.perturbations) cases.push_back(ParsePerturbation(text));
  if (cases.empty()) cases = UsualPerturbations();
  const LoadedPlan loaded = LoadPlanToVerify(options.plan, {options.robot, options.scenario});
  RequireMotion(loaded);
  RequireRules(loaded);
  std::vector<actions::Perturbation> perturbations;
  perturbations.reserve(cases.size());
  for (const NamedPerturbation& named : cases) perturbations.push_back(named.perturbation);
  const RolloutProgress progress;
  actions::PerturbedRolloutSettings settings;
  settings.threads = HardwareThreads();
  settings.progress = [&progress](int done, int all) { progress.Show(done, all); };
  const std::vector<PerturbedRollout> rollouts = actions::RollOutPerturbed(
      loaded.plan, loaded.robot, loaded.scenario, perturbations, settings);
  options.json ? PrintJson(loaded, cases, rollouts) : PrintTable(loaded.plan, cases, rollouts);
  const bool all_survive =
      std::all_of(rollouts.begin(), rollouts.end(),
                  [](const PerturbedRollout& rollout) { return rollout.survives(); });
  return all_survive ? kDone : kVerificationFailed;
}

}  // namespace

Command AddRolloutCommand(CLI::App& program) {
  CommandOptions command(program, "rollout",
                         "Simulates a plan on a perturbed robot and ground, and says who falls.");
  auto options = std::make_shared<RolloutOptions>();
  command.AddRequired("PLAN", &options->plan, "plan.json or its folder");
  command.AddOptional("--perturb", &options->perturbations,
                      "One case, such as mass=1.05,slope_deg=1; repeatable (default: a usual set)");
  command.AddOptional("--robot", &options->robot, "Robot YAML (default: the scenario's)");
  command.AddOptional("--scenario", &options->scenario, "Scenario YAML (default: the plan's)");
  command.AddFlag("--json", &options->json, "Print one JSON object");
  return {command, [options] { return RunRollout(*options); }};
}

}  // namespace possibility::experiments
