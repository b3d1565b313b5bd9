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

}  // namespace possibility::dynamics
