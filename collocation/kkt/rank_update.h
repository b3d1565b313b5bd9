#pragma once

#include <vector>

namespace possibility::collocation {

/// Rows below the last one that a LowerProduct may read and overwrite.
constexpr int kPaddingRows = 7;

struct LowerSizes {
  int rows = 0;     ///< of all three
  int columns = 0;  ///< of C, at most `rows`
  int depth = 0;    ///< columns of A and B
  int stride = 0;   ///< numbers from column to column of all three
};

/// C -= A B' at and below the diagonal of C; entries above it may be written, too. Columns of A and
/// C go on for kPaddingRows more.
using LowerProduct = void (*)(const LowerSizes& sizes, const double* a, const double* b, double* c);

/// The ways that this processor knows, the one with the widest vectors first. Their sums differ in
/// the last bits.
const std::vector<LowerProduct>& LowerProducts();

}  // namespace possibility::collocation
