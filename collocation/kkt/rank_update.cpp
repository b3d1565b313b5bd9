#include "collocation/kkt/rank_update.h"

#include <cstddef>
#include <cstring>

namespace possibility::collocation {
namespace {

/// `Width` numbers in one register, or in several where the processor has none so wide.
template <int Width>
struct VectorOf {
  typedef double Type __attribute__((vector_size(8 * Width)));
};

template <typename Vector>
[[gnu::always_inline]] inline void Load(const double* from, Vector* vector) {
  std::memcpy(vector, from, sizeof(Vector));  // a move from memory that need not be aligned
}

constexpr int kColumns = 6;  // with two vectors of rows: 12 sums, which 16 registers hold

struct Product {
  int depth;
  std::ptrdiff_t stride;
  const double* a;
  const double* b;
  double* c;
};

/// Rows `row` to row + Vectors * Width, columns `column` to column + Columns.
template <int Width, int Vectors, int Columns>
[[gnu::always_inline]] inline void Tile(const Product& p, std::ptrdiff_t row,
                                        std::ptrdiff_t column) {
  using Vector = typename VectorOf<Width>::Type;
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
      target -= sums[j][v];
      std::memcpy(place, &target, sizeof(Vector));
    }
  }
}

/// The last rows share a vector with padding.
template <int Width, int Columns>
[[gnu::always_inline]] inline void Strip(int rows, const Product& p, int column) {
  int row = column;
  for (; row + Width < rows; row += 2 * Width) Tile<Width, 2, Columns>(p, row, column);
  if (row < rows) Tile<Width, 1, Columns>(p, row, column);
}

template <int Width>
[[gnu::always_inline]] inline void Subtract(const LowerSizes& sizes, const Product& p) {
  static_assert(Width <= kPaddingRows + 1 && kColumns == 6);
  int column = 0;
  for (; column + kColumns <= sizes.columns; column += kColumns) {
    Strip<Width, kColumns>(sizes.rows, p, column);
  }
  switch (sizes.columns - column) {
    case 5:
      return Strip<Width, 5>(sizes.rows, p, column);
    case 4:
      return Strip<Width, 4>(sizes.rows, p, column);
    case 3:
      return Strip<Width, 3>(sizes.rows, p, column);
    case 2:
      return Strip<Width, 2>(sizes.rows, p, column);
    case 1:
      return Strip<Width, 1>(sizes.rows, p, column);
    default:
      return;
  }
}

void SubtractPortably(const LowerSizes& sizes, const double* a, const double* b, double* c) {
  Subtract<2>(sizes, {sizes.depth, sizes.stride, a, b, c});
}

#if defined(__x86_64__)
[[gnu::target("avx2,fma")]] void SubtractByAvx2(const LowerSizes& sizes, const double* a,
                                                const double* b, double* c) {
  Subtract<4>(sizes, {sizes.depth, sizes.stride, a, b, c});
}

[[gnu::target("avx512f")]] void SubtractByAvx512(const LowerSizes& sizes, const double* a,
                                                 const double* b, double* c) {
  Subtract<8>(sizes, {sizes.depth, sizes.stride, a, b, c});
}
#endif

std::vector<LowerProduct> Available() {
  std::vector<LowerProduct> available;
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512f")) available.push_back(&SubtractByAvx512);
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
    available.push_back(&SubtractByAvx2);
  }
#endif
  available.push_back(&SubtractPortably);
  return available;
}

}  // namespace

const std::vector<LowerProduct>& LowerProducts() {
  static const std::vector<LowerProduct> available = Available();
  return available;
}

}  // namespace possibility::collocation
