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

/// Gives every element of a sparse matrix one place among its values, even if several blocks add to
/// it.
class ElementSlots {
 public:
  /// The slot of an element; created if there is none yet.
  int At(int row, int column);
  const SparsityPattern& pattern() const { return pattern_; }

 private:
  SparsityPattern pattern_;
  std::map<std::pair<int, int>, int> slots_;
};

/// One function at one instant of a program. Its arguments are forms in the program's variables.
/// Its outputs are rows of the constraints, or a term of the objective times a weight that may be a
/// multiple of a duration. Evaluates itself and adds its derivatives at slots that are found once.
class FunctionBlock {
 public:
  /// `scales`: divisors of the outputs; empty: 1.
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

  // For a term of the objective: weight(x) * f, where f has one output.
  void FindCostSlots(const PolynomialForm& weight, ElementSlots* hessian);
  double Cost(const Eigen::VectorXd& x);
  void AddGradient(const Eigen::VectorXd& x, Eigen::VectorXd* gradient);
  void AddCostHessian(const Eigen::VectorXd& x, double factor, Eigen::VectorXd* values);

 private:
  void FindArguments(const Eigen::VectorXd& x);
  void FindFunctionHessianSlots(ElementSlots* hessian);
  /// Uses the values in multipliers_; returns the number of slots used.
  std::size_t AddFunctionHessian(const Eigen::VectorXd& x, Eigen::VectorXd* values);

  std::shared_ptr<Function> function_;
  std::vector<PolynomialForm> arguments_;
  Eigen::VectorXd factors_;  // by output
  PolynomialForm weight_;
  Mask jacobian_mask_, hessian_mask_;
  int first_row_ = 0;
  std::vector<int> jacobian_slots_;  // in the order of AddJacobian
  std::vector<int> hessian_slots_;
  Eigen::VectorXd z_, y_, multipliers_;
  Eigen::MatrixXd J_, H_;
};

}  // namespace possibility::collocation
