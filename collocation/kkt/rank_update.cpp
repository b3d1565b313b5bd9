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

template <int Columns>
[[gnu::always_inline]] inline void Row(const Product& p, std::ptrdiff_t row,
                                       std::ptrdiff_t column) {
  for (int j = 0; j < Columns; ++j) {
    double sum = 0;
    for (int k = 0; k < p.depth; ++k) {
      sum += p.a[k * p.stride + row] * p.b[k * p.stride + column + j];
    }
    p.c[(column + j) * p.stride + row] -= sum;
  }
}

template <int Width, int Columns>
[[gnu::always_inline]] inline void Strip(int size, const Product& p, int column) {
  int row = column;
  for (; row + 2 * Width <= size; row += 2 * Width) Tile<Width, 2, Columns>(p, row, column);
  if (row + Width <= size) {
    Tile<Width, 1, Columns>(p, row, column);
    row += Width;
  }
  for (; row < size; ++row) Row<Columns>(p, row, column);
}

template <int Width>
[[gnu::always_inline]] inline void Subtract(int size, const Product& p) {
  int column = 0;
  for (; column + kColumns <= size; column += kColumns) Strip<Width, kColumns>(size, p, column);
  for (; column < size; ++column) Strip<Width, 1>(size, p, column);
}

void SubtractPortably(int size, int depth, int stride, const double* a, const double* b,
                      double* c) {
  Subtract<2>(size, {depth, stride, a, b, c});
}

#if defined(__x86_64__)
[[gnu::target("avx2,fma")]] void SubtractByAvx2(int size, int depth, int stride, const double* a,
                                                const double* b, double* c) {
  Subtract<4>(size, {depth, stride, a, b, c});
}

[[gnu::target("avx512f")]] void SubtractByAvx512(int size, int depth, int stride, const double* a,
                                                 const double* b, double* c) {
  Subtract<8>(size, {depth, stride, a, b, c});
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
