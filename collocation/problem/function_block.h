#pragma once

#include <Eigen/Core>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "collocation/problem/function.h"
#include "collocation/problem/nonlinear_program.h"
#include "collocation/problem/polynomial_form.h"

namespace possibility::collocation {

/// Gives every element of a sparse matrix one place among its values, however many blocks add to
/// it.
class ElementSlots {
 public:
  /// The slot of an element, new if it has none yet.
  int At(int row, int column);
  const SparsityPattern& pattern() const { return pattern_; }

 private:
  SparsityPattern pattern_;
  std::map<std::pair<int, int>, int> slots_;
};

/// One function at one instant of a program: its arguments are forms in the program's variables,
/// its outputs rows of the constraints, or a term of the objective times a weight that may grow
/// with a duration. Evaluates itself and adds its derivatives at slots found once.
class FunctionBlock {
 public:
  /// `scales`: what the outputs are divided by; none for 1.
  FunctionBlock(std::shared_ptr<Function> function, std::vector<PolynomialForm> arguments,
                const Eigen::VectorXd& scales = {});

  const Function& function() const { return *function_; }
  void FindSlots(int first_row, ElementSlots* jacobian, ElementSlots* hessian);

  /// Writes into rows first_row ... of `constraints`.
  void AddRows(const Eigen::VectorXd& x, Eigen::VectorXd* constraints);
  void AddJacobian(const Eigen::VectorXd& x, Eigen::VectorXd* values);
  /// `multipliers`: of all constraints.
  void AddHessian(const Eigen::VectorXd& x, const Eigen::VectorXd& multipliers,
                  Eigen::VectorXd* values);

  // As a term of the objective, weight(x) * f, f of one output.
  void FindCostSlots(const PolynomialForm& weight, ElementSlots* hessian);
  double Cost(const Eigen::VectorXd& x);
  void AddGradient(const Eigen::VectorXd& x, Eigen::VectorXd* gradient);
  void AddCostHessian(const Eigen::VectorXd& x, double factor, Eigen::VectorXd* values);

 private:
  void FindArguments(const Eigen::VectorXd& x);
  void FindFunctionHessianSlots(ElementSlots* hessian);
  /// Multipliers already in multipliers_; returns the number of slots used.
  std::size_t AddFunctionHessian(const Eigen::VectorXd& x, Eigen::VectorXd* values);

  std::shared_ptr<Function> function_;
  std::vector<PolynomialForm> arguments_;
  Eigen::VectorXd factors_;  // by output
  PolynomialForm weight_;
  Mask jacobian_mask_, hessian_mask_;
  int first_row_ = 0;
  std::vector<int> jacobian_slots_;  // in the order in which AddJacobian visits
  std::vector<int> hessian_slots_;
  Eigen::VectorXd z_, y_, multipliers_;
  Eigen::MatrixXd J_, H_;
};

}  // namespace possibility::collocation
