#include "collocation/kkt/vector_kernels.h"

#include "collocation/kkt/column_kernel.h"
#include "collocation/kkt/lower_product.h"
#include "collocation/kkt/panel_kernel.h"

namespace possibility::collocation {
namespace {

// A function can be compiled for another processor than its file, but not a template's instance:
// each kind of processor needs functions of its own.
// NOLINTBEGIN(bugprone-macro-parentheses): an attribute cannot stand in parentheses.
#define POSSIBILITY_KERNELS(Name, Width, Target)                                                  \
  struct Name {                                                                                   \
    Target static void SubtractProduct(const LowerSizes& sizes, const double* a, const double* b, \
                                       double* c) {                                               \
      LowerProductKernel<Width>::Subtract(sizes, a, b, c);                                        \
    }                                                                                             \
    Target static double LargestMagnitude(const double* x, int size) {                            \
      return ColumnKernel<Width>::LargestMagnitude(x, size);                                      \
    }                                                                                             \
    Target static void Scale(double factor, int size, double* x, double* copy) {                  \
      ColumnKernel<Width>::Scale(factor, size, x, copy);                                          \
    }                                                                                             \
    Target static void ScalePair(const SymmetricPair& d, int size, double* x, double* y,          \
                                 double* copy_x, double* copy_y) {                                \
      ColumnKernel<Width>::ScalePair(d, size, x, y, copy_x, copy_y);                              \
    }                                                                                             \
    Target static void SolveDown(const FactorPanel& panel, double* x) {                           \
      PanelKernel<Width>::SolveDown(panel, x);                                                    \
    }                                                                                             \
    Target static void SolveUp(const FactorPanel& panel, double* x) {                             \
      PanelKernel<Width>::SolveUp(panel, x);                                                      \
    }                                                                                             \
  }
// NOLINTEND(bugprone-macro-parentheses)

template <typename Functions>
VectorKernels KernelsOf() {
  return {Functions::SubtractProduct, Functions::LargestMagnitude, Functions::Scale,
          Functions::ScalePair,       Functions::SolveDown,        Functions::SolveUp};
}

POSSIBILITY_KERNELS(Portable, 2, );
#if defined(__x86_64__)
POSSIBILITY_KERNELS(Avx2, 4, [[gnu::target("avx2,fma")]]);
POSSIBILITY_KERNELS(Avx512, 8, [[gnu::target("avx512f")]]);
#endif

#undef POSSIBILITY_KERNELS

std::vector<VectorKernels> FindKernels() {
  std::vector<VectorKernels> available;
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512f")) available.push_back(KernelsOf<Avx512>());
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
    available.push_back(KernelsOf<Avx2>());
  }
#endif
  available.push_back(KernelsOf<Portable>());
  return available;
}

}  // namespace

const std::vector<VectorKernels>& AvailableKernels() {
  static const std::vector<VectorKernels> available = FindKernels();
  return available;
}

const VectorKernels& WidestKernels() {
  static const VectorKernels& widest = AvailableKernels().front();
  return widest;
}

}  // namespace possibility::collocation
