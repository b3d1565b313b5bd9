#include "dynamics/tree/tree_derivatives.h"

#include <stdexcept>
#include <string>

namespace possibility::dynamics {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

/// Rotational inertia about the origin, world axes (parallel-axis theorem); symmetric to the bit.
Matrix3d RotatedInertia(const Matrix3d& R, const Matrix3d& I_LC, const Vector3d& moment,
                        const Vector3d& com) {
  Matrix3d inertia;
  const double squared = Dot(moment, com);
  for (int r = 0; r < 3; ++r) {
    // Row r of R I.
    const Vector3d turned = Times(I_LC, Vector3d(R(r, 0), R(r, 1), R(r, 2)));
    for (int c = 0; c <= r; ++c) {
      inertia(r, c) = inertia(c, r) = turned[0] * R(c, 0) + turned[1] * R(c, 1) +
                                      turned[2] * R(c, 2) - moment[r] * com[c] +
                                      (r == c ? squared : 0);
    }
  }
  return inertia;
}

}  // namespace

TreeDerivatives::TreeDerivatives(const models::RobotModel& model)
    : kinematics_(model), num_links_(model.num_links()) {
  const int nv = model.nv();
  constants_.resize(num_links_);
  for (int i = 0; i < num_links_; ++i) {
    const models::Inertial& inertial = model.links[i].inertial;
    constants_[i].mass = inertial.mass;
    constants_[i].p_LC = inertial.p_LC;
    constants_[i].I_LC = inertial.I_LC;
    if (i == 0) continue;
    constants_[i].parent = model.joints[i - 1].parent;
    constants_[i].prismatic = model.joints[i - 1].type == models::JointType::kPrismatic;
  }
  bodies_.resize(num_links_);
  subtrees_.resize(num_links_);
  virtual_bodies_.resize(num_links_);
  v_.resize(num_links_);
  a_.resize(num_links_);
  w_.resize(num_links_);
  axes_.resize(nv);
  for (int k = 0; k < 3; ++k) {
    axes_[k].S.angular[k] = 1;
    axes_[3 + k].S.linear[k] = 1;
  }
  forces_.setZero(nv);
  mass_matrix_.setZero(nv, nv);
  derivatives_.dq = derivatives_.dv = derivatives_.da = mass_matrix_;
  hessian_.qq = hessian_.qv = hessian_.vv = hessian_.qa = mass_matrix_;
  centroidal_.jacobian.setZero(3, nv);
  centroidal_.momentum.setZero(6);
  centroidal_.momentum_dq.setZero(6, nv);
  centroidal_.momentum_dv.setZero(6, nv);
  for (Eigen::MatrixXd* m :
       {&point_.jacobian, &point_.velocity_dq, &point_.acceleration_dq, &point_.acceleration_dv}) {
    m->setZero(3, nv);
  }
}

void TreeDerivatives::CheckSize(const char* what, Eigen::Index size) const {
  const int nv = kinematics_.model().nv();
  if (size == nv) return;
  throw std::invalid_argument(std::string("TreeDerivatives: ") + what + " has " +
                              std::to_string(size) + " elements, expected " + std::to_string(nv));
}

void TreeDerivatives::SetState(const Eigen::Ref<const Eigen::VectorXd>& q,
                               const Eigen::Ref<const Eigen::VectorXd>& v,
                               const Eigen::Ref<const Eigen::VectorXd>& a) {
  CheckSize("v", v.size());
  kinematics_.SetPosition(q);
  origin_velocity_ = v.segment<3>(3);
  v_[0] = {v.head<3>(), Vector3d::Zero()};
  const Vector3d p_WO = kinematics_.X_WL()[0].translation();
  PlaceBody(0, p_WO);
  for (int i = 1; i < num_links_; ++i) {
    const Vector3d& s = kinematics_.Axis(i);
    const Vector3d r = kinematics_.X_WL()[i].translation() - p_WO;
    Axis& axis = axes_[Coordinate(i)];
    if (constants_[i].prismatic) {
      axis.S.linear = s;
    } else {
      axis.S = {s, Cross(r, s)};
    }
    const SpatialVector& parent = v_[constants_[i].parent];
    axis.rate = CrossMotion(parent, axis.S);
    axis.twice = 2 * axis.rate;
    v_[i] = parent + v[Coordinate(i)] * axis.S;
    PlaceBody(i, p_WO);
  }
  for (int k = 0; k < 3; ++k) {
    axes_[k].rate = CrossMotion(v_[0], axes_[k].S);
    axes_[k].twice = axes_[k].rate;
  }
  rates_ = v;
  SumUpSubtrees();
  SetAcceleration(a);
}

