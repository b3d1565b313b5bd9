#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "collocation/problem/element_slots.h"
#include "collocation/problem/function.h"
#include "collocation/problem/polynomial_form.h"

namespace possibility::collocation {

/// A function whose arguments are forms in a program's variables x. Adds its second derivatives by
/// x at slots that are found once.
class ComposedFunction {
 public:
  ComposedFunction(std::shared_ptr<Function> function, std::vector<PolynomialForm> arguments);

  int num_outputs() const { return function_->num_outputs(); }
  const std::vector<PolynomialForm>& arguments() const { return arguments_; }
  const Function& function() const { return *function_; }

  void FindHessianSlots(ElementSlots* hessian);
  /// Those that were found, one per term of AddHessian.
  std::vector<int>* hessian_slots() { return &hessian_slots_; }

  /// Call it before everything below.
  void SetPoint(const Eigen::VectorXd& x);
  const Eigen::VectorXd& Evaluate();
  /// By the arguments: outputs x arguments.
  const Eigen::MatrixXd& Jacobian();
  /// Adds the Hessian of multipliers' f by x. `x`: the point set; `multipliers`: one per output.
  void AddHessian(const Eigen::VectorXd& x, const Eigen::VectorXd& multipliers,
                  Eigen::VectorXd* values);

 private:
  std::shared_ptr<Function> function_;
  std::vector<PolynomialForm> arguments_;
  Mask hessian_mask_;
  std::vector<int> hessian_slots_;  // in the order of AddHessian
  /// By argument: where its gradient begins in `slopes_`, and the end of the last.
  std::vector<int> first_slope_;
  std::vector<int> slope_variables_;
  std::vector<double> slopes_;  ///< of AddHessian
  Eigen::VectorXd z_, y_;
  Eigen::MatrixXd J_, H_;
};

}  // namespace possibility::collocation
