#include "collocation/problem/composed_function.h"

#include <algorithm>

namespace possibility::collocation {

ComposedFunction::ComposedFunction(std::shared_ptr<Function> function,
                                   std::vector<PolynomialForm> arguments)
    : function_(std::move(function)),
      arguments_(std::move(arguments)),
      hessian_mask_(function_->HessianMask()),
      z_(function_->num_inputs()),
      y_(function_->num_outputs()),
      J_(function_->num_outputs(), function_->num_inputs()),
      H_(function_->num_inputs(), function_->num_inputs()) {}

void ComposedFunction::FindHessianSlots(ElementSlots* hessian) {
  const AllOnes x;
  const std::size_t n = arguments_.size();
  for (std::size_t a = 0; a < n; ++a) {
    for (std::size_t b = 0; b < n; ++b) {
      if (!hessian_mask_(a, b)) continue;
      arguments_[a].Gradient(x, [&](int row, double) {
        arguments_[b].Gradient(x, [&](int column, double) {
          if (row >= column) hessian_slots_.push_back(hessian->At(row, column));
        });
      });
    }
    arguments_[a].Hessian(
        x, [&](int i, int j, double) { hessian_slots_.push_back(hessian->AtLower(i, j)); });
  }
}

void ComposedFunction::SetPoint(const Eigen::VectorXd& x) {
  for (std::size_t a = 0; a < arguments_.size(); ++a) {
    z_[static_cast<Eigen::Index>(a)] = arguments_[a].Value(x);
  }
}

const Eigen::VectorXd& ComposedFunction::Evaluate() {
  function_->Evaluate(z_, &y_);
  return y_;
}

const Eigen::MatrixXd& ComposedFunction::Jacobian() {
  function_->Jacobian(z_, &J_);
  return J_;
}

void ComposedFunction::AddHessian(const Eigen::VectorXd& x, const Eigen::VectorXd& multipliers,
                                  Eigen::VectorXd* values) {
  function_->Hessian(z_, multipliers, &H_);
  const bool bends = std::any_of(arguments_.begin(), arguments_.end(),
                                 [](const PolynomialForm& form) { return !form.is_linear(); });
  if (bends) function_->Jacobian(z_, &J_);
  const int* slot = hessian_slots_.data();
  const std::size_t n = arguments_.size();
  for (std::size_t a = 0; a < n; ++a) {
    for (std::size_t b = 0; b < n; ++b) {
      if (!hessian_mask_(a, b)) continue;
      arguments_[a].Gradient(x, [&](int row, double by_row) {
        arguments_[b].Gradient(x, [&](int column, double by_column) {
          if (row >= column) (*values)[*slot++] += H_(a, b) * by_row * by_column;
        });
      });
    }
    if (arguments_[a].is_linear()) continue;
    const double slope = multipliers.dot(J_.col(static_cast<Eigen::Index>(a)));
    arguments_[a].Hessian(x,
                          [&](int, int, double second) { (*values)[*slot++] += slope * second; });
  }
}

}  // namespace possibility::collocation
