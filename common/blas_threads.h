#pragma once

#include <string_view>

namespace possibility {

/// True if a BLAS of this description must not be called by several threads at once. OpenBLAS
/// built without threads and without USE_LOCKING (Debian's libopenblas0-serial) hands the same
/// buffer to all callers: their results are wrong, without a word. `openblas_config` is what its
/// openblas_get_config() says.
bool IsForOneThread(std::string_view openblas_config);

/// The same of the BLAS that this program has loaded. Simbody and Ipopt call it.
bool BlasIsForOneThread();

/// Keeps the loaded BLAS from starting threads of its own: solves run side by side already, and
/// what several threads add up depends on their number. It concerns the whole process.
void UseOneThreadInBlas();

}  // namespace possibility
