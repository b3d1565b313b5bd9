#pragma once

#include <string>
#include <vector>

#include "collocation/diagnosis/conflict.h"
#include "collocation/transcription/transcription.h"

namespace possibility::collocation {

/// One line for all members of one name and bound, heaviest first: "move: force is at most 1 (21
/// points)", "move: x is fixed at 0", "move: knee on the ground".
std::vector<std::string> Describe(const Conflict& conflict, const Transcription& program);

}  // namespace possibility::collocation
