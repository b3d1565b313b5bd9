#pragma once

#include <vector>

#include "collocation/kkt/vector_kernels.h"
#include "common/cancellation_token.h"

namespace possibility::collocation {

/// A symmetric matrix F whose first columns are eliminated: F = L D L' there, and the Schur
/// complement in the rest. Only the lower triangle is stored, column by column.
class DenseFront {
 public:
  /// How an eliminated column pivots.
  enum Pivot : char { kSingle, kPairFirst, kPairSecond };

  /// Sets the matrix to zero with `size` rows. index() names the rows (any numbers; they follow the
  /// permutation).
  void Reset(int size);
  int size() const { return size_; }
  std::vector<int>& index() { return index_; }
  const std::vector<int>& index() const { return index_; }
  double* column(int j) { return values_.data() + static_cast<size_t>(j) * stride_; }
  const double* column(int j) const { return values_.data() + static_cast<size_t>(j) * stride_; }

  /// Eliminates as many of the first `candidates` columns as have a stable pivot, 1x1 or 2x2, among
  /// them. They become the first num_pivots columns; the others follow in some order. A pivot is
  /// stable if no multiplier exceeds 1 / threshold; much safer pivots are taken first. With `last`,
  /// any pivot that is not zero to rounding is accepted. Entries should be of order one.
  /// `cancellation` is asked between blocks of pivots. @throws Cancelled.
  void Eliminate(int candidates, double threshold, bool last,
                 const CancellationToken& cancellation = {});

  int num_pivots() const { return num_pivots_; }
  /// Whether a remaining candidate has only zero entries, to rounding. It then never gets another
  /// entry, wherever it is eliminated, and the matrix is singular.
  bool has_zero_candidate() const { return has_zero_candidate_; }
  int num_negative() const { return num_negative_; }
  const std::vector<Pivot>& pivots() const { return pivots_; }
  /// The inverse of D: its diagonal, and the subdiagonal entry of each pair (at the pair's first
  /// column).
  const std::vector<double>& inverse_diagonal() const { return inverse_diagonal_; }
  const std::vector<double>& inverse_subdiagonal() const { return inverse_subdiagonal_; }

 private:
  /// Largest off-diagonal magnitude in row and column k of the remaining matrix.
  double LargestBeside(int k) const;
  bool IsZero(int k) const;
  /// Index of that entry if only the candidates count; -1 if all are zero.
  int LargestCandidateBeside(int k) const;
  /// Moves a pivot to num_pivots(). Returns its size, 1 or 2, or 0 if none is found.
  int FindPivot(int window, double threshold);
  int TryColumn(int k, int window, double threshold);
  void Swap(int p, int q);
  void EliminateSingle(int window);
  void EliminatePair(int window);
  /// What `count` pivots from `first_pivot` on do to the columns from `from` to `to`.
  void Update(int first_pivot, int count, int from, int to);
  /// Of pivot k, the column of L D.
  double* scaled(int k) {
    return scaled_.data() + static_cast<size_t>(k - first_scaled_) * stride_;
  }

  const VectorKernels* kernels_ = &WidestKernels();
  int size_ = 0;
  int stride_ = 0;  ///< from column to column, padding included
  int candidates_ = 0;
  int num_pivots_ = 0;
  int num_negative_ = 0;
  bool has_zero_candidate_ = false;
  std::vector<int> index_;
  std::vector<double> values_;
  std::vector<double> scaled_;  ///< columns of L D whose updates are pending
  int first_scaled_ = 0;        ///< the pivot of the first of them
  std::vector<Pivot> pivots_;
  std::vector<double> inverse_diagonal_, inverse_subdiagonal_;
};

}  // namespace possibility::collocation
