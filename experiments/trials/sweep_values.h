#pragma once

#include <string>
#include <vector>

namespace possibility::experiments {

inline constexpr std::size_t kMaxSweepValues = 10000;

/// "A:B:STEP" (from A in steps, including B if a step hits it) or "a,b,c", ascending, without
/// duplicates.
/// @throws InputError naming the option for anything else.
std::vector<double> ParseSweepValues(const std::string& option, const std::string& text);

}  // namespace possibility::experiments
