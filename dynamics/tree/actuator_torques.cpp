#include "dynamics/tree/actuator_torques.h"

namespace possibility::dynamics {

using Eigen::MatrixXd;
using Eigen::VectorXd;

ActuatorTorques::ActuatorTorques(const models::RobotModel& model) {
  for (int i = 0; i < model.num_joints(); ++i) {
    const models::Actuator& actuator = model.joints[i].actuator;
    if (actuator.HasLosses()) joints_.push_back({6 + i, actuator});
  }
}

void ActuatorTorques::SetVelocity(const Eigen::Ref<const VectorXd>& v) {
  for (ActuatedJoint& joint : joints_) joint.speed = v[joint.coordinate];
}

void ActuatorTorques::SetAcceleration(const Eigen::Ref<const VectorXd>& a) {
  for (ActuatedJoint& joint : joints_) joint.acceleration = a[joint.coordinate];
}

void ActuatorTorques::AddTorques(VectorXd* forces) const {
  for (const ActuatedJoint& joint : joints_) {
    (*forces)[joint.coordinate] +=
        joint.actuator.armature * joint.acceleration + joint.actuator.Friction(joint.speed);
  }
}

void ActuatorTorques::AddInertia(MatrixXd* mass_matrix) const {
  for (const ActuatedJoint& joint : joints_) {
    (*mass_matrix)(joint.coordinate, joint.coordinate) += joint.actuator.armature;
  }
}

void ActuatorTorques::AddDerivatives(MatrixXd* dv, MatrixXd* da) const {
  for (const ActuatedJoint& joint : joints_) {
    const int c = joint.coordinate;
    (*dv)(c, c) += joint.actuator.FrictionSlope(joint.speed);
    (*da)(c, c) += joint.actuator.armature;
  }
}

void ActuatorTorques::AddHessian(const Eigen::Ref<const VectorXd>& lambda, MatrixXd* vv) const {
  for (const ActuatedJoint& joint : joints_) {
    const int c = joint.coordinate;
    (*vv)(c, c) += lambda[c] * joint.actuator.FrictionCurvature(joint.speed);
  }
}

}  // namespace possibility::dynamics
