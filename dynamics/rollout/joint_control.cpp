#include "dynamics/rollout/joint_control.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace possibility::dynamics {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

void CheckGains(const char* what, const VectorXd& gains, int size) {
  if (gains.size() != 0 && gains.size() != size) {
    throw std::invalid_argument(
        fmt::format("JointControl: {} has {} elements, expected {}", what, gains.size(), size));
  }
  for (Eigen::Index i = 0; i < gains.size(); ++i) {
    if (!(gains[i] >= 0) || !std::isfinite(gains[i])) {
      throw std::invalid_argument(fmt::format(
          "JointControl: {} {} is {}, expected a finite number >= 0", what, i, gains[i]));
    }
  }
}

void CheckCommand(const char* what, const VectorXd& values, Eigen::Index size, double t) {
  if (values.size() == size && values.allFinite()) return;
  throw std::invalid_argument(fmt::format(
      "JointControl: the {} commanded at t = {} s is not {} finite numbers", what, t, size));
}

}  // namespace

JointTorques::JointTorques(const MultibodyModel& model, JointControl control)
    : control_(std::move(control)), lower_(-model.effort()), upper_(model.effort()) {
  CheckGains("stiffness", control_.stiffness, model.num_joints());
  CheckGains("damping", control_.damping, model.num_joints());
  for (const ContactPoint& point : control_.gravity_support) {
    if (point.link >= 0 && point.link < model.tree().num_links() && point.p_L.allFinite()) continue;
    throw std::invalid_argument(fmt::format(
        "JointControl: a point of the gravity support is on link {} or not finite, expected a link "
        "from 0 to {}",
        point.link, model.tree().num_links() - 1));
  }
}

const VectorXd& JointTorques::Evaluate(double t, const Eigen::Ref<const VectorXd>& q,
                                       const Eigen::Ref<const VectorXd>& v, bool is_supported,
                                       MultibodyDynamics* dynamics) {
  const Eigen::Index joints = upper_.size();
  command_.position.setZero(joints);
  command_.velocity.setZero(joints);
  command_.torque.setZero(joints);
  if (control_.command) {
    control_.command(t, &command_);
    CheckCommand("position", command_.position, joints, t);
    CheckCommand("velocity", command_.velocity, joints, t);
    CheckCommand("torque", command_.torque, joints, t);
  }
  torques_ = command_.torque;
  if (control_.stiffness.size() != 0) {
    torques_ += control_.stiffness.cwiseProduct(command_.position - q.tail(joints));
  }
  if (control_.damping.size() != 0) {
    torques_ += control_.damping.cwiseProduct(command_.velocity - v.tail(joints));
  }
  if (control_.compensates_gravity && is_supported) AddGravityCompensation(dynamics);
  Clamp(v, dynamics->model());
  return torques_;
}

void JointTorques::Clamp(const Eigen::Ref<const VectorXd>& v, const MultibodyModel& model) {
  for (int i = 0; model.has_lines() && i < model.num_joints(); ++i) {
    upper_[i] = model.TorqueLimit(i, 1, v);
    lower_[i] = -model.TorqueLimit(i, -1, v);
  }
  torques_ = torques_.cwiseMin(upper_).cwiseMax(lower_);
}

VectorXd JointTorques::Active(const VectorXd& gains) const {
  if (gains.size() == 0) return VectorXd::Zero(upper_.size());
  return (torques_.array() < upper_.array() && torques_.array() > lower_.array()).select(gains, 0);
}

/// The robot as one rigid body (joints locked) at rest on its support: base acceleration a and
/// forces f of least norm with M_bb a + g_b = J_b' f, J_b a = 0; then the joint rows of
/// M (a, 0) + g - J' f.
void JointTorques::AddGravityCompensation(MultibodyDynamics* dynamics) {
  const MultibodyModel& model = dynamics->model();
  const int base = model.num_base_velocities(), joints = model.num_joints();
  MatrixXd com_jacobian;
  dynamics->kinematics().CentreOfMassJacobian(&com_jacobian);
  const VectorXd gravity = model.IndependentForces(dynamics->kinematics().total_mass() * kGravity *
                                                   com_jacobian.row(2).transpose());
  const MatrixXd& M = dynamics->MassMatrix();
  const Eigen::LLT<MatrixXd> locked(M.topLeftCorner(base, base));

  const std::vector<ContactPoint>& points = control_.gravity_support;
  MatrixXd J(3 * points.size(), model.nv());
  for (size_t i = 0; i < points.size(); ++i) {
    dynamics->Jacobian(points[i], J.middleRows<3>(3 * i));
  }
  const MatrixXd Jb = J.leftCols(base);
  VectorXd forces = VectorXd::Zero(J.rows());
  if (!points.empty()) {
    const MatrixXd gram = Jb * locked.solve(Jb.transpose());
    Eigen::CompleteOrthogonalDecomposition<MatrixXd> solver;
    solver.setThreshold(1e-10);
    forces = solver.compute(gram).solve(Jb * locked.solve(gravity.head(base)));
  }
  const VectorXd acceleration = locked.solve(Jb.transpose() * forces - gravity.head(base));
  torques_ += gravity.tail(joints) + M.bottomLeftCorner(joints, base) * acceleration -
              J.rightCols(joints).transpose() * forces;
}

}  // namespace possibility::dynamics
