#include "dynamics/tree/tree_kinematics.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "dynamics/tree/spatial.h"
#include "models/robot/cross_matrix.h"

namespace possibility::dynamics {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using models::CrossMatrix;

void CheckLength(const char* what, Eigen::Index actual, int expected) {
  if (actual == expected) return;
  throw std::invalid_argument(std::string("TreeKinematics: ") + what + " has " +
                              std::to_string(actual) + " elements, expected " +
                              std::to_string(expected));
}

}  // namespace

TreeKinematics::TreeKinematics(const models::RobotModel& model) : model_(&model) {
  const int n = model.num_links();
  if (n != model.num_joints() + 1) {
    throw std::invalid_argument("TreeKinematics: expected one link more than joints");
  }
  X_WL_.assign(n, Eigen::Isometry3d::Identity());
  constants_.resize(n);
  states_.resize(n);
  supporting_joints_.resize(n);
  for (int i = 0; i < n; ++i) {
    LinkConstants& link = constants_[i];
    const models::Inertial& inertial = model.links[i].inertial;
    link.mass = link.subtree_mass = inertial.mass;
    link.p_LC = inertial.p_LC;
    if (i == 0) continue;
    const models::Joint& joint = model.joints[i - 1];
    if (joint.parent < 0 || joint.parent >= i) {
      throw std::invalid_argument("TreeKinematics: a joint's parent must come before its child");
    }
    link.parent = joint.parent;
    link.prismatic = joint.type == models::JointType::kPrismatic;
    link.p_PJ = joint.X_PJ.translation();
    link.fixed = joint.X_PJ.linear();
    link.axis_P = link.fixed * joint.axis;
    link.sine = link.fixed * CrossMatrix(joint.axis);
    link.versine = link.sine * CrossMatrix(joint.axis);
    supporting_joints_[i] = supporting_joints_[joint.parent];
    supporting_joints_[i].push_back(i - 1);
  }
  for (int i = n - 1; i > 0; --i) {
    constants_[constants_[i].parent].subtree_mass += constants_[i].subtree_mass;
  }
}

void TreeKinematics::SetPosition(const Eigen::Ref<const Eigen::VectorXd>& q) {
  CheckLength("q", q.size(), model_->nq());
  Eigen::Quaterniond orientation(q[0], q[1], q[2], q[3]);
  const double norm = orientation.norm();
  if (!(norm > 1e-100 && std::isfinite(norm))) {
    throw std::invalid_argument("TreeKinematics: the quaternion in q cannot be normalised");
  }
  orientation.coeffs() /= norm;
  X_WL_[0].linear() = orientation.toRotationMatrix();
  X_WL_[0].translation() = q.segment<3>(4);

  const int n = static_cast<int>(states_.size());
  for (int i = 1; i < n; ++i) PlaceLink(i, q[6 + i]);
  for (int i = 0; i < n; ++i) {
    LinkState& link = states_[i];
    link.to_com = Times(X_WL_[i].linear(), constants_[i].p_LC);
    link.subtree_moment = constants_[i].mass * (X_WL_[i].translation() + link.to_com);
  }
  for (int i = n - 1; i > 0; --i) {
    states_[constants_[i].parent].subtree_moment += states_[i].subtree_moment;
  }
}

void TreeKinematics::PlaceLink(int index, double joint_position) {
  const LinkConstants& constants = constants_[index];
  const Eigen::Isometry3d& X_WP = X_WL_[constants.parent];
  const Matrix3d R_WP = X_WP.linear();
  LinkState& link = states_[index];
  link.axis = Times(R_WP, constants.axis_P);
  link.from_parent = Times(R_WP, constants.p_PJ);
  Matrix3d R_PL = constants.fixed;
  if (constants.prismatic) {
    link.from_parent += joint_position * link.axis;
  } else {
    R_PL += std::sin(joint_position) * constants.sine +
            (1 - std::cos(joint_position)) * constants.versine;
  }
  Eigen::Isometry3d& X_WL = X_WL_[index];
  for (int axis = 0; axis < 3; ++axis) X_WL.linear().col(axis) = Times(R_WP, R_PL.col(axis));
  X_WL.translation() = X_WP.translation() + link.from_parent;
}

void TreeKinematics::SetVelocity(const Eigen::Ref<const Eigen::VectorXd>& v) {
  CheckLength("v", v.size(), model_->nv());
  states_[0].angular = v.head<3>();
  states_[0].linear = v.segment<3>(3);
  const int n = static_cast<int>(states_.size());
  for (int i = 1; i < n; ++i) MoveLink(i, v[5 + i]);
}

void TreeKinematics::MoveLink(int index, double joint_rate) {
  const LinkState& parent = states_[constants_[index].parent];
  LinkState& link = states_[index];
  const Vector3d swept = parent.angular.cross(link.from_parent);
  const Vector3d along = joint_rate * link.axis;
  const Vector3d turning = parent.angular.cross(along);
  link.angular = parent.angular;
  link.linear = parent.linear + swept;
  link.joint_linear_bias = parent.angular.cross(swept);
  if (constants_[index].prismatic) {
    link.linear += along;
    link.joint_linear_bias += 2 * turning;
    link.joint_angular_bias.setZero();
  } else {
    link.angular += along;
    link.joint_angular_bias = turning;
  }
  link.angular_bias = parent.angular_bias + link.joint_angular_bias;
  link.linear_bias =
      parent.linear_bias + parent.angular_bias.cross(link.from_parent) + link.joint_linear_bias;
}

