#pragma once

#include <cstddef>
#include <vector>

#include "collocation/kkt/kkt_order.h"
#include "common/cancellation_token.h"

namespace possibility::collocation {

/// One front of a multifrontal factorisation: a group of columns that are eliminated together, and
/// the rows below them that their elimination changes. Positions are in elimination order.
struct KktFront {
  int first_column = 0;
  int num_columns = 0;
  int parent = -1;  ///< front, or -1 at a root
  int num_children = 0;
  std::vector<int> rows;  ///< positions, ascending, all after the columns
  /// Position of each of `rows` in the parent, whose columns come first, then its rows.
  std::vector<int> rows_in_parent;

  int size() const { return num_columns + static_cast<int>(rows.size()); }
};

/// The part of a factorisation that depends on the pattern alone.
struct KktAnalysis {
  std::vector<int> variable_at;  ///< elimination position -> row of the matrix
  std::vector<int> position_of;  ///< its inverse
  std::vector<KktFront> fronts;  ///< children before parents, each subtree contiguous

  /// Multiplications of a factorisation without delayed pivots.
  double Flops() const;
  /// Stored numbers of the factor, likewise.
  std::size_t FactorEntries() const;
};

/// Orders the `size` rows of a symmetric indefinite matrix for little fill and groups them into
/// fronts. `num_dual`, `times`: as KktPairs takes them. If one instant after the other makes small
/// fronts, that is the order; otherwise it is that of KktPairs' orders that needs the fewest
/// operations. `cancellation` is asked from time to time.
/// @throws Cancelled.
KktAnalysis AnalyseKkt(int size, int num_dual, const std::vector<KktEdge>& edges,
                       const std::vector<double>& times, const CancellationToken& cancellation);

}  // namespace possibility::collocation
