#pragma once

#include <filesystem>

namespace possibility::experiments {

/// A new folder for files that nobody needs afterwards. The destructor removes it.
class TemporaryFolder {
 public:
  /// @throws InputError if there is no room for one.
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace possibility::experiments
