#pragma once

#include <vector>

namespace possibility::collocation {

/// C -= A B' in the lower triangle of C, which is square; entries above the diagonal may be
/// written, too. All matrices are stored column by column with `stride` numbers from column to
/// column. `size`: rows of all three; `depth`: columns of A and B.
using LowerProduct = void (*)(int size, int depth, int stride, const double* a, const double* b,
                              double* c);

/// The ways that this processor knows, the one with the widest vectors first. Their sums differ in
/// the last bits.
const std::vector<LowerProduct>& LowerProducts();

}  // namespace possibility::collocation
