#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "models/input/atomic_file.h"

namespace possibility::experiments {

/// Writes a ZIP archive (PKWARE's APPNOTE 6.3, without ZIP64), each member deflated. Equal members
/// give equal bytes.
class ZipWriter {
 public:
  /// @throws InputError naming the file if it cannot be created.
  explicit ZipWriter(const std::filesystem::path& file);

  /// Adds a member. @throws InputError if the disk is full, or the archive would exceed 4 GiB.
  void Add(const std::string& name, std::string_view content);
  /// Writes the directory and replaces an older file. Call once, at the end.
  void Commit();

 private:
  struct Member {
    std::string name;
    std::uint32_t crc = 0;
    std::uint32_t packed = 0;  ///< bytes
    std::uint32_t size = 0;    ///< bytes
    std::uint32_t offset = 0;
  };
  void Write(const std::string& bytes);

  std::filesystem::path path_;
  models::AtomicFile file_;
  std::vector<Member> members_;
  std::uint64_t size_ = 0;
};

/// The members of a ZIP archive by name, stored or deflated.
/// @throws InputError naming `file` if the archive is malformed, encrypted, uses ZIP64, a member's
/// CRC is wrong, or its members are more than 1 GiB together.
std::map<std::string, std::string> ReadZip(const std::string& bytes,
                                           const std::filesystem::path& file);

}  // namespace possibility::experiments
