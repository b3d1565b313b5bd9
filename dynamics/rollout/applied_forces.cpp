#include "dynamics/rollout/applied_forces.h"

#include <utility>

namespace possibility::dynamics {

using Eigen::MatrixXd;
using Eigen::VectorXd;

AppliedForces::AppliedForces(const MultibodyModel& model, JointControl control, RootPush push)
    : torques_(model, std::move(control)), push_(std::move(push)) {
  generalised_.setZero(model.nv());
}

const VectorXd& AppliedForces::Evaluate(double t, const Eigen::Ref<const VectorXd>& q,
                                        const Eigen::Ref<const VectorXd>& v, bool is_supported,
                                        MultibodyDynamics* dynamics) {
  const MultibodyModel& model = dynamics->model();
  generalised_.tail(model.num_joints()) = torques_.Evaluate(t, q, v, is_supported, dynamics);
  if (push_) {
    const Eigen::Vector3d force = push_(t);
    const Eigen::Matrix3d& R = dynamics->kinematics().X_WL()[0].linear();
    generalised_.head<3>() = (R * model.tree().links[0].inertial.p_LC).cross(force);
    generalised_.segment<3>(3) = force;
  }
  return generalised_;
}

VectorXd FrictionSlopes(const MultibodyModel& model, const Eigen::Ref<const VectorXd>& v) {
  VectorXd slopes(model.num_joints());
  for (int i = 0; i < model.num_joints(); ++i) {
    slopes[i] = model.actuator(i).FrictionSlope(v[model.num_base_velocities() + i]);
  }
  return slopes;
}

void StateRateJacobian(const MultibodyModel& model, const Eigen::Ref<const VectorXd>& q,
                       const MatrixXd& to_position, const MatrixXd& to_velocity,
                       Eigen::Ref<MatrixXd> jacobian) {
  const int nq = model.nq(), nv = model.nv();
  MatrixXd rates(nq, nv);  // of the configuration, per velocity
  for (int i = 0; i < nv; ++i) {
    rates.col(i) = model.ConfigurationRate(q, VectorXd::Unit(nv, i));
  }
  jacobian.setZero();
  jacobian.topRightCorner(nq, nv) = rates;
  jacobian.bottomRightCorner(nv, nv) = to_velocity;
  auto by_position = jacobian.bottomLeftCorner(nv, nq);
  if (nq == nv) {
    by_position = to_position;
    return;
  }
  // The columns of the rates of a unit quaternion are orthogonal and of length 1/2.
  by_position.leftCols(4) = 4 * to_position.leftCols(3) * rates.topLeftCorner(4, 3).transpose();
  by_position.rightCols(nv - 3) = to_position.rightCols(nv - 3);
}

}  // namespace possibility::dynamics
