#pragma once

namespace possibility::experiments {

inline constexpr int kMaxThreads = 256;

/// Number of threads that this machine runs at the same time: 1 to kMaxThreads; 1 if its BLAS is
/// for one thread.
int HardwareThreads();

}  // namespace possibility::experiments
