#include "actions/gait/pace_fit.h"

#include <algorithm>
#include <cstddef>

namespace possibility::actions {
namespace {

/// Family of paces: lengths of steps and durations of swings and double supports, in multiples of
/// quasi-static strides' bounds and swing time.
constexpr double kLengths[] = {1.6, 1.5, 1.4, 1.3, 1.2, 1.1, 1.0, 0.8};
constexpr double kSwings[] = {0.6, 0.7, 0.8, 0.9, 1.0};
constexpr double kDoubleSupport = 0.12;
constexpr double kStart = 0.7;  // start and stop, in which the root rises and comes down
/// Sideways and turning steps, in multiples of strides; one limb closes up to the other.
constexpr double kAside[] = {3, 2.8, 2.6, 2.4, 2.2, 2, 1.8, 1.6, 1.4, 1.2, 1};

/// Rises of the root in motion, as shares of its height: straighter legs bear with less torque.
constexpr double kRises[] = {0.14, 0.105, 0.07, 0.035, 0};

/// Beside the quickest pace, the quickest below this share of its speed is kept.
constexpr double kSlowPace = 0.6;

/// Family of paces of a gait, quickest first.
std::vector<Pace> Candidates(const models::GaitParameters& parameters, double height,
                             std::size_t groups) {
  std::vector<Pace> paces;
  for (const double length : kLengths) {
    for (const double swing : kSwings) {
      Pace pace;
      pace.groups = static_cast<int>(groups);
      pace.bounds = {length * parameters.forward, parameters.lateral, parameters.turn};
      pace.timing.swing = swing * parameters.swing_time;
      pace.timing.swing_length = pace.bounds.forward;
      pace.timing.double_support = kDoubleSupport * parameters.swing_time;
      pace.timing.start = kStart * parameters.swing_time;
      for (const double rise : kRises) {
        pace.rise = rise * height;
        paces.push_back(pace);
      }
    }
  }
  std::stable_sort(paces.begin(), paces.end(),
                   [](const Pace& a, const Pace& b) { return a.speed() > b.speed(); });
  return paces;
}

}  // namespace

std::vector<Pace> FitPaces(const models::RobotModel& robot, const NominalStance& stance) {
  const PaceTrial trial(robot, stance);
  const models::GaitParameters& parameters = stance.gait->parameters;
  std::vector<Pace> paces;
  for (const Pace& candidate :
       Candidates(parameters, stance.gait->posture.root_height, SwingGroups(stance).size())) {
    if (!paces.empty() && candidate.speed() > kSlowPace * paces.front().speed()) continue;
    if (!trial.Allows(candidate, {candidate.bounds.forward, 0, 0})) continue;
    const std::optional<Pace> pace = WithStepsAside(trial, parameters, candidate);
    if (!pace) continue;
    paces.push_back(*pace);
    if (paces.size() == 2) break;
  }
  return paces;
}

std::optional<Pace> WithStepsAside(const PaceTrial& trial, const models::GaitParameters& parameters,
                                   Pace pace) {
  const auto longest = [&](double unit, double* bound, const auto& step) {
    for (const double length : kAside) {
      *bound = length * unit;
      // To one side only: every motion is checked by itself, and robots are about symmetric.
      if (trial.Allows(pace, step(*bound))) return true;
    }
    return false;
  };
  if (!longest(parameters.lateral, &pace.bounds.lateral,
               [](double y) {
                 return PlanarPose{0, y, 0};
               }) ||
      !longest(parameters.turn, &pace.bounds.turn, [](double yaw) {
        return PlanarPose{0, 0, yaw};
      })) {
    return std::nullopt;
  }
  return pace;
}

}  // namespace possibility::actions
