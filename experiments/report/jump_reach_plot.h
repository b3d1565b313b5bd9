#pragma once

#include <string>
#include <vector>

#include "actions/jump/jump_sweep.h"

namespace possibility::experiments {

/// An SVG of which jumps were found and which were not, over distance and height, and what an
/// answer cost over distance.
std::string JumpReachPicture(const std::vector<actions::JumpSweepEntry>& entries);

}  // namespace possibility::experiments
