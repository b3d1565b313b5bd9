#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "collocation/problem/composed_function.h"
#include "collocation/problem/element_slots.h"
#include "collocation/problem/function.h"
#include "collocation/problem/polynomial_form.h"

namespace possibility::collocation {

/// One function at one instant of a program, whose outputs are rows of the constraints. Evaluates
/// itself and adds its derivatives at slots that are found once.
class ConstraintBlock {
 public:
  /// `scales`: divisors of the outputs; empty: 1.
  ConstraintBlock(std::shared_ptr<Function> function, std::vector<PolynomialForm> arguments,
                  const Eigen::VectorXd& scales = {});

  void FindSlots(int first_row, ElementSlots* jacobian, ElementSlots* hessian);
  /// Slots of the Hessian that were found, one per term that AddHessian adds.
  std::vector<int>* hessian_slots() { return function_.hessian_slots(); }
  const Function& function() const { return function_.function(); }

  /// Writes into rows first_row ... of `constraints`.
  void AddRows(const Eigen::VectorXd& x, Eigen::VectorXd* constraints);
  void AddJacobian(const Eigen::VectorXd& x, Eigen::VectorXd* values);
  /// `multipliers`: of all constraints.
  void AddHessian(const Eigen::VectorXd& x, const Eigen::VectorXd& multipliers,
                  Eigen::VectorXd* values);

 private:
  ComposedFunction function_;
  Eigen::VectorXd factors_;  // by output
  Mask jacobian_mask_;
  int first_row_ = 0;
  std::vector<int> jacobian_slots_;  // in the order of AddJacobian
  Eigen::VectorXd multipliers_;
};

}  // namespace possibility::collocation
