#pragma once

#include <cstring>

namespace possibility::collocation {

/// `Width` numbers in one register, or in several where the processor has none so wide. The
/// kernels that use it are inlined into functions that state their processor.
template <int Width>
struct SimdVector {
  typedef double Type __attribute__((vector_size(8 * Width)));
};

template <typename Vector>
[[gnu::always_inline]] inline void Load(const double* from, Vector* vector) {
  std::memcpy(vector, from, sizeof(Vector));  // a move from memory that need not be aligned
}

template <typename Vector>
[[gnu::always_inline]] inline void Store(const Vector& vector, double* to) {
  std::memcpy(to, &vector, sizeof(Vector));
}

}  // namespace possibility::collocation
