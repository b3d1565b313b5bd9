#pragma once

#include <filesystem>
#include <string>

namespace possibility::experiments {

/// What a JSON file says of itself: its outermost "format", looked for no farther than it has to
/// be. Empty if it has none, or no JSON is found before it.
/// @throws InputError if the file cannot be read.
std::string FormatOf(const std::filesystem::path& file);

}  // namespace possibility::experiments
