#pragma once

#include <string>
#include <vector>

#include "actions/jump/jump_sweep.h"

namespace possibility::experiments {

/// An SVG of the jumps found and not found, over distance and height, and the cost of answers over
/// distance.
std::string JumpReachPicture(const std::vector<actions::JumpSweepEntry>& entries);

}  // namespace possibility::experiments
