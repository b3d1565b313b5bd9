#include "dynamics/tree/multibody_dynamics.h"

#include <fmt/format.h>

#include <stdexcept>

namespace possibility::dynamics {

using Eigen::MatrixXd;
using Eigen::VectorXd;

MultibodyDynamics::MultibodyDynamics(std::shared_ptr<const MultibodyModel> model)
    : model_(std::move(model)), tree_(model_->tree()), torque_limits_(model_->effort()) {
  const int nv = model_->nv();
  forces_.setZero(nv);
  mass_matrix_.setZero(nv, nv);
  derivatives_ = {forces_, mass_matrix_, mass_matrix_, mass_matrix_};
  hessian_ = {mass_matrix_, mass_matrix_, mass_matrix_, mass_matrix_};
  centroidal_.jacobian.setZero(3, nv);
  centroidal_.momentum_dq.setZero(6, nv);
  centroidal_.momentum_dv.setZero(6, nv);
}

void MultibodyDynamics::Check(const char* what, const Eigen::Ref<const VectorXd>& x,
                              int expected) const {
  if (x.size() != expected) {
    throw std::invalid_argument(fmt::format("MultibodyDynamics: {} has {} elements, expected {}",
                                            what, x.size(), expected));
  }
  if (!x.allFinite()) {
    throw std::invalid_argument(fmt::format("MultibodyDynamics: {} is not finite", what));
  }
}

void MultibodyDynamics::CheckPoint(const ContactPoint& point) const {
  if (point.link < 0 || point.link >= model_->tree().num_links()) {
    throw std::invalid_argument(
        fmt::format("MultibodyDynamics: a point names link {}, the robot has {}", point.link,
                    model_->tree().num_links()));
  }
  if (!point.p_L.allFinite()) {
    throw std::invalid_argument("MultibodyDynamics: a point's position is not finite");
  }
}

void MultibodyDynamics::SetState(const Eigen::Ref<const VectorXd>& q,
                                 const Eigen::Ref<const VectorXd>& v) {
  SetState(q, v, VectorXd::Zero(model_->nv()));
}

void MultibodyDynamics::SetState(const Eigen::Ref<const VectorXd>& q,
                                 const Eigen::Ref<const VectorXd>& v,
                                 const Eigen::Ref<const VectorXd>& a) {
  Check("q", q, model_->nq());
  Check("v", v, model_->nv());
  Check("a", a, model_->nv());
  if (model_->has_lines()) torque_limits_ = model_->TorqueLimits(v);
  if (model_->is_identity()) {
    tree_.SetState(q, v, a);
  } else {
    tree_.SetState(model_->TreeConfiguration(q), model_->TreeVelocity(v), model_->TreeVelocity(a));
  }
  acceleration_ = a;
}

void MultibodyDynamics::SetAcceleration(const Eigen::Ref<const VectorXd>& a) {
  Check("a", a, model_->nv());
  if (acceleration_.size() == a.size() && acceleration_ == a) return;
  if (model_->is_identity()) {
    tree_.SetAcceleration(a);
  } else {
    tree_.SetAcceleration(model_->TreeVelocity(a));
  }
  acceleration_ = a;
}

/// Reduces rows and columns.
void MultibodyDynamics::Reduce(const MatrixXd& tree, MatrixXd* reduced) const {
  reduced->setZero();
  AddReduced(tree, *reduced);
}

void MultibodyDynamics::AddReduced(const MatrixXd& tree, Eigen::Ref<MatrixXd> reduced) const {
  for (Eigen::Index c = 0; c < tree.cols(); ++c) {
    const CoupledVelocity& column = model_->couplings()[c];
    if (column.independent < 0) continue;
    for (Eigen::Index r = 0; r < tree.rows(); ++r) {
      const CoupledVelocity& row = model_->couplings()[r];
      if (row.independent < 0) continue;
      reduced(row.independent, column.independent) += row.factor * column.factor * tree(r, c);
    }
  }
}

const VectorXd& MultibodyDynamics::InverseDynamics() {
  if (model_->is_identity()) return tree_.InverseDynamics();
  forces_ = model_->IndependentForces(tree_.InverseDynamics());
  return forces_;
}

const MatrixXd& MultibodyDynamics::MassMatrix() {
  const MatrixXd& tree = tree_.MassMatrix();
  if (model_->is_identity()) return tree;
  Reduce(tree, &mass_matrix_);
  return mass_matrix_;
}

const InverseDynamicsDerivatives& MultibodyDynamics::Differentiate() {
  const InverseDynamicsDerivatives& tree = tree_.Differentiate();
  if (model_->is_identity()) return tree;
  derivatives_.forces = model_->IndependentForces(tree.forces);
  Reduce(tree.dq, &derivatives_.dq);
  Reduce(tree.dv, &derivatives_.dv);
  Reduce(tree.da, &derivatives_.da);
  return derivatives_;
}

Eigen::Vector3d MultibodyDynamics::Position(const ContactPoint& point) const {
  CheckPoint(point);
  return tree_.Position(point.link, point.p_L);
}

Eigen::Vector3d MultibodyDynamics::Velocity(const ContactPoint& point) const {
  CheckPoint(point);
  return tree_.Velocity(point.link, point.p_L);
}

Eigen::Vector3d MultibodyDynamics::Acceleration(const ContactPoint& point) const {
  CheckPoint(point);
  return tree_.Acceleration(point.link, point.p_L);
}

// A writable Eigen::Ref is passed by value.
// NOLINTNEXTLINE(performance-unnecessary-value-param)
void MultibodyDynamics::Jacobian(const ContactPoint& point, Eigen::Ref<MatrixXd> J) const {
  CheckPoint(point);
  if (model_->is_identity()) {
    kinematics().PointJacobian(point.link, point.p_L, J);
    return;
  }
  MatrixXd tree(3, model_->tree().nv());
  kinematics().PointJacobian(point.link, point.p_L, tree);
  model_->ReduceColumns(tree, J);
}

const PointDerivatives& MultibodyDynamics::DifferentiatePoint(const ContactPoint& point) {
  CheckPoint(point);
  const PointDerivatives& tree = tree_.DifferentiatePoint(point.link, point.p_L);
  if (model_->is_identity()) return tree;
  const auto reduce = [&](const MatrixXd& from, MatrixXd* to) {
    to->resize(3, model_->nv());
    model_->ReduceColumns(from, *to);
  };
  reduce(tree.jacobian, &point_.jacobian);
  reduce(tree.velocity_dq, &point_.velocity_dq);
  reduce(tree.acceleration_dq, &point_.acceleration_dq);
  reduce(tree.acceleration_dv, &point_.acceleration_dv);
  return point_;
}

void MultibodyDynamics::AddPointForce(const ContactPoint& point, const Eigen::Vector3d& force,
                                      Eigen::Ref<VectorXd> forces) const {
  CheckPoint(point);
  VectorXd tree = VectorXd::Zero(model_->tree().nv());
  kinematics().AddPointForce(point.link, point.p_L, force, &tree);
  if (model_->is_identity()) {
    forces += tree;
  } else {
    forces += model_->IndependentForces(tree);
  }
}

void MultibodyDynamics::AddPointForceDerivative(
    const ContactPoint& point, const Eigen::Vector3d& force,
    // NOLINTNEXTLINE(performance-unnecessary-value-param)
    Eigen::Ref<MatrixXd> dq) const {
  CheckPoint(point);
  if (model_->is_identity()) {
    tree_.AddPointForceDerivative(point.link, point.p_L, force, dq);
    return;
  }
  const int n = model_->tree().nv();
  MatrixXd tree = MatrixXd::Zero(n, n);
  tree_.AddPointForceDerivative(point.link, point.p_L, force, tree);
  AddReduced(tree, dq);
}

const CentroidalQuantities& MultibodyDynamics::Centroidal() {
  const CentroidalQuantities& tree = tree_.Centroidal();
  if (model_->is_identity()) return tree;
  centroidal_.position = tree.position;
  centroidal_.momentum = tree.momentum;
  model_->ReduceColumns(tree.jacobian, centroidal_.jacobian);
  model_->ReduceColumns(tree.momentum_dq, centroidal_.momentum_dq);
  model_->ReduceColumns(tree.momentum_dv, centroidal_.momentum_dv);
  return centroidal_;
}

const HessianProduct& MultibodyDynamics::Hessian(const Eigen::Ref<const VectorXd>& lambda,
                                                 const std::vector<PointTerm>& terms) {
  Check("lambda", lambda, model_->nv());
  for (const PointTerm& term : terms) CheckPoint({term.link, term.p_L});
  if (model_->is_identity()) return tree_.Hessian(lambda, terms);
  const HessianProduct& tree = tree_.Hessian(model_->TreeVelocity(lambda), terms);
  Reduce(tree.qq, &hessian_.qq);
  Reduce(tree.qv, &hessian_.qv);
  Reduce(tree.vv, &hessian_.vv);
  Reduce(tree.qa, &hessian_.qa);
  return hessian_;
}

const MatrixXd& MultibodyDynamics::DifferentiateVirtualVelocity(const ContactPoint& point) {
  CheckPoint(point);
  const MatrixXd& tree = tree_.DifferentiateVirtualVelocity(point.link, point.p_L);
  if (model_->is_identity()) return tree;
  virtual_velocity_dq_.resize(3, model_->nv());
  model_->ReduceColumns(tree, virtual_velocity_dq_);
  return virtual_velocity_dq_;
}

}  // namespace possibility::dynamics
