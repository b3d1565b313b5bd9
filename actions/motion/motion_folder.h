#pragma once

#include <filesystem>
#include <string>

namespace possibility::actions {

/// Folder of a library for the motions of one identity, a hash; empty if `library` is.
std::filesystem::path MotionFolder(const std::filesystem::path& library,
                                   const std::string& identity);

}  // namespace possibility::actions
