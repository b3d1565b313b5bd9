#include "dynamics/tree/tree_hessian.h"

#include <algorithm>

namespace possibility::dynamics {

using Eigen::Matrix3d;
using Eigen::Vector3d;

TreeHessian::TreeHessian(const models::RobotModel& model)
    : w_(model.num_links()),
      virtual_rates_(model.nv()),
      virtual_bodies_(model.num_links()),
      forces_(model.num_links()) {
  const int nv = model.nv();
  for (Eigen::MatrixXd* m : {&hessian_.qq, &hessian_.qv, &hessian_.vv, &hessian_.qa}) {
    m->setZero(nv, nv);
  }
}

const HessianProduct& TreeHessian::Compute(const TreeMotion& motion,
                                           const Eigen::Ref<const Eigen::VectorXd>& lambda,
                                           const std::vector<PointTerm>& terms) {
  motion.CheckSize("lambda", lambda.size());
  motion_ = &motion;
  if (lambda.isZero(0)) {
    ClearDynamics();
  } else {
    AddDynamics(lambda, terms);
  }
  for (const PointTerm& term : terms) {
    const bool moves = !term.on_position.isZero(0) || !term.on_velocity.isZero(0) ||
                       !term.on_acceleration.isZero(0);
    if (moves) AddPointHessian(term);
  }
  // The root's rotations do not commute: the second derivative along a curve is the mean.
  const Matrix3d root = hessian_.qq.topLeftCorner<3, 3>();
  hessian_.qq.topLeftCorner<3, 3>() = (root + root.transpose()) / 2;
  return hessian_;
}

/// What AddDynamics leaves if the multipliers are zero.
void TreeHessian::ClearDynamics() {
  for (Eigen::MatrixXd* block : {&hessian_.qq, &hessian_.qv, &hessian_.vv, &hessian_.qa}) {
    block->setZero();
  }
  std::fill(w_.begin(), w_.end(), SpatialVector());
  std::fill(virtual_rates_.begin(), virtual_rates_.end(), SpatialVector());
}

void TreeHessian::AddDynamics(const Eigen::Ref<const Eigen::VectorXd>& lambda,
                              const std::vector<PointTerm>& terms) {
  FindVirtualMotion(lambda);
  for (int i = motion_->num_links() - 1; i > 0; --i) AddJointHessian(i);
  AddRootHessian();
  CollectForces(terms);
  for (int i = 0; i < motion_->num_links(); ++i) {
    if (forces_[i].any) AddForceHessian(i);
  }
}

void TreeHessian::FindVirtualMotion(const Eigen::Ref<const Eigen::VectorXd>& lambda) {
  w_[0] = {lambda.head<3>(), lambda.segment<3>(3)};
  for (int k = 0; k < 6; ++k) virtual_rates_[k] = CrossMotion(w_[0], motion_->axis(k).S);
  for (int i = 1; i < motion_->num_links(); ++i) {
    const int c = TreeMotion::Coordinate(i);
    const SpatialVector& S = motion_->axis(c).S;
    const SpatialVector& parent = w_[motion_->parent(i)];
    virtual_rates_[c] = CrossMotion(parent, S);
    w_[i] = parent + lambda[c] * S;
  }
  for (int i = 0; i < motion_->num_links(); ++i) {
    const SpatialBody& body = motion_->body(i);
    VirtualBody& result = virtual_bodies_[i];
    result.momentum = body.Inertia(w_[i]);
    result.coriolis = CoriolisMatrix(w_[i], body.moment, body.inertia);
    result.turning = body.CoriolisTransposed(w_[i]);
  }
  for (int i = motion_->num_links() - 1; i > 0; --i) {
    VirtualBody& parent = virtual_bodies_[motion_->parent(i)];
    parent.momentum += virtual_bodies_[i].momentum;
    parent.coriolis += virtual_bodies_[i].coriolis;
    parent.turning += virtual_bodies_[i].turning;
  }
}

void TreeHessian::AddJointHessian(int link) {
  const int c = TreeMotion::Coordinate(link);
  const TreeAxis& axis = motion_->axis(c);
  const SpatialVector& virtual_rate = virtual_rates_[c];
  const SpatialBody& subtree = motion_->subtree(link);
  const VirtualBody& dual = virtual_bodies_[link];
  const Vector3d rate_angular = axis.rate.angular;
  const Vector3d axis_angular = axis.S.angular;
  const SpatialVector turning{dual.turning, Vector3d::Zero()};

  // First derivatives of the subtree's force along this coordinate (DifferentiateJoint) ...
  const SpatialVector da = subtree.Inertia(axis.S);
  const SpatialVector dv = 2 * (subtree.Coriolis(axis.S) + subtree.Inertia(axis.rate));
  const SpatialVector dq = 2 * subtree.Coriolis(axis.rate) + subtree.Inertia(axis.rate_rate) +
                           CrossForce(axis.S, subtree.force);
  // ... and the factors of an outer coordinate's rates in the derivative of the gradient.
  const SpatialVector on_rate_rate =
      subtree.Inertia(virtual_rate) + CrossForce(axis.S, dual.momentum);
  const SpatialVector on_rate =
      2 * (SpatialVector{subtree.CoriolisTransposed(virtual_rate), Vector3d::Zero()} +
           CrossForce(axis.rate, dual.momentum) + dual.Turning(rate_angular) +
           CrossForce(axis.S, turning));
  const SpatialVector on_velocity =
      2 * (dual.Turning(axis_angular) + CrossForce(axis.S, dual.momentum));

  auto& H = hessian_;
  const auto pair = [&](int d) {
    const TreeAxis& outer = motion_->axis(d);
    const SpatialVector& outer_virtual_rate = virtual_rates_[d];
    H.qq(d, c) = H.qq(c, d) =
        Dot(dq, outer_virtual_rate) + Dot(on_rate, outer.rate) + Dot(on_rate_rate, outer.rate_rate);
    H.vv(d, c) = H.vv(c, d) = Dot(on_velocity, outer.S);
    H.qv(c, d) = Dot(on_rate_rate, outer.twice) + Dot(on_rate, outer.S);
    H.qv(d, c) = Dot(dv, outer_virtual_rate) + Dot(on_velocity, outer.rate);
    H.qa(c, d) = Dot(on_rate_rate, outer.S);
    H.qa(d, c) = Dot(da, outer_virtual_rate);
  };
  for (int d = 0; d < 3; ++d) pair(d);
  StoreRow(on_rate_rate, c, &H.qa);
  for (int j = motion_->parent(link); j > 0; j = motion_->parent(j)) {
    pair(TreeMotion::Coordinate(j));
  }
  pair(c);
}

void TreeHessian::AddRootHessian() {
  const SpatialBody& all = motion_->subtree(0);
  const VirtualBody& dual = virtual_bodies_[0];
  auto& H = hessian_;
  for (int d = 0; d < 3; ++d) {
    const TreeAxis& axis = motion_->axis(d);
    // Change of force, virtual momentum and turning under a rotation of the whole robot.
    const SpatialVector force =
        2 * all.Coriolis(axis.rate) + all.Inertia(axis.rate_rate) + CrossForce(axis.S, all.force);
    const SpatialVector momentum =
        CrossForce(axis.S, dual.momentum) + all.Inertia(virtual_rates_[d]);
    const Vector3d turning = axis.S.angular.cross(dual.turning) -
                             TransposedTimes(dual.coriolis, axis.rate.angular) +
                             all.CoriolisTransposed(virtual_rates_[d]);
    for (int c = 0; c < 3; ++c) {
      const TreeAxis& other = motion_->axis(c);
      H.qq(d, c) = Dot(virtual_rates_[c], force) + Dot(other.rate_rate, momentum) +
                   2 * Dot(other.rate.angular, turning);
      H.qv(d, c) = 2 * turning[c] + Dot(momentum, other.rate);
      H.vv(d, c) = 2 * dual.Turning(Vector3d::Unit(c)).angular[d] +
                   dual.momentum.angular.dot(Vector3d::Unit(d).cross(Vector3d::Unit(c)));
    }
    StoreRow(momentum, d, &H.qa);
  }
}

void TreeHessian::CollectForces(const std::vector<PointTerm>& terms) {
  for (LinkForces& forces : forces_) forces = {};
  for (const PointTerm& term : terms) {
    if (term.force.isZero(0)) continue;
    const Vector3d p = motion_->kinematics().Position(term.link, term.p_L) -
                       motion_->kinematics().X_WL()[0].translation();
    LinkForces& forces = forces_[term.link];
    forces.any = true;
    forces.wrench += {p.cross(term.force), term.force};
    forces.virial += term.force * p.transpose();
  }
}

void TreeHessian::AddForceHessian(int link) {
  auto& qq = hessian_.qq;
  for (int i = link; i > 0; i = motion_->parent(i)) {
    const int c = TreeMotion::Coordinate(i);
    const auto add = [&](int d) {
      const double second = ForcePair(link, d, c);
      qq(d, c) += second;
      if (d != c) qq(c, d) += second;
    };
    for (int j = i; j > 0; j = motion_->parent(j)) add(TreeMotion::Coordinate(j));
    for (int d = 0; d < 3; ++d) add(d);
  }
  for (int d = 0; d < 3; ++d) {
    for (int c = 0; c < 3; ++c) qq(d, c) += RootForcePair(link, d, c);
  }
}

/// Second derivative of the power of a link's forces under the multipliers.
double TreeHessian::ForcePair(int link, int outer, int inner) const {
  const LinkForces& forces = forces_[link];
  const Vector3d& s_j = motion_->axis(outer).S.angular;
  const Vector3d& s_k = motion_->axis(inner).S.angular;
  const SpatialVector& w = w_[link];
  // f' (s_j x (s_k x (w at p))): the double product, once for w's linear part and once for its
  // turn.
  const double turned_twice = Dot(forces.wrench.linear, Cross(s_j, Cross(s_k, w.linear))) +
                              Dot(Cross(s_j, w.angular), Times(forces.virial, s_k)) -
                              Dot(s_k, w.angular) * Dot(s_j, forces.wrench.angular);
  return turned_twice + forces.Turned(s_j, virtual_rates_[inner]) +
         Dot(forces.wrench, CrossMotion(virtual_rates_[outer], motion_->axis(inner).S)) +
         forces.Turned(s_k, virtual_rates_[outer]);
}

double TreeHessian::RootForcePair(int link, int j, int k) const {
  const LinkForces& forces = forces_[link];
  const Vector3d e_j = Vector3d::Unit(j);
  const Vector3d e_k = Vector3d::Unit(k);
  const SpatialVector& w = w_[link];
  const double turned_twice = Dot(forces.wrench.linear, Cross(e_k, Cross(e_j, w.linear))) +
                              Dot(Cross(e_k, w.angular), Times(forces.virial, e_j)) -
                              e_j.dot(w.angular) * Dot(e_k, forces.wrench.angular);
  return forces.Turned(virtual_rates_[k].angular, e_j) + forces.Turned(e_k, virtual_rates_[j]) +
         turned_twice;
}

void TreeHessian::DifferentiateVirtualVelocity(int link, const Vector3d& p_L,
                                               Eigen::MatrixXd* derivative) const {
  const Vector3d p =
      motion_->kinematics().Position(link, p_L) - motion_->kinematics().X_WL()[0].translation();
  const Vector3d virtual_velocity = VelocityAt(w_[link], p);
  derivative->setZero(3, static_cast<Eigen::Index>(virtual_rates_.size()));
  const auto fill = [&](int c) {
    derivative->col(c) =
        VelocityAt(virtual_rates_[c], p) + motion_->axis(c).S.angular.cross(virtual_velocity);
  };
  for (int c = 0; c < 3; ++c) fill(c);
  for (int i = link; i > 0; i = motion_->parent(i)) fill(TreeMotion::Coordinate(i));
}

void TreeHessian::AddPointHessian(const PointTerm& term) {
  const PointMotion point = MotionOf(*motion_, term.link, term.p_L);
  for (int i = term.link; i > 0; i = motion_->parent(i)) {
    for (int j = i; j > 0; j = motion_->parent(j)) {
      AddPointPair(term, point, TreeMotion::Coordinate(j), TreeMotion::Coordinate(i));
    }
    const int c = TreeMotion::Coordinate(i);
    for (int d = 0; d < 3; ++d) AddPointPair(term, point, d, c);
  }
  for (int d = 0; d < 3; ++d) {
    for (int c = 0; c < 3; ++c) AddRootPointPair(term, point, d, c);
  }
}

void TreeHessian::AddPointPair(const PointTerm& term, const PointMotion& point, int outer,
                               int inner) {
  const TreeAxis& j = motion_->axis(outer);
  const TreeAxis& k = motion_->axis(inner);
  const Vector3d s_j = j.S.angular;
  const Vector3d s_k = k.S.angular;
  const Vector3d moved = s_j.cross(VelocityAt(k.S, point.p));
  const Vector3d rate_j = VelocityAt(j.rate, point.p);
  const SpatialVector turned_rate = CrossMotion(j.rate, k.S);

  const Vector3d velocity = s_j.cross(VelocityDerivative(*motion_, point, inner)) +
                            VelocityAt(turned_rate, point.p) + s_k.cross(rate_j);
  const Vector3d acceleration =
      s_j.cross(AccelerationDerivative(*motion_, point, inner)) +
      s_k.cross(VelocityAt(j.rate_rate, point.p) + 2 * j.rate.angular.cross(point.velocity)) +
      VelocityAt(CrossMotion(j.rate_rate, k.S) + 2 * CrossMotion(j.rate, k.rate), point.p) +
      2 * turned_rate.angular.cross(point.velocity) + 2 * k.rate.angular.cross(rate_j);
  const double qq = term.on_position.dot(moved) + term.on_velocity.dot(velocity) +
                    term.on_acceleration.dot(acceleration);

  const Vector3d& on_a = term.on_acceleration;
  const Vector3d c_j = VelocityAt(j.S, point.p);
  const SpatialVector turned_axis = CrossMotion(j.S, k.S);
  const double q_inner_v_outer =
      term.on_velocity.dot(moved) +
      on_a.dot(s_k.cross(VelocityAt(j.twice, point.p) + 2 * s_j.cross(point.velocity)) +
               VelocityAt(CrossMotion(j.twice, k.S) + 2 * CrossMotion(j.S, k.rate), point.p) +
               2 * turned_axis.angular.cross(point.velocity) + 2 * k.rate.angular.cross(c_j));
  const double q_outer_v_inner = term.on_velocity.dot(moved) + 2 * on_a.dot(velocity);
  const double vv = 2 * on_a.dot(VelocityAt(turned_axis, point.p) + s_k.cross(c_j));
  const double qa = on_a.dot(moved);

  auto& H = hessian_;
  H.qq(outer, inner) += qq;
  H.vv(outer, inner) += vv;
  H.qv(inner, outer) += q_inner_v_outer;
  H.qa(inner, outer) += qa;
  if (outer == inner) return;
  H.qq(inner, outer) += qq;
  H.vv(inner, outer) += vv;
  H.qv(outer, inner) += q_outer_v_inner;
  H.qa(outer, inner) += qa;
}

void TreeHessian::AddRootPointPair(const PointTerm& term, const PointMotion& point, int j, int k) {
  // Rotating the robot does not change the root's own axes, velocity and acceleration.
  const Vector3d e_j = Vector3d::Unit(j);
  const Vector3d e_k = Vector3d::Unit(k);
  const TreeAxis& axis = motion_->axis(k);
  const Vector3d moved = e_j.cross(point.p);
  const Vector3d velocity_j = VelocityDerivative(*motion_, point, j);
  const Vector3d rate = axis.rate.angular;
  const Vector3d& on_a = term.on_acceleration;

  const Vector3d acceleration = e_k.cross(AccelerationDerivative(*motion_, point, j)) +
                                axis.rate_rate.angular.cross(moved) + 2 * rate.cross(velocity_j);
  auto& H = hessian_;
  H.qq(j, k) += term.on_position.dot(e_k.cross(moved)) +
                term.on_velocity.dot(rate.cross(moved) + e_k.cross(velocity_j)) +
                on_a.dot(acceleration);
  H.qv(j, k) += term.on_velocity.dot(e_k.cross(moved)) +
                on_a.dot(rate.cross(moved) + 2 * e_k.cross(velocity_j));
  H.vv(j, k) += on_a.dot(e_j.cross(e_k).cross(point.p) + 2 * e_k.cross(moved));
  H.qa(j, k) += on_a.dot(e_k.cross(moved));
}

}  // namespace possibility::dynamics
