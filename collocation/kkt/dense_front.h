#pragma once

#include <functional>
#include <vector>

namespace possibility::collocation {

/// A symmetric matrix F of which the first columns are to be eliminated: F = L D L' there, and the
/// Schur complement in what is left. Only the lower triangle is kept, column by column.
class DenseFront {
 public:
  /// How an eliminated column pivots.
  enum Pivot : char { kSingle, kPairFirst, kPairSecond };

  /// All zero, of `size` rows, which `index` names (any numbers; they follow the permutation).
  void Reset(int size);
  int size() const { return size_; }
  std::vector<int>& index() { return index_; }
  const std::vector<int>& index() const { return index_; }
  double* column(int j) { return values_.data() + static_cast<size_t>(j) * size_; }
  const double* column(int j) const { return values_.data() + static_cast<size_t>(j) * size_; }

  /// Eliminates as many of the first `candidates` columns as have a stable pivot, 1x1 or 2x2,
  /// among them; they become the first num_pivots columns, the others follow in some order. A
  /// pivot is stable if no multiplier exceeds 1 / threshold; much safer ones are taken first.
  /// With `last`, any pivot that is not zero to rounding will do. Entries should be of order one.
  /// `interrupt` is called between blocks of pivots, and may throw.
  void Eliminate(int candidates, double threshold, bool last,
                 const std::function<void()>& interrupt = {});

  int num_pivots() const { return num_pivots_; }
  /// Whether a candidate that is left has no entry but zeros, to rounding: then it never gets one,
  /// wherever it is eliminated, and the matrix is singular.
  bool has_zero_candidate() const { return has_zero_candidate_; }
  int num_negative() const { return num_negative_; }
  const std::vector<Pivot>& pivots() const { return pivots_; }
  /// The inverse of D: its diagonal, and below the diagonal of each pair (at the pair's first).
  const std::vector<double>& inverse_diagonal() const { return inverse_diagonal_; }
  const std::vector<double>& inverse_subdiagonal() const { return inverse_subdiagonal_; }

 private:
  /// The largest magnitude in row and column k, the diagonal excepted, among what is left.
  double LargestBeside(int k) const;
  bool IsZero(int k) const;
  /// Where it is if only the candidates count; -1 if all are zero.
  int LargestCandidateBeside(int k) const;
  /// Brings a pivot to num_pivots(): returns 0 (none found), 1 or 2, its size.
  int FindPivot(int window, double threshold);
  int TryColumn(int k, int window, double threshold);
  void Swap(int p, int q);
  void EliminateSingle(int window);
  void EliminatePair(int window);
  void UpdateTrailing(int first_pivot, int from);

  int size_ = 0;
  int candidates_ = 0;
  int num_pivots_ = 0;
  int num_negative_ = 0;
  bool has_zero_candidate_ = false;
  std::vector<int> index_;
  std::vector<double> values_;
  std::vector<double> scaled_;  ///< columns of L D whose updates are pending, size_ rows each
  int pending_ = 0;
  std::vector<Pivot> pivots_;
  std::vector<double> inverse_diagonal_, inverse_subdiagonal_;
};

}  // namespace possibility::collocation
