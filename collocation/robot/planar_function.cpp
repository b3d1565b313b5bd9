#include "collocation/robot/planar_function.h"

#include <stdexcept>

namespace possibility::collocation {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

const PlanarModel& Checked(const PlanarModel& model) {
  if (model->base() != dynamics::Base::kPlanar) {
    throw std::invalid_argument("a function of a planar system: the model's base is not planar");
  }
  return model;
}

}  // namespace

PlanarFunction::PlanarFunction(const PlanarModel& model,
                               const std::vector<dynamics::ContactPoint>& points, int num_inputs,
                               int num_outputs)
    : Function(num_inputs, num_outputs),
      n_(Checked(model)->nv()),
      dynamics_(model),
      points_(points) {}

void PlanarFunction::SetPositionVelocityAcceleration(const VectorXd& z) {
  dynamics_.SetState(z.head(n_), z.segment(n_, n_), z.segment(2 * n_, n_));
}

std::vector<dynamics::PointTerm> PlanarFunction::Terms(Vector3d dynamics::PointTerm::*part,
                                                       const VectorXd& components) const {
  std::vector<dynamics::PointTerm> terms(points_.size());
  for (int i = 0; i < num_points(); ++i) {
    terms[i].link = points_[i].link;
    terms[i].p_L = points_[i].p_L;
    terms[i].*part = Vector3d(components[2 * i], 0, components[2 * i + 1]);
  }
  return terms;
}

void PlanarFunction::PutHessian(const dynamics::HessianProduct& products, MatrixXd* H) const {
  H->setZero();
  H->topLeftCorner(n_, n_) = products.qq;
  H->block(n_, n_, n_, n_) = products.vv;
  PutPair(products.qv, 0, n_, H);
  PutPair(products.qa, 0, 2 * n_, H);
}

void PlanarFunction::PutPair(const MatrixXd& block, int row, int column, MatrixXd* H) const {
  H->block(row, column, n_, n_) = block;
  H->block(column, row, n_, n_) = block.transpose();
}

Mask PlanarFunction::JacobianMaskWithoutBase(int parts) const {
  Mask mask = Mask::Constant(num_outputs(), num_inputs(), true);
  for (int part = 0; part < parts; ++part) mask.middleCols(part * n_ + 1, 2).setConstant(false);
  return mask;
}

void PlanarFunction::MaskBase(int parts, Mask* hessian_mask) const {
  for (int part = 0; part < parts; ++part) {
    hessian_mask->middleRows(part * n_ + 1, 2).setConstant(false);
    hessian_mask->middleCols(part * n_ + 1, 2).setConstant(false);
  }
}

}  // namespace possibility::collocation