void TreeDerivatives::PlaceBody(int link, const Vector3d& p_WO) {
  const LinkConstants& constants = constants_[link];
  const Eigen::Isometry3d& X_WL = kinematics_.X_WL()[link];
  Body& body = bodies_[link];
  const Matrix3d R = X_WL.linear();
  const Vector3d com = Times(R, constants.p_LC) + (X_WL.translation() - p_WO);
  body.mass = constants.mass;
  body.moment = constants.mass * com;
  body.inertia = RotatedInertia(R, constants.I_LC, body.moment, com);

  const SpatialVector& v = v_[link];
  body.momentum = constants.mass * v.linear + Cross(v.angular, body.moment);
  body.coriolis = CoriolisMatrix(v, body.moment, body.inertia);
}

void TreeDerivatives::SumUpSubtrees() {
  subtrees_ = bodies_;
  for (int i = num_links_ - 1; i > 0; --i) {
    const Body& body = subtrees_[i];
    Body& parent = subtrees_[constants_[i].parent];
    parent.mass += body.mass;
    parent.moment += body.moment;
    parent.inertia += body.inertia;
    parent.momentum += body.momentum;
    parent.coriolis += body.coriolis;
  }
}

void TreeDerivatives::SetAcceleration(const Eigen::Ref<const Eigen::VectorXd>& a) {
  CheckSize("a", a.size());
  a_[0] = {a.head<3>(), a.segment<3>(3)};
  a_[0].linear.z() += kGravity;
  for (int k = 0; k < 3; ++k) {
    axes_[k].rate_rate = CrossMotion(a_[0], axes_[k].S) + CrossMotion(v_[0], axes_[k].rate);
  }
  for (int i = 1; i < num_links_; ++i) {
    const int parent = constants_[i].parent;
    Axis& axis = axes_[Coordinate(i)];
    axis.rate_rate = CrossMotion(a_[parent], axis.S) + CrossMotion(v_[parent], axis.rate);
    a_[i] = a_[parent] + a[Coordinate(i)] * axis.S + rates_[Coordinate(i)] * axis.rate;
  }
  for (int i = 0; i < num_links_; ++i) {
    subtrees_[i].force = bodies_[i].Inertia(a_[i]) + bodies_[i].Coriolis(v_[i]);
  }
  for (int i = num_links_ - 1; i > 0; --i) {
    forces_[Coordinate(i)] = Dot(axes_[Coordinate(i)].S, subtrees_[i].force);
    subtrees_[constants_[i].parent].force += subtrees_[i].force;
  }
  forces_.head<3>() = subtrees_[0].force.angular;
  forces_.segment<3>(3) = subtrees_[0].force.linear;
}

namespace {

/// The spatial inertia as a 6 x 6 matrix.
Eigen::Matrix<double, 6, 6> InertiaMatrix(double mass, const Vector3d& moment,
                                          const Matrix3d& inertia) {
  Eigen::Matrix<double, 6, 6> I;
  const Matrix3d cross = CrossMatrix(moment);
  I << inertia, cross, -cross, mass * Matrix3d::Identity();
  return I;
}

}  // namespace

