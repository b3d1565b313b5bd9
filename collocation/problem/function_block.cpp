#include "collocation/problem/function_block.h"

namespace possibility::collocation {

int ElementSlots::At(int row, int column) {
  const auto [slot, is_new] = slots_.try_emplace({row, column}, pattern_.size());
  if (is_new) pattern_.Add(row, column);
  return slot->second;
}

FunctionBlock::FunctionBlock(std::shared_ptr<Function> function,
                             std::vector<PolynomialForm> arguments, const Eigen::VectorXd& scales)
    : function_(std::move(function)),
      arguments_(std::move(arguments)),
      factors_(scales.size() == 0 ? Eigen::VectorXd::Ones(function_->num_outputs())
                                  : Eigen::VectorXd(scales.cwiseInverse())),
      jacobian_mask_(function_->JacobianMask()),
      hessian_mask_(function_->HessianMask()),
      z_(function_->num_inputs()),
      y_(function_->num_outputs()),
      multipliers_(function_->num_outputs()),
      J_(function_->num_outputs(), function_->num_inputs()),
      H_(function_->num_inputs(), function_->num_inputs()) {}

namespace {

/// An arbitrary point: slots are found by the same visits as in the evaluation.
Eigen::VectorXd PointFor(const std::vector<PolynomialForm>& forms) {
  int greatest = -1;
  for (const PolynomialForm& form : forms) {
    greatest = std::max(greatest, form.duration);
    for (const Monomial& m : form.monomials) greatest = std::max(greatest, m.variable);
  }
  return Eigen::VectorXd::Ones(greatest + 1);
}

int LowerSlot(ElementSlots* hessian, int i, int j) {
  return hessian->At(std::max(i, j), std::min(i, j));
}

}  // namespace

void FunctionBlock::FindArguments(const Eigen::VectorXd& x) {
  for (std::size_t a = 0; a < arguments_.size(); ++a) {
    z_[static_cast<Eigen::Index>(a)] = arguments_[a].Value(x);
  }
}

void FunctionBlock::FindSlots(int first_row, ElementSlots* jacobian, ElementSlots* hessian) {
  first_row_ = first_row;
  const Eigen::VectorXd x = PointFor(arguments_);
  for (std::size_t a = 0; a < arguments_.size(); ++a) {
    arguments_[a].Gradient(x, [&](int variable, double) {
      for (int o = 0; o < function_->num_outputs(); ++o) {
        if (jacobian_mask_(o, a)) jacobian_slots_.push_back(jacobian->At(first_row + o, variable));
      }
    });
  }
  FindFunctionHessianSlots(hessian);
}

void FunctionBlock::FindFunctionHessianSlots(ElementSlots* hessian) {
  const Eigen::VectorXd x = PointFor(arguments_);
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
        x, [&](int i, int j, double) { hessian_slots_.push_back(LowerSlot(hessian, i, j)); });
  }
}

void FunctionBlock::AddRows(const Eigen::VectorXd& x, Eigen::VectorXd* constraints) {
  FindArguments(x);
  function_->Evaluate(z_, &y_);
  constraints->segment(first_row_, y_.size()) = factors_.cwiseProduct(y_);
}

void FunctionBlock::AddJacobian(const Eigen::VectorXd& x, Eigen::VectorXd* values) {
  FindArguments(x);
  function_->Jacobian(z_, &J_);
  const int* slot = jacobian_slots_.data();
  for (std::size_t a = 0; a < arguments_.size(); ++a) {
    arguments_[a].Gradient(x, [&](int, double derivative) {
      for (int o = 0; o < function_->num_outputs(); ++o) {
        if (jacobian_mask_(o, a)) (*values)[*slot++] += factors_[o] * J_(o, a) * derivative;
      }
    });
  }
}

void FunctionBlock::AddHessian(const Eigen::VectorXd& x, const Eigen::VectorXd& multipliers,
                               Eigen::VectorXd* values) {
  FindArguments(x);
  multipliers_ = factors_.cwiseProduct(multipliers.segment(first_row_, function_->num_outputs()));
  AddFunctionHessian(x, values);
}

std::size_t FunctionBlock::AddFunctionHessian(const Eigen::VectorXd& x, Eigen::VectorXd* values) {
  function_->Hessian(z_, multipliers_, &H_);
  const bool bends = std::any_of(arguments_.begin(), arguments_.end(),
                                 [](const PolynomialForm& form) { return !form.is_linear(); });
  if (bends) function_->Jacobian(z_, &J_);
  std::size_t used = 0;
  const std::size_t n = arguments_.size();
  for (std::size_t a = 0; a < n; ++a) {
    for (std::size_t b = 0; b < n; ++b) {
      if (!hessian_mask_(a, b)) continue;
      arguments_[a].Gradient(x, [&](int row, double by_row) {
        arguments_[b].Gradient(x, [&](int column, double by_column) {
          if (row >= column) (*values)[hessian_slots_[used++]] += H_(a, b) * by_row * by_column;
        });
      });
    }
    if (arguments_[a].is_linear()) continue;
    const double slope = multipliers_.dot(J_.col(static_cast<Eigen::Index>(a)));
    arguments_[a].Hessian(
        x, [&](int, int, double second) { (*values)[hessian_slots_[used++]] += slope * second; });
  }
  return used;
}

void FunctionBlock::FindCostSlots(const PolynomialForm& weight, ElementSlots* hessian) {
  weight_ = weight;
  FindFunctionHessianSlots(hessian);
  std::vector<PolynomialForm> all = arguments_;
  all.push_back(weight);
  const Eigen::VectorXd x = PointFor(all);
  weight_.Gradient(x, [&](int i, double) {
    for (const PolynomialForm& argument : arguments_) {
      argument.Gradient(x,
                        [&](int j, double) { hessian_slots_.push_back(LowerSlot(hessian, i, j)); });
    }
  });
}

double FunctionBlock::Cost(const Eigen::VectorXd& x) {
  FindArguments(x);
  function_->Evaluate(z_, &y_);
  return weight_.Value(x) * y_[0];
}

void FunctionBlock::AddGradient(const Eigen::VectorXd& x, Eigen::VectorXd* gradient) {
  FindArguments(x);
  function_->Jacobian(z_, &J_);
  const double weight = weight_.Value(x);
  for (std::size_t a = 0; a < arguments_.size(); ++a) {
    arguments_[a].Gradient(x, [&](int variable, double derivative) {
      (*gradient)[variable] += weight * J_(0, a) * derivative;
    });
  }
  if (weight_.is_linear()) return;
  function_->Evaluate(z_, &y_);
  weight_.Gradient(
      x, [&](int variable, double derivative) { (*gradient)[variable] += y_[0] * derivative; });
}

void FunctionBlock::AddCostHessian(const Eigen::VectorXd& x, double factor,
                                   Eigen::VectorXd* values) {
  FindArguments(x);
  multipliers_[0] = factor * weight_.Value(x);
  std::size_t used = AddFunctionHessian(x, values);
  if (weight_.is_linear()) return;
  function_->Jacobian(z_, &J_);
  // The weight is a multiple of the duration: only products with it have second derivatives.
  weight_.Gradient(x, [&](int i, double by_weight) {
    for (std::size_t a = 0; a < arguments_.size(); ++a) {
      arguments_[a].Gradient(x, [&](int j, double derivative) {
        const double both = i == j ? 2 : 1;
        (*values)[hessian_slots_[used++]] += both * factor * by_weight * J_(0, a) * derivative;
      });
    }
  });
}

}  // namespace possibility::collocation
