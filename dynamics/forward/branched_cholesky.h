#pragma once

#include <Eigen/Core>
#include <vector>

namespace possibility::dynamics {

/// The factorisation M = L'L (L lower triangular) of a symmetric positive definite matrix whose
/// zeros are known beforehand. For the mass matrix of a tree, numbered from the root outward, there
/// is no fill-in (Featherstone 2008, section 6.5), so a branch costs only its own depth.
/// Nothing is allocated after construction.
class BranchedCholesky {
 public:
  /// `cliques`: sets of indices below `size`; M(i, j) may differ from zero only if some set holds
  /// both i and j.
  BranchedCholesky(int size, const std::vector<std::vector<int>>& cliques);

  /// Reads the lower triangle of `M` (size x size). Returns -1, or the first index (from the last
  /// one down) whose pivot is not positive: then M is not positive definite to working precision.
  int Factor(const Eigen::MatrixXd& M);

  /// b <- M^-1 b.
  void Solve(Eigen::VectorXd* b) const;
  /// b <- L^-T b.
  void SolveTransposed(Eigen::Ref<Eigen::VectorXd> b) const;
  /// b <- L^-1 b.
  void SolveLower(Eigen::Ref<Eigen::VectorXd> b) const;

 private:
  using RowMajorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  std::vector<std::vector<int>> columns_;  ///< by row of L: off-diagonal columns, ascending
  RowMajorMatrix L_;
  Eigen::VectorXd inverse_diagonal_;
};

}  // namespace possibility::dynamics
