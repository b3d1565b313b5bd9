#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "collocation/problem/composed_function.h"
#include "collocation/problem/element_slots.h"
#include "collocation/problem/function.h"
#include "collocation/problem/polynomial_form.h"

namespace possibility::collocation {

/// A term of the objective: weight(x) * f, where f has one output. The weight is a constant or a
/// multiple of a duration.
class CostTerm {
 public:
  CostTerm(std::shared_ptr<Function> function, std::vector<PolynomialForm> arguments,
           PolynomialForm weight);

  void FindSlots(ElementSlots* hessian);
  /// Calls visit(variable) for every variable of the gradient; some more than once.
  template <typename Visit>
  void ForVariables(const Visit& visit) const;

  double Evaluate(const Eigen::VectorXd& x);
  void AddGradient(const Eigen::VectorXd& x, Eigen::VectorXd* gradient);
  /// Adds `factor` times the Hessian.
  void AddHessian(const Eigen::VectorXd& x, double factor, Eigen::VectorXd* values);

 private:
  ComposedFunction function_;
  PolynomialForm weight_;
  std::vector<int> weight_slots_;  // of products of the weight and f, in the order of AddHessian
  Eigen::VectorXd multiplier_;     // 1
};

template <typename Visit>
void CostTerm::ForVariables(const Visit& visit) const {
  std::vector<PolynomialForm> forms = function_.arguments();
  forms.push_back(weight_);
  for (const PolynomialForm& form : forms) {
    form.Gradient(AllOnes(), [&](int variable, double) { visit(variable); });
  }
}

}  // namespace possibility::collocation
