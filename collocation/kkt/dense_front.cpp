#include "collocation/kkt/dense_front.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace possibility::collocation {
namespace {

// Pivots are chosen among the next few columns, which each pivot updates at once. The other columns
// of a block get the updates of a whole window, those behind it the updates of the whole block.
constexpr int kWindow = 8;
constexpr int kBlock = 64;
constexpr double kSafeThreshold = 0.01;  // tried before the caller's threshold, which is laxer
constexpr double kZeroPivot = 1e-13;     // entries are of order one

}  // namespace

void DenseFront::Reset(int size) {
  size_ = size;
  stride_ = size + kPaddingRows;
  num_pivots_ = num_negative_ = first_scaled_ = 0;
  has_zero_candidate_ = false;
  index_.clear();
  pivots_.clear();
  inverse_diagonal_.clear();
  inverse_subdiagonal_.clear();
  const size_t entries = static_cast<size_t>(size) * stride_;
  if (values_.size() < entries) values_.resize(entries);
  for (int j = 0; j < size; ++j) std::fill(column(j) + j, column(j) + size, 0.0);
}

double DenseFront::LargestBeside(int k) const {
  double largest = 0;
  for (int j = num_pivots_; j < k; ++j) largest = std::max(largest, std::abs(column(j)[k]));
  return std::max(largest, kernels_->largest_magnitude(column(k) + k + 1, size_ - k - 1));
}

bool DenseFront::IsZero(int k) const {
  return std::abs(column(k)[k]) <= kZeroPivot && LargestBeside(k) <= kZeroPivot;
}

int DenseFront::LargestCandidateBeside(int k) const {
  int found = -1;
  double largest = 0;
  auto look = [&](int i, double entry) {
    if (std::abs(entry) > largest) {
      largest = std::abs(entry);
      found = i;
    }
  };
  for (int j = num_pivots_; j < k; ++j) look(j, column(j)[k]);
  for (int i = k + 1; i < candidates_; ++i) look(i, column(k)[i]);
  return found;
}

void DenseFront::Swap(int p, int q) {
  if (p == q) return;
  if (p > q) std::swap(p, q);
  for (int j = 0; j < p; ++j) std::swap(column(j)[p], column(j)[q]);
  for (int j = p + 1; j < q; ++j) std::swap(column(p)[j], column(j)[q]);
  std::swap(column(p)[p], column(q)[q]);
  std::swap_ranges(column(p) + q + 1, column(p) + size_, column(q) + q + 1);
  std::swap(index_[p], index_[q]);  // pending updates lie beyond the window, in no swapped row
}

int DenseFront::TryColumn(int k, int window, double threshold) {
  const double a = column(k)[k];
  const double largest = LargestBeside(k);
  if (std::abs(a) > kZeroPivot && std::abs(a) >= threshold * largest) {
    Swap(num_pivots_, k);
    return 1;
  }
  int partner = LargestCandidateBeside(k);
  if (partner < 0 || partner >= window) return 0;  // not up to date beyond the window
  const double b = column(std::min(k, partner))[std::max(k, partner)];
  const double c = column(partner)[partner];
  const double largest_there = LargestBeside(partner);
  // |D^-1| times the largest entries beside the pair bounds the multipliers (Duff & Reid 1983).
  const double determinant = std::abs(a * c - b * b);
  const double first = std::abs(c) * largest + std::abs(b) * largest_there;
  const double second = std::abs(b) * largest + std::abs(a) * largest_there;
  if (std::abs(b) <= kZeroPivot || determinant <= kZeroPivot * std::abs(b) ||
      threshold * std::max(first, second) > determinant) {
    return 0;
  }
  if (partner == num_pivots_) partner = k;  // where the first swap puts it
  Swap(num_pivots_, k);
  Swap(num_pivots_ + 1, partner);
  return 2;
}

int DenseFront::FindPivot(int window, double threshold) {
  for (int k = num_pivots_; k < window; ++k) {
    const int found = TryColumn(k, window, threshold);
    if (found > 0) return found;
  }
  return 0;
}

void DenseFront::EliminateSingle(int window) {
  const int k = num_pivots_;
  double* multipliers = column(k);
  const double pivot = multipliers[k];
  const double inverse = 1 / pivot;
  kernels_->scale(inverse, size_ - k - 1, multipliers + k + 1, scaled(k) + k + 1);
  Update(k, 1, k + 1, window);
  multipliers[k] = 1;
  pivots_.push_back(kSingle);
  inverse_diagonal_.push_back(inverse);
  inverse_subdiagonal_.push_back(0);
  num_negative_ += pivot < 0;
  num_pivots_ += 1;
}

void DenseFront::EliminatePair(int window) {
  const int k = num_pivots_;
  double* first = column(k);
  double* second = column(k + 1);
  const double a = first[k], b = first[k + 1], c = second[k + 1];
  const double determinant = a * c - b * b;
  const double ia = c / determinant, ib = -b / determinant, ic = a / determinant;
  const int below = k + 2;
  kernels_->scale_pair({ia, ib, ic}, size_ - below, first + below, second + below,
                       scaled(k) + below, scaled(k + 1) + below);
  Update(k, 2, k + 2, window);
  first[k] = second[k + 1] = 1;
  first[k + 1] = 0;
  pivots_.push_back(kPairFirst);
  pivots_.push_back(kPairSecond);
  inverse_diagonal_.insert(inverse_diagonal_.end(), {ia, ic});
  inverse_subdiagonal_.insert(inverse_subdiagonal_.end(), {ib, 0.0});
  num_negative_ += determinant < 0 ? 1 : (a < 0 ? 2 : 0);
  num_pivots_ += 2;
}

void DenseFront::Update(int first_pivot, int count, int from, int to) {
  if (from >= to || count == 0) return;
  kernels_->subtract_product({size_ - from, to - from, count, stride_}, column(first_pivot) + from,
                             scaled(first_pivot) + from, column(from) + from);
}

void DenseFront::Eliminate(int candidates, double threshold, bool last,
                           const CancellationToken& cancellation) {
  candidates_ = candidates;
  const size_t buffer = static_cast<size_t>(stride_) * std::max(candidates, 1);
  if (scaled_.size() < buffer) scaled_.resize(buffer);
  const double safe = std::max(threshold, kSafeThreshold);
  int block = std::min(candidates, kBlock);
  int window = std::min(block, kWindow);
  int first_in_window = 0;
  while (num_pivots_ < candidates) {
    int found = FindPivot(window, safe);
    if (found == 0) found = FindPivot(window, threshold);
    if (found == 0 && last && window == candidates) found = FindPivot(window, 0);
    if (found == 1) EliminateSingle(window);
    if (found == 2) EliminatePair(window);
    if (found > 0 && num_pivots_ < window) continue;
    // The window is used up, or needs more columns to choose from.
    Update(first_in_window, num_pivots_ - first_in_window, window, block);
    if (window == block) {
      Update(first_scaled_, num_pivots_ - first_scaled_, block, size_);
      if (size_ > 10 * kBlock) cancellation.ThrowIfCancelled();
      if (found == 0 && block == candidates) break;
      first_scaled_ = num_pivots_;
      block = std::min(candidates, block + kBlock);
    }
    first_in_window = num_pivots_;
    window = std::min(block, window + kWindow);
  }
  for (int k = num_pivots_; k < candidates && !has_zero_candidate_; ++k) {
    has_zero_candidate_ = IsZero(k);
  }
}

}  // namespace possibility::collocation
