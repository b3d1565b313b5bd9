#include "actions/onboarding/pace_limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

namespace possibility::actions {
namespace {

constexpr double kRootRises[] = {0.035, 0.07, 0.105, 0};  // of its height, in the order tried
constexpr double kQuicker = 1.1;

}  // namespace

Pace PaceOf(const models::Gait& gait, double length, double swing, double rise) {
  const models::GaitParameters& p = gait.parameters;
  Pace pace;
  pace.bounds = {length * p.forward, p.lateral, p.turn};
  pace.timing.swing = swing * p.swing_time;
  pace.timing.swing_length = pace.bounds.forward;
  pace.timing.double_support = 0.12 * p.swing_time;
  pace.timing.start = 0.7 * p.swing_time;
  pace.rise = rise * gait.posture.root_height;
  return pace;
}

PaceLimits::PaceLimits(const models::RobotModel& robot, const NominalStance& stance)
    : stance_(&stance), trial_(robot, stance) {}

bool PaceLimits::AllowsStep(const PlanarPose& step, double clearance) const {
  return std::any_of(std::begin(kRootRises), std::end(kRootRises), [&](double rise) {
    return trial_.WhyNot(PaceOf(*stance_->gait, 1, 0.9, rise), step, clearance).empty();
  });
}

bool PaceLimits::AllowsSlowestPace(double clearance) const {
  return std::any_of(std::begin(kRootRises), std::end(kRootRises), [&](double rise) {
    const Pace pace = PaceOf(*stance_->gait, 0.8, 1, rise);
    return trial_.WhyNot(pace, {pace.bounds.forward, 0, 0}, clearance).empty();
  });
}

std::optional<Pace> PaceLimits::Quickest(double clearance) const {
  const models::GaitParameters& p = stance_->gait->parameters;
  std::vector<Pace> paces;
  for (const double length : {1.6, 1.4, 1.2, 1.0, 0.8}) {
    for (const double swing : {0.6, 0.8, 1.0}) {
      for (const double rise : kRootRises) {
        paces.push_back(PaceOf(*stance_->gait, length, swing, rise));
      }
    }
  }
  std::stable_sort(paces.begin(), paces.end(),
                   [](const Pace& a, const Pace& b) { return a.speed() > b.speed(); });
  const auto fits = [&](const Pace& pace) {
    return trial_.WhyNot(pace, {pace.bounds.forward, 0, 0}, clearance).empty() &&
           trial_.WhyNot(pace, {0, p.lateral, 0}, clearance).empty() &&
           trial_.WhyNot(pace, {0, 0, p.turn}, clearance).empty();
  };
  const auto found = std::find_if(paces.begin(), paces.end(), fits);
  if (found == paces.end()) return std::nullopt;
  return *found;
}

std::string PaceLimits::BindingLimit(const std::vector<Pace>& paces) const {
  const models::GaitParameters& p = stance_->gait->parameters;
  Pace pace = PaceOf(*stance_->gait, 0.8, 1, kRootRises[0]);
  if (!paces.empty()) {
    pace = paces.front();
    pace.bounds.forward *= kQuicker;
    pace.timing.swing_length = pace.bounds.forward;
  }
  const std::pair<const char*, PlanarPose> steps[] = {{"ahead", {pace.bounds.forward, 0, 0}},
                                                      {"aside", {0, p.lateral, 0}},
                                                      {"in turns", {0, 0, p.turn}}};
  for (const auto& [where, step] : steps) {
    const std::string why = trial_.WhyNot(pace, step, kFittedClearance);
    if (!why.empty()) return fmt::format("{}, {}", where, why);
  }
  return "the family of paces ends";
}

}  // namespace possibility::actions
