#pragma once

#include <filesystem>
#include <string_view>

namespace possibility::experiments {

/// Writes a whole file, replacing what was there only once the new content is complete.
/// @throws InputError naming the file if it cannot be written.
void WriteOutput(const std::filesystem::path& file, std::string_view content);

/// Makes a folder (and those above it) and makes sure that files can be written there.
/// @throws InputError naming the option and the folder if not.
void PrepareOutputFolder(std::string_view option, const std::filesystem::path& folder);

}  // namespace possibility::experiments
