#pragma once

#include "collocation/kkt/simd_vector.h"
#include "collocation/kkt/vector_kernels.h"

namespace possibility::collocation {

/// PanelSolve with vectors of `Width` numbers, four columns at a time.
template <int Width>
class PanelKernel {
 public:
  [[gnu::always_inline]] static void SolveDown(const FactorPanel& panel, double* x) {
    const double* column = panel.values;
    int k = 0;
    for (; k + kColumns <= panel.columns; k += kColumns) {
      column = Block<kColumns>(column, panel.rows, k).Down(x);
    }
    for (; k < panel.columns; ++k) column = Block<1>(column, panel.rows, k).Down(x);
  }

  [[gnu::always_inline]] static void SolveUp(const FactorPanel& panel, double* x) {
    int k = panel.columns;
    const double* end = panel.values + panel.entries();
    while (k % kColumns != 0) {
      --k;
      end -= Block<1>::Entries(panel.rows, k);
      Block<1>(end, panel.rows, k).Up(x);
    }
    while (k > 0) {
      k -= kColumns;
      end -= Block<kColumns>::Entries(panel.rows, k);
      Block<kColumns>(end, panel.rows, k).Up(x);
    }
  }

 private:
  using Vector = typename SimdVector<Width>::Type;
  static constexpr int kColumns = 4;
  static constexpr int kCacheLine = 8;  // numbers

  /// Columns k to k + Columns: a triangle, and the rows below it.
  template <int Columns>
  class Block {
   public:
    /// Stored numbers.
    static int Entries(int rows, int k) {
      return Columns * (rows - k) - Columns * (Columns + 1) / 2;
    }

    [[gnu::always_inline]] Block(const double* values, int rows, int k)
        : first_(k), below_(rows - k - Columns) {
      for (int j = 0; j < Columns; ++j) {
        triangle_[j] = values;
        rest_[j] = values + (Columns - 1 - j);
        values = rest_[j] + below_;
      }
    }

    /// Solves for x at the columns and subtracts them from the rows below. Returns the end of the
    /// block.
    [[gnu::always_inline]] const double* Down(double* x) const {
      double* here = x + first_;
      for (int j = 0; j < Columns; ++j) {
        for (int i = j + 1; i < Columns; ++i) here[i] -= triangle_[j][i - j - 1] * here[j];
      }
      double factors[Columns];
      for (int j = 0; j < Columns; ++j) factors[j] = here[j];
      double* y = here + Columns;
      int i = 0;
      for (; i + Width <= below_; i += Width) {
        Vector sum;
        Load(y + i, &sum);
        Prefetch(end() + Columns * i);
#pragma GCC unroll 8
        for (int j = 0; j < Columns; ++j) {
          Vector entries;
          Load(rest_[j] + i, &entries);
          sum -= entries * factors[j];
        }
        Store(sum, y + i);
      }
      for (; i < below_; ++i) {
        for (int j = 0; j < Columns; ++j) y[i] -= rest_[j][i] * factors[j];
      }
      return end();
    }

    /// Subtracts the rows below from x at the columns and solves for these.
    [[gnu::always_inline]] void Up(double* x) const {
      double* here = x + first_;
      const double* y = here + Columns;
      Vector sums[Columns] = {};
      int i = 0;
      for (; i + Width <= below_; i += Width) {
        Vector numbers;
        Load(y + i, &numbers);
        Prefetch(triangle_[0] - Columns * (i + Width));
#pragma GCC unroll 8
        for (int j = 0; j < Columns; ++j) {
          Vector entries;
          Load(rest_[j] + i, &entries);
          sums[j] += entries * numbers;
        }
      }
      for (int j = Columns - 1; j >= 0; --j) {
        double sum = 0;
        for (int w = 0; w < Width; ++w) sum += sums[j][w];
        for (int r = i; r < below_; ++r) sum += rest_[j][r] * y[r];
        for (int r = j + 1; r < Columns; ++r) sum += triangle_[j][r - j - 1] * here[r];
        here[j] -= sum;
      }
    }

   private:
    const double* end() const { return rest_[Columns - 1] + below_; }

    /// As many numbers as one step of the loops reads: those of the next block, while this one is
    /// computed. Processors foresee one stream of numbers, but not the pages of several.
    [[gnu::always_inline]] static void Prefetch(const double* numbers) {
#pragma GCC unroll 8
      for (int i = 0; i < Columns * Width; i += kCacheLine) __builtin_prefetch(numbers + i);
    }

    int first_, below_;
    const double* triangle_[Columns];
    const double* rest_[Columns];
  };
};

}  // namespace possibility::collocation
