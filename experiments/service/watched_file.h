#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>

#include "common/stopwatch.h"

namespace possibility::experiments {

/// Tells when the bytes at a path change, by looking at it every 20 ms: whether a program writes
/// into the file or renames another over it, on any file system. Any thread may use it.
class WatchedFile {
 public:
  /// Takes the present bytes as known.
  explicit WatchedFile(std::filesystem::path file);

  /// Whether other bytes are there than those known, and have been for 20 ms: writing takes time. A
  /// file that is not there has not changed, because some programs remove it before they write it
  /// again.
  bool HasChanged();
  /// Takes the present bytes as known. Call it before reading them.
  void Accept();
  /// Sleeps until HasChanged.
  void AwaitChange();

 private:
  /// What tells cheaply that a file may have changed.
  struct Stamp {
    dev_t device = 0;
    ino_t file = 0;
    std::int64_t size = 0;
    std::int64_t written_s = 0, written_ns = 0;
    bool operator==(const Stamp&) const = default;
  };

  static std::optional<Stamp> StampOf(const std::filesystem::path& file);
  static std::string HashOf(const std::filesystem::path& file);
  bool Look();

  const std::filesystem::path file_;
  std::mutex mutex_;
  Stopwatch clock_;
  double last_look_ = 0;          ///< s, on clock_
  std::optional<Stamp> known_;    ///< of the known bytes
  std::optional<Stamp> settled_;  ///< of the last look
  std::string known_hash_;
  bool has_changed_ = false;  ///< since Accept
};

}  // namespace possibility::experiments