const Eigen::MatrixXd& TreeDerivatives::MassMatrix() {
  const Body& all = subtrees_[0];
  mass_matrix_.topLeftCorner<6, 6>() = InertiaMatrix(all.mass, all.moment, all.inertia);
  for (int i = num_links_ - 1; i > 0; --i) {
    const int c = Coordinate(i);
    const SpatialVector inertia = subtrees_[i].Inertia(axes_[c].S);
    for (int j = i; j > 0; j = constants_[j].parent) {
      const int d = Coordinate(j);
      mass_matrix_(c, d) = mass_matrix_(d, c) = Dot(axes_[d].S, inertia);
    }
    StoreColumn(inertia, c, &mass_matrix_);
    StoreRow(inertia, c, &mass_matrix_);
  }
  return mass_matrix_;
}

const InverseDynamicsDerivatives& TreeDerivatives::Differentiate() {
  derivatives_.forces = forces_;
  for (int i = num_links_ - 1; i > 0; --i) DifferentiateJoint(i);
  DifferentiateRoot();
  return derivatives_;
}

void TreeDerivatives::DifferentiateJoint(int link) {
  const int c = Coordinate(link);
  const Axis& axis = axes_[c];
  const Body& subtree = subtrees_[link];
  const SpatialVector da = subtree.Inertia(axis.S);
  const SpatialVector dv = 2 * (subtree.Coriolis(axis.S) + subtree.Inertia(axis.rate));
  const SpatialVector dq = 2 * subtree.Coriolis(axis.rate) + subtree.Inertia(axis.rate_rate) +
                           CrossForce(axis.S, subtree.force);
  const Vector3d t = 2 * subtree.CoriolisTransposed(axis.S);
  auto& D = derivatives_;
  for (int j = link; j > 0; j = constants_[j].parent) {
    const int d = Coordinate(j);
    const Axis& other = axes_[d];
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
    D.dv(c, d) = t[d] + Dot(da, axes_[d].twice);
    D.dq(c, d) = Dot(t, axes_[d].rate.angular) + Dot(da, axes_[d].rate_rate);
  }
}

void TreeDerivatives::DifferentiateRoot() {
  const Body& all = subtrees_[0];
  auto& D = derivatives_;
  D.da.topLeftCorner<6, 6>() = InertiaMatrix(all.mass, all.moment, all.inertia);
  for (int d = 0; d < 3; ++d) {
    const Axis& axis = axes_[d];
    StoreColumn(2 * all.Coriolis(axis.S) + all.Inertia(axis.twice), d, &D.dv);
    StoreColumn(
        2 * all.Coriolis(axis.rate) + all.Inertia(axis.rate_rate) + CrossForce(axis.S, all.force),
        d, &D.dq);
  }
}

const CentroidalQuantities& TreeDerivatives::Centroidal() {
  const Body& all = subtrees_[0];
  auto& C = centroidal_;
  const Vector3d com = all.moment / all.mass;
  C.position = kinematics_.X_WL()[0].translation() + com;
  C.momentum << all.Momentum().angular - Cross(com, all.momentum),
      all.momentum + all.mass * origin_velocity_;
  const int nv = kinematics_.model().nv();
  for (int c = 0; c < nv; ++c) {
    const Body& moved = c < 6 ? all : subtrees_[c - 5];
    const SpatialVector dv = moved.Inertia(axes_[c].S);
    C.jacobian.col(c) = dv.linear / all.mass;
    C.momentum_dv.col(c) << dv.angular - Cross(com, dv.linear), dv.linear;
    const bool translates_all = c >= 3 && c < 6;
    if (translates_all) continue;  // their momentum_dq is zero
    const SpatialVector dq =
        CrossForce(axes_[c].S, moved.Momentum()) + moved.Inertia(axes_[c].rate);
    const Vector3d com_dq = C.jacobian.col(c);
    C.momentum_dq.col(c) << dq.angular - Cross(com_dq, all.momentum) - Cross(com, dq.linear),
        dq.linear;
  }
  return centroidal_;
}

}  // namespace possibility::dynamics
