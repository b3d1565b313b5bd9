#pragma once

#include "actions/plan/plan.h"
#include "models/robot/robot_model.h"
#include "models/world/environment.h"
#include "models/world/ground_map.h"

namespace possibility::actions {

/// The least reserve of one kind over a plan, and where it is.
struct Margin {
  double value = 0;
  int segment = -1;  ///< index; -1: the plan has nothing to measure
  double time = 0;   ///< s
};

/// How near a plan comes to its limits, at its knots. The verifier's limits hold between knots too.
struct PlanMargins {
  /// m: centre of pressure from the edge of the convex hull of the bearing points, inside positive.
  /// Knots whose bearing points differ in height have none.
  Margin zmp;
  Margin ground_edge;  ///< m: bearing points from the edge of their ground
  Margin torque;       ///< greatest share of a joint's effort that is used
  Margin friction;     ///< greatest share of a point's friction cone that is used
  Margin joint_speed;  ///< greatest share of a joint's speed that is used
  /// m: between links that may collide, and between links and obstacles that are not ground. At
  /// most kFarthest.
  Margin self_distance;
  Margin obstacle_distance;

  static constexpr double kFarthest = 0.1;
};

/// `plan`: of valid structure for `robot`.
/// @throws InputError if a contact is not the robot's.
PlanMargins MeasureMargins(const Plan& plan, const models::RobotModel& robot,
                           const models::Environment& environment, const models::GroundMap& ground);

}  // namespace possibility::actions
