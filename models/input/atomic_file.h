#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace possibility::models {

/// A file that is complete or absent: it is written under another name in the same folder and takes
/// its own with Commit. Its writer holds a lock on it (flock), so whoever writes next into the
/// folder removes what writers that were killed left there. Links stay links; devices and pipes are
/// written directly.
class AtomicFile {
 public:
  /// @throws InputError naming the file if none can be made there.
  explicit AtomicFile(std::filesystem::path file);
  /// Without Commit nothing stays.
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Appends. @throws InputError if the disk is full or fails.
  void Write(std::string_view text);

  /// Replaces what was there. Once only, and last. @throws InputError as Write.
  void Commit();

 private:
  void OpenUnfinished();
  void Flush();
  [[noreturn]] void Fail() const;

  std::filesystem::path file_;
  std::filesystem::path unfinished_;  ///< empty: there is none
  int descriptor_ = -1;
  std::string buffer_;
};

/// The whole file at once. @throws InputError as AtomicFile.
void WriteAtomically(const std::filesystem::path& file, std::string_view text);

}  // namespace possibility::models
