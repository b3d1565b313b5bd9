#include "dynamics/tree/multibody_points.h"

#include <stdexcept>
#include <utility>

#include "dynamics/tree/tree_motion.h"

namespace possibility::dynamics {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;

MultibodyPoints::MultibodyPoints(std::shared_ptr<const MultibodyModel> model)
    : model_(std::move(model)),
      kinematics_(model_->tree()),
      pulls_(model_->tree().num_links()),
      tree_jacobian_(3, model_->tree().nv()),
      jacobian_(3, model_->nv()),
      hessian_(model_->nv(), model_->nv()) {}

void MultibodyPoints::SetPosition(const Eigen::Ref<const Eigen::VectorXd>& q) {
  if (!q.allFinite()) throw std::invalid_argument("MultibodyPoints: q is not finite");
  if (model_->is_identity()) {
    kinematics_.SetPosition(q);
  } else {
    kinematics_.SetPosition(model_->TreeConfiguration(q));
  }
}

void MultibodyPoints::CheckPoint(int link, const Vector3d& p_L) const {
  if (link < 0 || link >= model_->tree().num_links()) {
    throw std::invalid_argument("MultibodyPoints: a point names a link that does not exist");
  }
  if (!p_L.allFinite()) {
    throw std::invalid_argument("MultibodyPoints: a point's position is not finite");
  }
}

Vector3d MultibodyPoints::Position(const ContactPoint& point) const {
  CheckPoint(point.link, point.p_L);
  return kinematics_.Position(point.link, point.p_L);
}

const MatrixXd& MultibodyPoints::Jacobian(const ContactPoint& point) {
  CheckPoint(point.link, point.p_L);
  if (model_->is_identity()) {
    kinematics_.PointJacobian(point.link, point.p_L, jacobian_);
  } else {
    kinematics_.PointJacobian(point.link, point.p_L, tree_jacobian_);
    model_->ReduceColumns(tree_jacobian_, jacobian_);
  }
  return jacobian_;
}

const MatrixXd& MultibodyPoints::Hessian(const std::vector<PointTerm>& terms) {
  CollectPulls(terms);
  hessian_.setZero();
  for (int i = model_->tree().num_links() - 1; i > 0; --i) {
    const Pull& pull = pulls_[i];
    if (!pull.any) continue;
    AddJointPairs(i);
    Pull& parent = pulls_[JointOf(i).parent];
    parent.any = true;
    parent.weight += pull.weight;
    parent.virial += pull.virial;
  }
  AddRootPairs();
  return hessian_;
}

void MultibodyPoints::CollectPulls(const std::vector<PointTerm>& terms) {
  for (Pull& pull : pulls_) pull = {};
  for (const PointTerm& term : terms) {
    CheckPoint(term.link, term.p_L);
    Pull& pull = pulls_[term.link];
    pull.any = true;
    pull.weight += term.on_position;
    pull.virial +=
        term.on_position * (kinematics_.Position(term.link, term.p_L) - RootOrigin()).transpose();
  }
}

void MultibodyPoints::AddJointPairs(int link) {
  const Pull& pull = pulls_[link];
  const Vector3d& axis = kinematics_.Axis(link);
  // A turn s of all that carries the joint changes the sum's derivative along the joint by
  // s . turned, the sum of (rate of p) x weight.
  Vector3d turned;
  if (JointOf(link).type == models::JointType::kPrismatic) {
    turned = axis.cross(pull.weight);
  } else {
    const Vector3d origin = kinematics_.X_WL()[link].translation() - RootOrigin();
    const Matrix3d virial = pull.virial - pull.weight * origin.transpose();
    turned = virial.transpose() * axis - virial.trace() * axis;
  }
  const int c = TreeMotion::Coordinate(link);
  for (int j = link; j > 0; j = JointOf(j).parent) {
    if (JointOf(j).type == models::JointType::kPrismatic) continue;
    AddPair(TreeMotion::Coordinate(j), c, kinematics_.Axis(j).dot(turned));
  }
  for (int d = 0; d < 3; ++d) AddPair(d, c, turned[d]);
}

void MultibodyPoints::AddRootPairs() {
  // The root's rotations do not commute: the second derivative along a curve is the mean.
  const Matrix3d& virial = pulls_[0].virial;
  for (int d = 0; d < 3; ++d) {
    for (int c = d; c < 3; ++c) {
      const double trace = c == d ? virial.trace() : 0;
      AddPair(d, c, (virial(d, c) + virial(c, d)) / 2 - trace);
    }
  }
}

void MultibodyPoints::AddPair(int outer, int inner, double second) {
  const CoupledVelocity& row = model_->couplings()[outer];
  const CoupledVelocity& column = model_->couplings()[inner];
  if (row.independent < 0 || column.independent < 0) return;
  const double change = row.factor * column.factor * second;
  hessian_(row.independent, column.independent) += change;
  if (outer != inner) hessian_(column.independent, row.independent) += change;
}

}  // namespace possibility::dynamics
