#pragma once

#include <Eigen/Core>

#include "dynamics/tree/multibody_model.h"

namespace possibility::dynamics {

/// An instant of a robot's motion in the coordinates of models::RobotModel: a quaternion for the
/// root, an entry for every joint.
struct FloatingMotion {
  Eigen::VectorXd q, v, a;
};

/// The same instant of a robot on joints: q, v, a of `model` (Base::kJoints), nv each. Locked and
/// mimic joints are included. @throws std::invalid_argument for a wrong size or base.
FloatingMotion ToFloating(const MultibodyModel& model, const Eigen::Ref<const Eigen::VectorXd>& q,
                          const Eigen::Ref<const Eigen::VectorXd>& v,
                          const Eigen::Ref<const Eigen::VectorXd>& a);

/// The inverse, of positions alone: q of `model` (nv), with yaw and pitch in [-pi, pi] and roll in
/// [-pi / 2, pi / 2]. `q`: 7 + joints. Locked and mimic joints are left out.
/// @throws std::invalid_argument for a wrong size or base.
Eigen::VectorXd FromFloating(const MultibodyModel& model,
                             const Eigen::Ref<const Eigen::VectorXd>& q);

}  // namespace possibility::dynamics
