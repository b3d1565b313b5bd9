#include "actions/motion/motion_folder.h"

#include <algorithm>
#include <system_error>

namespace possibility::actions {

std::filesystem::path MotionFolder(const std::filesystem::path& library,
                                   const std::string& identity) {
  return library.empty() ? library : library / identity.substr(0, 16);
}

std::vector<std::filesystem::path> FilesOfIdentities(const std::filesystem::path& library,
                                                     const std::string& name) {
  std::vector<std::filesystem::path> files;
  if (library.empty()) return files;
  std::error_code error;  // a folder that cannot be read has none
  std::filesystem::directory_iterator folder(library, error);
  for (; !error && folder != std::filesystem::directory_iterator(); folder.increment(error)) {
    const std::filesystem::path file = folder->path() / name;
    std::error_code none;
    if (std::filesystem::is_regular_file(file, none)) files.push_back(file);
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace possibility::actions
