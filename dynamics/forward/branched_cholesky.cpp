#include "dynamics/forward/branched_cholesky.h"

#include <cmath>
#include <cstddef>

namespace possibility::dynamics {

namespace {

// A pivot below this fraction of its diagonal entry counts as rounding.
constexpr double kPivot = 1e-13;

}  // namespace

BranchedCholesky::BranchedCholesky(int size, const std::vector<std::vector<int>>& cliques)
    : columns_(size), L_(size, size), inverse_diagonal_(size) {
  L_.setZero();
  using Pattern = Eigen::Matrix<bool, Eigen::Dynamic, Eigen::Dynamic>;
  Pattern filled = Pattern::Constant(size, size, false);
  for (const std::vector<int>& clique : cliques) {
    for (const int i : clique) {
      for (const int j : clique) filled(i, j) = true;
    }
  }
  for (int k = size - 1; k >= 0; --k) {
    for (int j = 0; j < k; ++j) {
      if (filled(k, j)) columns_[k].push_back(j);
    }
    for (const int i : columns_[k]) {
      for (const int j : columns_[k]) filled(i, j) = true;
    }
  }
}

int BranchedCholesky::Factor(const Eigen::MatrixXd& M) {
  const int n = static_cast<int>(columns_.size());
  for (int i = 0; i < n; ++i) {
    for (const int j : columns_[i]) L_(i, j) = M(i, j);
    L_(i, i) = M(i, i);
  }
  for (int k = n - 1; k >= 0; --k) {
    const double pivot = L_(k, k);
    if (!(pivot > kPivot * M(k, k) && std::isfinite(pivot))) return k;
    const double diagonal = std::sqrt(pivot);
    L_(k, k) = diagonal;
    inverse_diagonal_[k] = 1 / diagonal;
    double* row = L_.row(k).data();
    for (const int j : columns_[k]) row[j] *= inverse_diagonal_[k];
    for (const int i : columns_[k]) {
      double* target = L_.row(i).data();
      for (const int j : columns_[k]) {
        if (j > i) break;
        target[j] -= row[i] * row[j];
      }
    }
  }
  return -1;
}

void BranchedCholesky::Solve(Eigen::VectorXd* b) const {
  SolveTransposed(*b);
  SolveLower(*b);
}

void BranchedCholesky::SolveTransposed(Eigen::Ref<Eigen::VectorXd> b) const {
  for (int i = static_cast<int>(columns_.size()) - 1; i >= 0; --i) {
    if (b[i] == 0) continue;
    const double x = b[i] * inverse_diagonal_[i];
    b[i] = x;
    for (const int j : columns_[i]) b[j] -= L_(i, j) * x;
  }
}

void BranchedCholesky::SolveLower(Eigen::Ref<Eigen::VectorXd> b) const {
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    double x = b[i];
    for (const int j : columns_[i]) x -= L_(i, j) * b[j];
    b[i] = x * inverse_diagonal_[i];
  }
}

}  // namespace possibility::dynamics
