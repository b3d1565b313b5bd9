#include "collocation/robot/robot_function.h"

#include <algorithm>
#include <stdexcept>

namespace possibility::collocation {

using dynamics::ContactPoint;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

const RobotSystem& Checked(const RobotSystem& model) {
  if (model->base() == dynamics::Base::kFloating) {
    throw std::invalid_argument(
        "a function of a multibody system: the model's base is a quaternion, whose rates are not "
        "its velocity");
  }
  return model;
}

bool AreSame(const ContactPoint& a, const ContactPoint& b) {
  return a.link == b.link && a.p_L == b.p_L;
}

}  // namespace

std::vector<PointComponent> ComponentsOf(const dynamics::MultibodyModel& model,
                                         const std::vector<ContactPoint>& points) {
  std::vector<PointComponent> components;
  for (const ContactPoint& point : points) {
    components.push_back({point, Vector3d::UnitX()});
    if (model.base() != dynamics::Base::kPlanar) components.push_back({point, Vector3d::UnitY()});
    components.push_back({point, Vector3d::UnitZ()});
  }
  return components;
}

RobotFunction::RobotFunction(const RobotSystem& model,
                             const std::vector<PointComponent>& components, int num_inputs,
                             int num_outputs)
    : Function(num_inputs, num_outputs),
      n_(Checked(model)->nv()),
      dynamics_(model),
      components_(components),
      translates_(model->nv(), false) {
  for (int i = 0; i < num_components(); ++i) {
    const ContactPoint& point = components_[i].point;
    if (points_.empty() || !AreSame(points_.back().point, point)) points_.push_back({point, {}});
    points_.back().components.push_back(i);
  }
  for (const auto& translation : model->translations()) translates_[translation.index] = true;
}

void RobotFunction::SetPositionVelocityAcceleration(const VectorXd& z) {
  dynamics_.SetState(z.head(n_), z.segment(n_, n_), z.segment(2 * n_, n_));
}

Vector3d RobotFunction::Combined(const Point& point, const VectorXd& weights) const {
  Vector3d sum = Vector3d::Zero();
  for (const int i : point.components) sum += weights[i] * components_[i].axis;
  return sum;
}

std::vector<dynamics::PointTerm> RobotFunction::Terms(Vector3d dynamics::PointTerm::*part,
                                                      const VectorXd& weights) const {
  std::vector<dynamics::PointTerm> terms(points_.size());
  for (std::size_t i = 0; i < points_.size(); ++i) {
    terms[i].link = points_[i].point.link;
    terms[i].p_L = points_[i].point.p_L;
    terms[i].*part = Combined(points_[i], weights);
  }
  return terms;
}

void RobotFunction::PutHessian(const dynamics::HessianProduct& products, MatrixXd* H) const {
  H->setZero();
  H->topLeftCorner(n_, n_) = products.qq;
  H->block(n_, n_, n_, n_) = products.vv;
  PutPair(products.qv, 0, n_, H);
  PutPair(products.qa, 0, 2 * n_, H);
}

void RobotFunction::PutPair(const MatrixXd& block, int row, int column, MatrixXd* H) const {
  H->block(row, column, n_, n_) = block;
  H->block(column, row, n_, n_) = block.transpose();
}

bool RobotFunction::Drives(int velocity, const PointComponent& component) const {
  for (const auto& translation : model().translations()) {
    if (translation.index == velocity) return component.axis.dot(translation.direction) != 0;
  }
  return model().Moves(velocity, component.point.link);
}

Mask RobotFunction::DriveMask() const {
  Mask mask(num_components(), n_);
  for (int c = 0; c < num_components(); ++c) {
    for (int i = 0; i < n_; ++i) mask(c, i) = Drives(i, components_[c]);
  }
  return mask;
}

Mask RobotFunction::TurnMask() const {
  Mask mask = DriveMask();
  for (int i = 0; i < n_; ++i) {
    if (Translates(i)) mask.col(i).setConstant(false);
  }
  return mask;
}

Mask RobotFunction::PointPairMask() const {
  Mask mask = Mask::Constant(n_, n_, false);
  for (const Point& point : points_) {
    for (int r = 0; r < n_; ++r) {
      if (Translates(r) || !model().Moves(r, point.point.link)) continue;
      for (int c = 0; c < n_; ++c) {
        if (!Translates(c) && model().Moves(c, point.point.link)) mask(r, c) = true;
      }
    }
  }
  return mask;
}

Mask RobotFunction::RelatedMask(bool rows, bool columns) const {
  Mask mask = Mask::Constant(n_, n_, false);
  for (int r = 0; r < n_; ++r) {
    for (int c = 0; c < n_; ++c) {
      if ((Translates(r) && !rows) || (Translates(c) && !columns)) continue;
      // Translations are orthogonal.
      if (Translates(r) && Translates(c) && r != c) continue;
      mask(r, c) = model().AreRelated(r, c);
    }
  }
  return mask;
}

}  // namespace possibility::collocation
