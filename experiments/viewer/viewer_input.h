#pragma once

#include <filesystem>
#include <string>

namespace possibility::experiments {

/// The outermost "format" of a JSON file, read no farther than necessary. Empty if it has none, or
/// if the JSON is malformed before it. Of a ZIP archive, actions::kPackedPlanFormat: it can be
/// nothing else.
/// @throws InputError if the file cannot be read.
std::string FormatOf(const std::filesystem::path& file);

}  // namespace possibility::experiments
