#include "dynamics/tree/tree_derivatives.h"

#include "models/robot/cross_matrix.h"

namespace possibility::dynamics {

using Eigen::Matrix3d;
using Eigen::Vector3d;

TreeDerivatives::TreeDerivatives(const models::RobotModel& model)
    : motion_(model), actuators_(model), hessian_(model) {
  const int nv = model.nv();
  mass_matrix_.setZero(nv, nv);
  derivatives_.dq = derivatives_.dv = derivatives_.da = mass_matrix_;
  centroidal_.jacobian.setZero(3, nv);
  centroidal_.momentum.setZero(6);
  centroidal_.momentum_dq.setZero(6, nv);
  centroidal_.momentum_dv.setZero(6, nv);
}

const Eigen::VectorXd& TreeDerivatives::InverseDynamics() {
  if (actuators_.empty()) return motion_.InverseDynamics();
  forces_ = motion_.InverseDynamics();
  actuators_.AddTorques(&forces_);
  return forces_;
}

const HessianProduct& TreeDerivatives::Hessian(const Eigen::Ref<const Eigen::VectorXd>& lambda,
                                               const std::vector<PointTerm>& terms) {
  const HessianProduct& links = hessian_.Compute(motion_, lambda, terms);
  if (actuators_.empty()) return links;
  with_actuators_ = links;
  actuators_.AddHessian(lambda, &with_actuators_.vv);
  return with_actuators_;
}

Vector3d TreeDerivatives::Position(int link, const Vector3d& p_L) const {
  return motion_.kinematics().Position(link, p_L);
}

Vector3d TreeDerivatives::Velocity(int link, const Vector3d& p_L) const {
  return MotionOf(motion_, link, p_L).velocity + motion_.origin_velocity();
}

Vector3d TreeDerivatives::Acceleration(int link, const Vector3d& p_L) const {
  return MotionOf(motion_, link, p_L).acceleration - Vector3d(0, 0, kGravity);
}

const PointDerivatives& TreeDerivatives::DifferentiatePoint(int link, const Vector3d& p_L) {
  dynamics::DifferentiatePoint(motion_, link, p_L, &point_);
  return point_;
}

namespace {

/// The spatial inertia as a 6 x 6 matrix.
Eigen::Matrix<double, 6, 6> InertiaMatrix(double mass, const Vector3d& moment,
                                          const Matrix3d& inertia) {
  Eigen::Matrix<double, 6, 6> I;
  const Matrix3d cross = models::CrossMatrix(moment);
  I << inertia, cross, -cross, mass * Matrix3d::Identity();
  return I;
}

}  // namespace

const Eigen::MatrixXd& TreeDerivatives::MassMatrix() {
  const SpatialBody& all = motion_.subtree(0);
  mass_matrix_.topLeftCorner<6, 6>() = InertiaMatrix(all.mass, all.moment, all.inertia);
  for (int i = motion_.num_links() - 1; i > 0; --i) {
    const int c = TreeMotion::Coordinate(i);
    const SpatialVector inertia = motion_.subtree(i).Inertia(motion_.axis(c).S);
    for (int j = i; j > 0; j = motion_.parent(j)) {
      const int d = TreeMotion::Coordinate(j);
      mass_matrix_(c, d) = mass_matrix_(d, c) = Dot(motion_.axis(d).S, inertia);
    }
    StoreColumn(inertia, c, &mass_matrix_);
    StoreRow(inertia, c, &mass_matrix_);
  }
  actuators_.AddInertia(&mass_matrix_);
  return mass_matrix_;
}

const InverseDynamicsDerivatives& TreeDerivatives::Differentiate() {
  derivatives_.forces = InverseDynamics();
  for (int i = motion_.num_links() - 1; i > 0; --i) DifferentiateJoint(i);
  DifferentiateRoot();
  actuators_.AddDerivatives(&derivatives_.dv, &derivatives_.da);
  return derivatives_;
}

void TreeDerivatives::DifferentiateJoint(int link) {
  const int c = TreeMotion::Coordinate(link);
  const TreeAxis& axis = motion_.axis(c);
  const SpatialBody& subtree = motion_.subtree(link);
  const SpatialVector da = subtree.Inertia(axis.S);
  const SpatialVector dv = 2 * (subtree.Coriolis(axis.S) + subtree.Inertia(axis.rate));
  const SpatialVector dq = 2 * subtree.Coriolis(axis.rate) + subtree.Inertia(axis.rate_rate) +
                           CrossForce(axis.S, subtree.force);
  const Vector3d t = 2 * subtree.CoriolisTransposed(axis.S);
  auto& D = derivatives_;
  for (int j = link; j > 0; j = motion_.parent(j)) {
    const int d = TreeMotion::Coordinate(j);
    const TreeAxis& other = motion_.axis(d);
    D.da(d, c) = D.da(c, d) = Dot(other.S, da);
    D.dv(c, d) = Dot(t, other.S.angular) + Dot(da, other.twice);
    D.dq(c, d) = Dot(t, other.rate.angular) + Dot(da, other.rate_rate);
    D.dv(d, c) = Dot(other.S, dv);
    D.dq(d, c) = Dot(other.S, dq);
  }
  StoreColumn(da, c, &D.da);
  StoreRow(da, c, &D.da);
  StoreColumn(dv, c, &D.dv);
  StoreColumn(dq, c, &D.dq);
  for (int d = 0; d < 3; ++d) {
    D.dv(c, d) = t[d] + Dot(da, motion_.axis(d).twice);
    D.dq(c, d) = Dot(t, motion_.axis(d).rate.angular) + Dot(da, motion_.axis(d).rate_rate);
  }
}

void TreeDerivatives::DifferentiateRoot() {
  const SpatialBody& all = motion_.subtree(0);
  auto& D = derivatives_;
  D.da.topLeftCorner<6, 6>() = InertiaMatrix(all.mass, all.moment, all.inertia);
  for (int d = 0; d < 3; ++d) {
    const TreeAxis& axis = motion_.axis(d);
    StoreColumn(2 * all.Coriolis(axis.S) + all.Inertia(axis.twice), d, &D.dv);
    StoreColumn(
        2 * all.Coriolis(axis.rate) + all.Inertia(axis.rate_rate) + CrossForce(axis.S, all.force),
        d, &D.dq);
  }
}

const CentroidalQuantities& TreeDerivatives::Centroidal() {
  const SpatialBody& all = motion_.subtree(0);
  auto& C = centroidal_;
  const Vector3d com = all.moment / all.mass;
  C.position = motion_.kinematics().X_WL()[0].translation() + com;
  C.momentum << all.Momentum().angular - Cross(com, all.momentum),
      all.momentum + all.mass * motion_.origin_velocity();
  const int nv = motion_.kinematics().model().nv();
  for (int c = 0; c < nv; ++c) {
    const SpatialBody& moved = c < 6 ? all : motion_.subtree(c - 5);
    const SpatialVector dv = moved.Inertia(motion_.axis(c).S);
    C.jacobian.col(c) = dv.linear / all.mass;
    C.momentum_dv.col(c) << dv.angular - Cross(com, dv.linear), dv.linear;
    const bool translates_all = c >= 3 && c < 6;
    if (translates_all) continue;  // their momentum_dq is zero
    const SpatialVector dq =
        CrossForce(motion_.axis(c).S, moved.Momentum()) + moved.Inertia(motion_.axis(c).rate);
    const Vector3d com_dq = C.jacobian.col(c);
    C.momentum_dq.col(c) << dq.angular - Cross(com_dq, all.momentum) - Cross(com, dq.linear),
        dq.linear;
  }
  return centroidal_;
}

}  // namespace possibility::dynamics
