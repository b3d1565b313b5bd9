#include "dynamics/tree/tree_motion.h"

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

TreeMotion::TreeMotion(const models::RobotModel& model)
    : kinematics_(model), num_links_(model.num_links()) {
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
  v_.resize(num_links_);
  a_.resize(num_links_);
  axes_.resize(model.nv());
  for (int k = 0; k < 3; ++k) {
    axes_[k].S.angular[k] = 1;
    axes_[3 + k].S.linear[k] = 1;
  }
  forces_.setZero(model.nv());
}

void TreeMotion::CheckSize(const char* what, Eigen::Index size) const {
  const int nv = kinematics_.model().nv();
  if (size == nv) return;
  throw std::invalid_argument(std::string("TreeMotion: ") + what + " has " + std::to_string(size) +
                              " elements, expected " + std::to_string(nv));
}

void TreeMotion::SetState(const Eigen::Ref<const Eigen::VectorXd>& q,
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
    TreeAxis& axis = axes_[Coordinate(i)];
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

void TreeMotion::PlaceBody(int link, const Vector3d& p_WO) {
  const LinkConstants& constants = constants_[link];
  const Eigen::Isometry3d& X_WL = kinematics_.X_WL()[link];
  SpatialBody& body = bodies_[link];
  const Matrix3d R = X_WL.linear();
  const Vector3d com = Times(R, constants.p_LC) + (X_WL.translation() - p_WO);
  body.mass = constants.mass;
  body.moment = constants.mass * com;
  body.inertia = RotatedInertia(R, constants.I_LC, body.moment, com);

  const SpatialVector& v = v_[link];
  body.momentum = constants.mass * v.linear + Cross(v.angular, body.moment);
  body.coriolis = CoriolisMatrix(v, body.moment, body.inertia);
}

void TreeMotion::SumUpSubtrees() {
  subtrees_ = bodies_;
  for (int i = num_links_ - 1; i > 0; --i) {
    const SpatialBody& body = subtrees_[i];
    SpatialBody& parent = subtrees_[constants_[i].parent];
    parent.mass += body.mass;
    parent.moment += body.moment;
    parent.inertia += body.inertia;
    parent.momentum += body.momentum;
    parent.coriolis += body.coriolis;
  }
}

void TreeMotion::SetAcceleration(const Eigen::Ref<const Eigen::VectorXd>& a) {
  CheckSize("a", a.size());
  a_[0] = {a.head<3>(), a.segment<3>(3)};
  a_[0].linear.z() += kGravity;
  for (int k = 0; k < 3; ++k) {
    axes_[k].rate_rate = CrossMotion(a_[0], axes_[k].S) + CrossMotion(v_[0], axes_[k].rate);
  }
  for (int i = 1; i < num_links_; ++i) {
    const int parent = constants_[i].parent;
    TreeAxis& axis = axes_[Coordinate(i)];
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

}  // namespace possibility::dynamics
