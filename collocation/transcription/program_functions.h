#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "collocation/problem/constraint_block.h"
#include "collocation/problem/cost_term.h"
#include "collocation/problem/element_slots.h"
#include "collocation/problem/nonlinear_program.h"
#include "collocation/problem/optimal_control_problem.h"
#include "collocation/transcription/block_group.h"
#include "collocation/transcription/placed_name.h"
#include "collocation/transcription/variable_layout.h"
#include "common/thread_team.h"

namespace possibility::collocation {

/// The constraints and the objective of a nonlinear program and their derivatives: rows that are
/// forms in its variables, rows that are functions, and costs. Points are in the problem's own
/// units, derivatives by scaled variables. The layout must outlive it.
class ProgramFunctions {
 public:
  explicit ProgramFunctions(const VariableLayout& layout);

  /// One linear or bilinear row. All of them come before the first block.
  void AddFormRow(PolynomialForm form, double scale, Bounds bounds, PlacedName name);
  /// One row per output. `scales`: divisors of the rows; empty: 1.
  void AddBlock(ConstraintBlock block, const std::vector<Bounds>& bounds,
                const Eigen::VectorXd& scales, PlacedName name);
  /// One row, the sum of its terms.
  void AddIntegralRow(std::vector<CostTerm> terms, double scale, Bounds bounds, PlacedName name);
  void AddCost(CostTerm cost, PlacedName name);
  /// Blocks are evaluated by several threads from here on: those of different functions at once.
  /// Nothing may be added any more.
  void Share(int threads);

  int num_rows() const { return static_cast<int>(row_lowers_.size()); }
  const std::vector<double>& row_lowers() const { return row_lowers_; }  ///< divided by the scales
  const std::vector<double>& row_uppers() const { return row_uppers_; }
  const std::vector<double>& row_scales() const { return row_scales_; }
  const std::vector<PlacedName>& row_names() const { return row_names_; }
  const SparsityPattern& jacobian_pattern() const { return jacobian_.pattern(); }
  const SparsityPattern& hessian_pattern() const { return hessian_.pattern(); }

  // The same as in NonlinearProgram. A std::runtime_error of a function comes out with the names of
  // the function and its point.
  /// @throws std::runtime_error naming the cost and the point if one is not finite.
  double Objective(const Eigen::VectorXd& x);
  /// @throws std::runtime_error as Objective does.
  void Gradient(const Eigen::VectorXd& x, Eigen::VectorXd* gradient);
  void Constraints(const Eigen::VectorXd& x, Eigen::VectorXd* g);
  void Jacobian(const Eigen::VectorXd& x, Eigen::VectorXd* values);
  /// @throws std::runtime_error naming the function and the point if one is not finite.
  void Hessian(const Eigen::VectorXd& x, double objective_factor,
               const Eigen::VectorXd& multipliers, Eigen::VectorXd* values);

 private:
  struct FormRow {
    PolynomialForm form;
    double factor;
    std::vector<int> jacobian_slots, hessian_slots;
  };

  struct IntegralRow {
    int row;
    double factor;
    std::vector<CostTerm> terms;
    std::vector<int> variables, jacobian_slots;  // of each other
    PlacedName name;
  };

  void PushRow(double scale, Bounds bounds, PlacedName name);
  /// Runs what evaluates a function, with the function's name in its errors.
  template <typename Run>
  void Named(const char* kind, const PlacedName& name, const Run& run) const;
  template <typename Run>
  void ForEachBlock(const Run& run);
  void AddBlocksHessian(const Eigen::VectorXd& x, const Eigen::VectorXd& multipliers,
                        Eigen::VectorXd* values);
  template <typename Run>
  void ForEachCost(const Run& run);
  /// For each integral row and each of its terms.
  template <typename Run>
  void ForEachIntegralTerm(const Run& run);
  void AddIntegralRowsJacobian(const Eigen::VectorXd& x, Eigen::VectorXd* values);
  [[noreturn]] void FailForGradient(const Eigen::VectorXd& x);
  /// Returns if every function's part of the Hessian is finite.
  void FailForHessian(const Eigen::VectorXd& x, double objective_factor,
                      const Eigen::VectorXd& multipliers);

  const VariableLayout& layout_;
  Eigen::VectorXd ones_;  // point at which forms are visited to find their variables
  std::vector<double> row_scales_, row_lowers_, row_uppers_;
  std::vector<PlacedName> row_names_, block_names_, cost_names_;
  std::vector<FormRow> form_rows_;  // the first rows
  std::vector<ConstraintBlock> blocks_;
  std::vector<BlockGroup> groups_;  // of all blocks, if threads share them; else none
  std::unique_ptr<ThreadTeam> team_;
  std::vector<IntegralRow> integral_rows_;
  std::vector<CostTerm> costs_;
  ElementSlots jacobian_, hessian_;
};

}  // namespace possibility::collocation
