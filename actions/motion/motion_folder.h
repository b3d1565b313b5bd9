#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace possibility::actions {

/// Folder of a library for the motions of one identity, a hash; empty if `library` is.
std::filesystem::path MotionFolder(const std::filesystem::path& library,
                                   const std::string& identity);

/// The files `name` of all identities in a library, in the order of their paths. None if there is
/// no such folder.
std::vector<std::filesystem::path> FilesOfIdentities(const std::filesystem::path& library,
                                                     const std::string& name);

}  // namespace possibility::actions
