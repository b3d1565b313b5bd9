#pragma once

#include <cstddef>
#include <vector>

#include "collocation/problem/nonlinear_program.h"

namespace possibility::collocation {

/// Gives every element of a sparse matrix one place among its values, even if several functions add
/// to it.
class ElementSlots {
 public:
  /// The slot of an element; created if there is none yet.
  int At(int row, int column);
  /// The slot of an element of a symmetric matrix, of which the lower triangle is stored.
  int AtLower(int i, int j);
  const SparsityPattern& pattern() const { return pattern_; }

 private:
  /// Where the table has the element's slot, or a free place for it.
  int& Place(int row, int column);
  void Grow();

  SparsityPattern pattern_;
  std::vector<int> table_;  ///< slots by hash, -1: free; at most half full, a power of two long
  int shift_ = 64;          ///< of hashes, to places in the table
};

}  // namespace possibility::collocation
