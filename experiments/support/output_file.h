#pragma once

#include <filesystem>
#include <string_view>

namespace possibility::experiments {

/// Writes a whole file. An existing file is replaced only once the new content is complete.
/// @throws InputError naming the file if it cannot be written.
void WriteOutput(const std::filesystem::path& file, std::string_view content);

/// Creates a folder (and its parents) and checks that files can be written there.
/// @throws InputError naming the option and the folder if not.
void PrepareOutputFolder(std::string_view option, const std::filesystem::path& folder);

}  // namespace possibility::experiments
