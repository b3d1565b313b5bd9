#pragma once

#include <cstddef>

#include "collocation/kkt/simd_vector.h"
#include "collocation/kkt/vector_kernels.h"

namespace possibility::collocation {

/// LowerProduct with vectors of `Width` numbers.
template <int Width>
class LowerProductKernel {
 public:
  [[gnu::always_inline]] static void Subtract(const LowerSizes& sizes, const double* a,
                                              const double* b, double* c) {
    const Product product = {sizes.rows, sizes.depth, sizes.stride, a, b, c};
    int column = 0;
    for (; column + kColumns <= sizes.columns; column += kColumns) {
      Strip<kColumns>(product, column);
    }
    switch (sizes.columns - column) {
      case 5:
        return Strip<5>(product, column);
      case 4:
        return Strip<4>(product, column);
      case 3:
        return Strip<3>(product, column);
      case 2:
        return Strip<2>(product, column);
      case 1:
        return Strip<1>(product, column);
      default:
        return;
    }
  }

 private:
  using Vector = typename SimdVector<Width>::Type;

  static constexpr int kColumns = 6;  // with two vectors of rows: 12 sums, which 16 registers hold
  static_assert(Width <= kPaddingRows + 1);

  struct Product {
    int rows, depth;
    std::ptrdiff_t stride;
    const double* a;
    const double* b;
    double* c;
  };

  /// Rows `row` to row + Vectors * Width, columns `column` to column + Columns.
  template <int Vectors, int Columns>
  [[gnu::always_inline]] static void Tile(const Product& p, std::ptrdiff_t row,
                                          std::ptrdiff_t column) {
    Vector sums[Columns][Vectors] = {};
    const double* a = p.a + row;
    const double* b = p.b + column;
    for (int k = 0; k < p.depth; ++k, a += p.stride, b += p.stride) {
      Vector rows[Vectors];
#pragma GCC unroll 8
      for (int v = 0; v < Vectors; ++v) Load(a + v * Width, &rows[v]);
#pragma GCC unroll 8
      for (int j = 0; j < Columns; ++j) {
#pragma GCC unroll 8
        for (int v = 0; v < Vectors; ++v) sums[j][v] += rows[v] * b[j];
      }
    }
#pragma GCC unroll 8
    for (int j = 0; j < Columns; ++j) {
#pragma GCC unroll 8
      for (int v = 0; v < Vectors; ++v) {
        double* place = p.c + (column + j) * p.stride + row + v * Width;
        Vector target;
        Load(place, &target);
        Store(target - sums[j][v], place);
      }
    }
  }

  /// The last rows share a vector with padding.
  template <int Columns>
  [[gnu::always_inline]] static void Strip(const Product& p, int column) {
    int row = column;
    for (; row + Width < p.rows; row += 2 * Width) Tile<2, Columns>(p, row, column);
    if (row < p.rows) Tile<1, Columns>(p, row, column);
  }
};

}  // namespace possibility::collocation
