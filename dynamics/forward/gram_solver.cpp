#include "dynamics/forward/gram_solver.h"

#include <Eigen/QR>

namespace possibility::dynamics {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// Proximal weight as a fraction of the greatest diagonal entry. A direction that has this
// proportion in the Gram matrix converges by a half in each step, usual directions by 1e-3 or
// faster.
constexpr double kProximal = 1e-7;
constexpr int kMaxSteps = 12;
// Directions of Y below this fraction of the largest one count as rounding.
constexpr double kRank = 1e-11;

}  // namespace

void GramSolver::Factor(const Eigen::Ref<const MatrixXd>& Y) {
  Y_ = Y;
  gram_.noalias() = Y_.transpose() * Y_;
  if (gram_.rows() == 0) return;
  MatrixXd regularised = gram_;
  const double largest = gram_.diagonal().maxCoeff();
  regularised.diagonal().array() += largest > 0 ? kProximal * largest : 1.0;
  regularised_.compute(regularised);
}

void GramSolver::Solve(const Eigen::Ref<const VectorXd>& r, double tolerance, VectorXd* x,
                       VectorXd* residual) const {
  x->setZero(r.size());
  *residual = r;
  if (r.size() == 0) return;
  double size = residual->lpNorm<Eigen::Infinity>();
  // The proximal point method: every step stays in the range of Y', where the least norm is.
  for (int step = 0; step < kMaxSteps && size > 0; ++step) {
    const VectorXd candidate = *x + regularised_.solve(*residual);
    const VectorXd left = r - gram_ * candidate;
    const double left_size = left.lpNorm<Eigen::Infinity>();
    if (!(left_size < size)) break;
    const bool slow = left_size > size / 2;
    *x = candidate;
    *residual = left;
    size = left_size;
    if (slow) break;
  }
  if (size > tolerance) SolveOrthogonally(r, x, residual);
}

MatrixXd GramSolver::SolveRoughly(const Eigen::Ref<const MatrixXd>& R) const {
  if (R.rows() == 0) return R;
  return regularised_.solve(R);
}

/// Uses Y P = Q [T 0; 0 0] Z. Keeps directions whose squares are lost to rounding in the Gram
/// matrix.
void GramSolver::SolveOrthogonally(const Eigen::Ref<const VectorXd>& r, VectorXd* x,
                                   VectorXd* residual) const {
  Eigen::CompleteOrthogonalDecomposition<MatrixXd> factors;
  factors.setThreshold(kRank);
  factors.compute(Y_);
  const Eigen::Index rank = factors.rank();
  const auto T = factors.matrixT().topLeftCorner(rank, rank).triangularView<Eigen::Upper>();
  const MatrixXd Z = factors.matrixZ();
  const auto& permutation = factors.colsPermutation();
  const auto apply = [&](const VectorXd& right) -> VectorXd {
    VectorXd s = (Z * (permutation.transpose() * right)).head(rank);
    T.transpose().solveInPlace(s);
    T.solveInPlace(s);
    return permutation * (Z.topRows(rank).transpose() * s);
  };
  const auto left_by = [&](const VectorXd& candidate) -> VectorXd {
    return r - Y_.transpose() * (Y_ * candidate);
  };
  VectorXd candidate = apply(r);
  VectorXd left = left_by(candidate);
  const VectorXd refined = candidate + apply(left);
  const VectorXd refined_left = left_by(refined);
  if (refined_left.norm() < left.norm()) {
    candidate = refined;
    left = refined_left;
  }
  if (!(left.lpNorm<Eigen::Infinity>() < residual->lpNorm<Eigen::Infinity>())) return;
  *x = candidate;
  *residual = left;
}

}  // namespace possibility::dynamics
