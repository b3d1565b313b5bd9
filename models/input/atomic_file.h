#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace possibility::models {

/// A file that is either complete or absent: it is written under a temporary name in the same
/// folder, and Commit renames it. The writer holds a lock on it (flock), so the next writer in the
/// folder recognises and removes files that killed writers left there. Links stay links; devices
/// and pipes are written directly.
class AtomicFile {
 public:
  /// @throws InputError naming the file if it cannot be created.
  explicit AtomicFile(std::filesystem::path file);
  /// Discards the file unless Commit was called.
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Appends. @throws InputError if the disk is full or fails.
  void Write(std::string_view text);

  /// Replaces the previous file. Call once, as the last step. @throws InputError like Write.
  void Commit();

 private:
  void OpenUnfinished();
  void Flush();
  [[noreturn]] void Fail() const;

  std::filesystem::path file_;
  std::filesystem::path unfinished_;  ///< empty if there is none
  int descriptor_ = -1;
  std::string buffer_;
};

/// Writes a whole file at once. @throws InputError like AtomicFile.
void WriteAtomically(const std::filesystem::path& file, std::string_view text);

}  // namespace possibility::models
