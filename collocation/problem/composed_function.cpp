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
  for (const PolynomialForm& argument : arguments_) {
    first_slope_.push_back(static_cast<int>(slope_variables_.size()));
    argument.Gradient(x, [&](int variable, double) { slope_variables_.push_back(variable); });
  }
  first_slope_.push_back(static_cast<int>(slope_variables_.size()));
  slopes_.resize(slope_variables_.size());
  for (std::size_t a = 0; a < n; ++a) {
    for (std::size_t b = 0; b < n; ++b) {
      if (!hessian_mask_(a, b)) continue;
      for (int i = first_slope_[a]; i < first_slope_[a + 1]; ++i) {
        for (int j = first_slope_[b]; j < first_slope_[b + 1]; ++j) {
          const int row = slope_variables_[i], column = slope_variables_[j];
          if (row >= column) hessian_slots_.push_back(hessian->At(row, column));
        }
      }
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
  double* slope = slopes_.data();
  for (const PolynomialForm& argument : arguments_) {
    argument.Gradient(x, [&slope](int, double derivative) { *slope++ = derivative; });
  }
  const int* slot = hessian_slots_.data();
  const std::size_t n = arguments_.size();
  for (std::size_t a = 0; a < n; ++a) {
    for (std::size_t b = 0; b < n; ++b) {
      if (!hessian_mask_(a, b)) continue;
      for (int i = first_slope_[a]; i < first_slope_[a + 1]; ++i) {
        const double by_row = H_(a, b) * slopes_[i];
        for (int j = first_slope_[b]; j < first_slope_[b + 1]; ++j) {
          if (slope_variables_[i] < slope_variables_[j]) continue;
          (*values)[*slot++] += by_row * slopes_[j];
        }
      }
    }
    if (arguments_[a].is_linear()) continue;
    const double multiplier = multipliers.dot(J_.col(static_cast<Eigen::Index>(a)));
    arguments_[a].Hessian(
        x, [&](int, int, double second) { (*values)[*slot++] += multiplier * second; });
  }
}

}  // namespace possibility::collocation
