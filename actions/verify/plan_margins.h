#pragma once

#include <memory>

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

  /// Keeps the worse of each kind, of equals the one it has.
  void Add(const PlanMargins& later);
};

/// `plan`: of valid structure for `robot`.
/// @throws InputError if a contact is not the robot's.
PlanMargins MeasureMargins(const Plan& plan, const models::RobotModel& robot,
                           const models::Environment& environment, const models::GroundMap& ground);

class MarginMeasurement;

/// The margins of single phases. One per thread. The constructor's arguments must outlive it.
class PhaseMeasurement {
 public:
  PhaseMeasurement(const models::RobotModel& robot, const models::Environment& environment,
                   const models::GroundMap& ground);
  ~PhaseMeasurement();

  /// Over all knots; Margin::segment is 0 where there is something to measure.
  PlanMargins Of(const Phase& phase);

 private:
  std::unique_ptr<MarginMeasurement> measurement_;
};

/// The margins of single instants. One per thread. The constructor's arguments must outlive it.
class InstantMargins {
 public:
  InstantMargins(const models::RobotModel& robot, const models::Environment& environment,
                 const models::GroundMap& ground);
  ~InstantMargins();

  /// `knot`: of the phase; both fit the robot's sizes. The segment of a margin is -1 if there is
  /// nothing to measure. @throws InputError if a contact is not the robot's.
  PlanMargins At(int segment, const Phase& phase, const Knot& knot);

 private:
  std::unique_ptr<MarginMeasurement> measurement_;
};

}  // namespace possibility::actions
