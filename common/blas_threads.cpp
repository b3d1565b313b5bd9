#include "common/blas_threads.h"

#include <dlfcn.h>

namespace possibility {

namespace {

/// A function of OpenBLAS; null if another BLAS is loaded.
template <typename Function>
Function* OfOpenBlas(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_DEFAULT, name));
}

}  // namespace

bool IsForOneThread(std::string_view openblas_config) {
  return openblas_config.find("SINGLE_THREADED") != std::string_view::npos &&
         openblas_config.find("USE_LOCKING") == std::string_view::npos;
}

bool BlasIsForOneThread() {
  auto* const config = OfOpenBlas<const char*()>("openblas_get_config");
  return config != nullptr && IsForOneThread(config());
}

void UseOneThreadInBlas() {
  auto* const set_threads = OfOpenBlas<void(int)>("openblas_set_num_threads");
  if (set_threads != nullptr) set_threads(1);
}

}  // namespace possibility
