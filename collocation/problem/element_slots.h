#pragma once

#include <map>
#include <utility>

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
  SparsityPattern pattern_;
  std::map<std::pair<int, int>, int> slots_;
};

}  // namespace possibility::collocation
