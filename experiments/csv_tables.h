#pragma once

#include <string>
#include <vector>

#include "actions/plan.h"
#include "models/robot_model.h"

namespace possibility::experiments {

/// The robot's state at one instant, and the phase that it belongs to.
struct PlanSample {
  int segment = 0;
  const actions::Phase* phase = nullptr;  ///< of the plan that was sampled
  actions::Knot knot;
};

/// Every knot of every phase; where two phases meet there are two, as tau and forces may jump.
std::vector<PlanSample> SamplesAtKnots(const actions::Plan& plan);

/// Samples `step` s apart from the beginning, and the end. Where two phases meet: the later one.
/// @throws InputError if that is more than ten million samples.
std::vector<PlanSample> SamplesEvery(const actions::Plan& plan, double step);

/// One row per sample: t, segment, action, q, v, a, tau, each component in its own column
/// (docs/command_line.md). Numbers read back to the same value.
std::string TrajectoryCsv(const std::vector<PlanSample>& samples, const actions::Plan& plan,
                          const models::RobotModel& robot);

/// One row per sample and bearing contact point: t, segment, patch, point, its position x, y, z
/// (m, world) and the force on the robot fx, fy, fz (N, world).
/// @throws InputError if a contact is not the robot's.
std::string ContactForcesCsv(const std::vector<PlanSample>& samples, const actions::Plan& plan,
                             const models::RobotModel& robot);

}  // namespace possibility::experiments
