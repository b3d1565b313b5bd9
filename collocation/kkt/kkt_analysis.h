#pragma once

#include <vector>

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
};

/// The part of a factorisation that depends on the pattern alone.
struct KktAnalysis {
  std::vector<int> variable_at;  ///< elimination position -> row of the matrix
  std::vector<int> position_of;  ///< its inverse
  std::vector<KktFront> fronts;  ///< children before parents, each subtree contiguous
};

/// An off-diagonal entry of a symmetric matrix, with its relative size.
struct KktEdge {
  int row = 0;
  int column = 0;
  double weight = 0;
};

/// Orders the `size` rows of a symmetric indefinite matrix for little fill and groups them into
/// fronts. Each of the last `num_dual` rows, which may have a zero diagonal, is paired with its
/// heaviest neighbour among the other rows that is still free, so that the two can serve as one 2x2
/// pivot (Duff & Pralet 2005). The pairs are then ordered by approximate minimum degree.
/// `cancellation` is asked from time to time. @throws Cancelled.
KktAnalysis AnalyseKkt(int size, int num_dual, const std::vector<KktEdge>& edges,
                       const CancellationToken& cancellation);

}  // namespace possibility::collocation
