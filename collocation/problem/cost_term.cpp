#include "collocation/problem/cost_term.h"

namespace possibility::collocation {

CostTerm::CostTerm(std::shared_ptr<Function> function, std::vector<PolynomialForm> arguments,
                   PolynomialForm weight)
    : function_(std::move(function), std::move(arguments)),
      weight_(std::move(weight)),
      multiplier_(function_.num_outputs()) {}

void CostTerm::FindSlots(ElementSlots* hessian) {
  function_.FindHessianSlots(hessian);
  const AllOnes x;
  weight_.Gradient(x, [&](int i, double) {
    for (const PolynomialForm& argument : function_.arguments()) {
      argument.Gradient(x, [&](int j, double) { weight_slots_.push_back(hessian->AtLower(i, j)); });
    }
  });
}

double CostTerm::Evaluate(const Eigen::VectorXd& x) {
  function_.SetPoint(x);
  return weight_.Value(x) * function_.Evaluate()[0];
}

void CostTerm::AddGradient(const Eigen::VectorXd& x, Eigen::VectorXd* gradient) {
  function_.SetPoint(x);
  const Eigen::MatrixXd& J = function_.Jacobian();
  const double weight = weight_.Value(x);
  const std::vector<PolynomialForm>& arguments = function_.arguments();
  for (std::size_t a = 0; a < arguments.size(); ++a) {
    arguments[a].Gradient(x, [&](int variable, double derivative) {
      (*gradient)[variable] += weight * J(0, a) * derivative;
    });
  }
  if (weight_.is_linear()) return;
  const double value = function_.Evaluate()[0];
  weight_.Gradient(
      x, [&](int variable, double derivative) { (*gradient)[variable] += value * derivative; });
}

void CostTerm::AddHessian(const Eigen::VectorXd& x, double factor, Eigen::VectorXd* values) {
  function_.SetPoint(x);
  multiplier_[0] = factor * weight_.Value(x);
  function_.AddHessian(x, multiplier_, values);
  if (weight_.is_linear()) return;
  const Eigen::MatrixXd& J = function_.Jacobian();
  const std::vector<PolynomialForm>& arguments = function_.arguments();
  // The weight is a multiple of the duration: only products with it have second derivatives.
  const int* slot = weight_slots_.data();
  weight_.Gradient(x, [&](int i, double by_weight) {
    for (std::size_t a = 0; a < arguments.size(); ++a) {
      arguments[a].Gradient(x, [&](int j, double derivative) {
        const double both = i == j ? 2 : 1;
        (*values)[*slot++] += both * factor * by_weight * J(0, a) * derivative;
      });
    }
  });
}

}  // namespace possibility::collocation
