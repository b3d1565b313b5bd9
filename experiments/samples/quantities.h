#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "actions/evidence/verifier_state.h"
#include "actions/plan/plan.h"
#include "actions/rollout/rollout_gains.h"
#include "actions/verify/plan_margins.h"
#include "models/robot/robot_model.h"

namespace possibility::experiments {

/// Name and unit of one component of a vector.
struct Quantity {
  std::string name;  ///< "root_qw", "root_x", or a joint's name
  std::string unit;  ///< "1", "m", "rad", "m/s", ...
};

/// Components of q, v, a and tau, in the order of models::RobotModel.
std::vector<Quantity> ConfigurationQuantities(const models::RobotModel& robot);
std::vector<Quantity> VelocityQuantities(const models::RobotModel& robot);
std::vector<Quantity> AccelerationQuantities(const models::RobotModel& robot);
std::vector<Quantity> TorqueQuantities(const models::RobotModel& robot);

/// All points on which the robot may bear, patch after patch.
std::vector<actions::BearingPoint> AllContactPoints(const models::RobotModel& robot);
/// "left_sole_2".
std::string ContactColumn(const models::RobotModel& robot, const actions::BearingPoint& point);
/// For every column of Knot::forces in the phase: the index into AllContactPoints.
/// @throws InputError if a contact is not the robot's.
std::vector<int> BearingColumns(const models::RobotModel& robot, const actions::Phase& phase);

/// A margin of PlanMargins.
struct MarginQuantity {
  std::string name;  ///< as in `verify --json`
  std::string unit;  ///< "m", or "1" for a share of a limit
  actions::Margin actions::PlanMargins::*margin;
};
const std::vector<MarginQuantity>& MarginQuantities();

/// Joint feedback of rollouts (docs/rollouts.md), num_joints each: torque = tau + stiffness (q -
/// measured) + damping (v - measured). Zero for joints without a limit of effort.
struct JointGains {
  Eigen::VectorXd stiffness;  ///< N m/rad or N/m
  Eigen::VectorXd damping;    ///< N m s/rad or N s/m
};
JointGains GainsOf(const models::RobotModel& robot, const actions::RolloutGains& gains = {});

}  // namespace possibility::experiments
