#include "actions/wholebody/required_zero_moment_point.h"

namespace possibility::actions {

Eigen::Vector2d RequiredZeroMomentPoint(dynamics::MultibodyDynamics* dynamics, double ground) {
  const Eigen::VectorXd& forces = dynamics->InverseDynamics();
  const Eigen::Vector3d moment = forces.head<3>();  // about the root's origin
  const Eigen::Vector3d force = forces.segment<3>(3);
  const Eigen::Vector3d root = dynamics->kinematics().X_WL()[0].translation();
  const double height = root.z() - ground;
  return {root.x() - (height * force.x() + moment.y()) / force.z(),
          root.y() + (moment.x() - height * force.y()) / force.z()};
}

}  // namespace possibility::actions