Vector3d TreeKinematics::Position(int link, const Vector3d& p_L) const { return X_WL_[link] * p_L; }

Vector3d TreeKinematics::Velocity(int link, const Vector3d& p_L) const {
  const Vector3d arm = X_WL_[link].linear() * p_L;
  return states_[link].linear + states_[link].angular.cross(arm);
}

Vector3d TreeKinematics::AngularVelocity(int link) const { return states_[link].angular; }

void TreeKinematics::FrameJacobian(int link, const Vector3d& p_L, Eigen::MatrixXd* J) const {
  J->resize(6, model_->nv());
  J->setZero();
  const Vector3d p = Position(link, p_L);
  J->topLeftCorner<3, 3>().setIdentity();
  J->bottomLeftCorner<3, 3>() = -CrossMatrix(p - X_WL_[0].translation());
  J->block<3, 3>(3, 3).setIdentity();
  for (const int joint : supporting_joints_[link]) {
    const Vector3d& axis = states_[joint + 1].axis;
    auto column = J->col(6 + joint);
    if (constants_[joint + 1].prismatic) {
      column.tail<3>() = axis;
    } else {
      column.head<3>() = axis;
      column.tail<3>() = axis.cross(p - X_WL_[joint + 1].translation());
    }
  }
}

void TreeKinematics::PointJacobian(int link, const Vector3d& p_L,
                                   Eigen::Ref<Eigen::MatrixXd> J) const {
  CheckLength("a Jacobian's row", J.cols(), model_->nv());
  CheckLength("a Jacobian's column", J.rows(), 3);
  const Vector3d p = Position(link, p_L);
  J.setZero();
  J.leftCols<3>() = -CrossMatrix(p - X_WL_[0].translation());
  J.middleCols<3>(3).setIdentity();
  for (const int joint : supporting_joints_[link]) {
    const Vector3d& axis = states_[joint + 1].axis;
    if (constants_[joint + 1].prismatic) {
      J.col(6 + joint) = axis;
    } else {
      J.col(6 + joint) = axis.cross(p - X_WL_[joint + 1].translation());
    }
  }
}

void TreeKinematics::AngularJacobian(int link, Eigen::Ref<Eigen::MatrixXd> J) const {
  CheckLength("a Jacobian's row", J.cols(), model_->nv());
  CheckLength("a Jacobian's column", J.rows(), 3);
  J.setZero();
  J.leftCols<3>().setIdentity();
  for (const int joint : supporting_joints_[link]) {
    if (!constants_[joint + 1].prismatic) J.col(6 + joint) = states_[joint + 1].axis;
  }
}

Eigen::Matrix<double, 6, 1> TreeKinematics::FrameBias(int link, const Vector3d& p_L) const {
  const LinkState& state = states_[link];
  const Vector3d arm = X_WL_[link].linear() * p_L;
  Eigen::Matrix<double, 6, 1> bias;
  bias << state.angular_bias, state.linear_bias + state.angular_bias.cross(arm) +
                                  state.angular.cross(state.angular.cross(arm));
  return bias;
}

Vector3d TreeKinematics::CentreOfMass() const { return states_[0].subtree_moment / total_mass(); }

Vector3d TreeKinematics::CentreOfMassVelocity() const {
  Vector3d momentum = Vector3d::Zero();
  for (std::size_t i = 0; i < states_.size(); ++i) {
    const LinkState& link = states_[i];
    momentum += constants_[i].mass * (link.linear + link.angular.cross(link.to_com));
  }
  return momentum / total_mass();
}

void TreeKinematics::CentreOfMassJacobian(Eigen::MatrixXd* J) const {
  J->resize(3, model_->nv());
  J->leftCols<3>() = -CrossMatrix(CentreOfMass() - X_WL_[0].translation());
  J->middleCols<3>(3).setIdentity();
  for (int i = 1; i < model_->num_links(); ++i) {
    const LinkState& link = states_[i];
    const double mass = constants_[i].subtree_mass;
    if (constants_[i].prismatic) {
      J->col(5 + i) = link.axis * (mass / total_mass());
    } else {
      const Vector3d moment = link.subtree_moment - mass * X_WL_[i].translation();
      J->col(5 + i) = link.axis.cross(moment) / total_mass();
    }
  }
}

Vector3d TreeKinematics::CentreOfMassBias() const {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = 0; i < states_.size(); ++i) {
    const LinkState& link = states_[i];
    sum += constants_[i].mass * (link.linear_bias + link.angular_bias.cross(link.to_com) +
                                 link.angular.cross(link.angular.cross(link.to_com)));
  }
  return sum / total_mass();
}

void TreeKinematics::AddPointForce(int link, const Vector3d& p_L, const Vector3d& f_W,
                                   Eigen::VectorXd* generalised) const {
  CheckLength("a generalised force", generalised->size(), model_->nv());
  const Vector3d p = Position(link, p_L);
  generalised->head<3>() += (p - X_WL_[0].translation()).cross(f_W);
  generalised->segment<3>(3) += f_W;
  for (const int joint : supporting_joints_[link]) {
    const Vector3d& axis = states_[joint + 1].axis;
    (*generalised)[6 + joint] += constants_[joint + 1].prismatic
                                     ? axis.dot(f_W)
                                     : axis.dot((p - X_WL_[joint + 1].translation()).cross(f_W));
  }
}

}  // namespace possibility::dynamics
