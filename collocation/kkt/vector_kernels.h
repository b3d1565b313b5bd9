#pragma once

#include <cstddef>
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

/// The matrix [a b; b c].
struct SymmetricPair {
  double a = 0, b = 0, c = 0;
};

/// Columns of a unit lower triangular matrix: of column k the rows below k, one column after the
/// other.
struct FactorPanel {
  int rows = 0;     ///< of the first column, its one included
  int columns = 0;  ///< at most `rows`
  const double* values = nullptr;

  std::size_t entries() const {
    return static_cast<std::size_t>(columns) * rows -
           static_cast<std::size_t>(columns) * (columns + 1) / 2;
  }
};

/// Overwrites x, of panel.rows numbers.
using PanelSolve = void (*)(const FactorPanel& panel, double* x);

/// The inner loops of a factorisation and of its solves, for one kind of processor.
struct VectorKernels {
  LowerProduct subtract_product;
  /// The largest |x_i|; 0 of none.
  double (*largest_magnitude)(const double* x, int size);
  /// Copies x, then x *= factor.
  void (*scale)(double factor, int size, double* x, double* copy);
  /// Copies x and y, then (x_i, y_i) = D (x_i, y_i).
  void (*scale_pair)(const SymmetricPair& d, int size, double* x, double* y, double* copy_x,
                     double* copy_y);
  /// x = L^-1 x, where L has the panel's columns first, then those of the identity.
  PanelSolve solve_down;
  /// x = L'^-1 x.
  PanelSolve solve_up;
};

/// Those that this processor can run, the one with the widest vectors first. Their sums differ in
/// the last bits.
const std::vector<VectorKernels>& AvailableKernels();
/// The first of them.
const VectorKernels& WidestKernels();

}  // namespace possibility::collocation
