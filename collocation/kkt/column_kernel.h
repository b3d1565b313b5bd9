#pragma once

#include <algorithm>
#include <cmath>

#include "collocation/kkt/simd_vector.h"
#include "collocation/kkt/vector_kernels.h"

namespace possibility::collocation {

/// The kernels of VectorKernels for single columns, with vectors of `Width` numbers.
template <int Width>
class ColumnKernel {
 public:
  [[gnu::always_inline]] static double LargestMagnitude(const double* x, int size) {
    Vector largest = {};
    int i = 0;
    for (; i + Width <= size; i += Width) {
      Vector numbers;
      Load(x + i, &numbers);
      const Vector magnitudes = numbers < 0 ? -numbers : numbers;
      largest = magnitudes > largest ? magnitudes : largest;
    }
    double result = 0;
    for (int w = 0; w < Width; ++w) result = std::max(result, largest[w]);
    for (; i < size; ++i) result = std::max(result, std::abs(x[i]));
    return result;
  }

  [[gnu::always_inline]] static void Scale(double factor, int size, double* x, double* copy) {
    int i = 0;
    for (; i + Width <= size; i += Width) {
      Vector numbers;
      Load(x + i, &numbers);
      Store(numbers, copy + i);
      Store(numbers * factor, x + i);
    }
    for (; i < size; ++i) {
      copy[i] = x[i];
      x[i] *= factor;
    }
  }

  [[gnu::always_inline]] static void ScalePair(const SymmetricPair& d, int size, double* x,
                                               double* y, double* copy_x, double* copy_y) {
    int i = 0;
    for (; i + Width <= size; i += Width) {
      Vector first, second;
      Load(x + i, &first);
      Load(y + i, &second);
      Store(first, copy_x + i);
      Store(second, copy_y + i);
      Store(d.a * first + d.b * second, x + i);
      Store(d.b * first + d.c * second, y + i);
    }
    for (; i < size; ++i) {
      const double first = copy_x[i] = x[i];
      const double second = copy_y[i] = y[i];
      x[i] = d.a * first + d.b * second;
      y[i] = d.b * first + d.c * second;
    }
  }

 private:
  using Vector = typename SimdVector<Width>::Type;
};

}  // namespace possibility::collocation
