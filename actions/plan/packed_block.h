#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "actions/plan/packed_phase.h"

namespace possibility::actions {

/// Bytes of the integers of successive phases (docs/file_formats.md): per quantity the number of
/// planes, then the planes. A plane holds one byte of every integer, the lowest plane first.
std::string BlockBytes(const std::vector<PackedPhase>& phases);

/// Inverse of BlockBytes: fills the numbers of phases whose outlines are given. `where`: for
/// messages, names the file and the block.
/// @throws InputError if there are too few bytes, too many, or more than eight planes.
void ReadBlock(std::string_view bytes, const std::string& where, std::vector<PackedPhase>* phases);

}  // namespace possibility::actions
