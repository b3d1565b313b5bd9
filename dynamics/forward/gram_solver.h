#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace possibility::dynamics {

/// Solves Y'Y x = r for the x of least square norm. Y (n x m) may have any rank; r must be in the
/// range of Y'.
class GramSolver {
 public:
  void Factor(const Eigen::Ref<const Eigen::MatrixXd>& Y);

  /// Overwrites `x` (m) and `residual` (m): r - Y'Y x. The residual is about rounding if r lies in
  /// the range, and never NaN for finite arguments that do not overflow.
  void Solve(const Eigen::Ref<const Eigen::VectorXd>& r, double tolerance, Eigen::VectorXd* x,
             Eigen::VectorXd* residual) const;

  /// About (Y'Y)^+ R for a matrix R (m x k) whose columns are in the range of Y': accurate to 1e-7
  /// of the result in well-determined directions.
  Eigen::MatrixXd SolveRoughly(const Eigen::Ref<const Eigen::MatrixXd>& R) const;

 private:
  void SolveOrthogonally(const Eigen::Ref<const Eigen::VectorXd>& r, Eigen::VectorXd* x,
                         Eigen::VectorXd* residual) const;

  Eigen::MatrixXd Y_;
  Eigen::MatrixXd gram_;
  Eigen::LLT<Eigen::MatrixXd> regularised_;
};

}  // namespace possibility::dynamics
