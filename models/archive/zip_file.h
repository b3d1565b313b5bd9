#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "models/input/atomic_file.h"

namespace possibility::models {

/// How hard a member is deflated.
enum class Deflation {
  kFast,      ///< for numbers, which hardly shrink
  kThorough,  ///< as small as it gets
};

/// Writes a ZIP archive (PKWARE's APPNOTE 6.3, without ZIP64), each member deflated. Equal members
/// give equal bytes.
class ZipWriter {
 public:
  /// @throws InputError naming the file if it cannot be created.
  explicit ZipWriter(const std::filesystem::path& file, Deflation deflation = Deflation::kFast);

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
  Deflation deflation_;
  AtomicFile file_;
  std::vector<Member> members_;
  std::uint64_t size_ = 0;
};

/// Reads the members of a ZIP archive, stored or deflated, one at a time.
class ZipReader {
 public:
  /// `bytes` must outlive it. `file`: for messages.
  /// @throws InputError naming `file` if the directory is malformed, names a member twice or one
  /// that is encrypted, or its members are more than 1 GiB together.
  ZipReader(std::string_view bytes, const std::filesystem::path& file);

  bool Has(const std::string& name) const { return members_.contains(name); }
  std::vector<std::string> Names() const;
  /// Bytes of a member once it is unpacked, as the directory says. 0: no such member.
  std::uint64_t SizeOf(const std::string& name) const;

  /// @throws InputError naming the file if there is no such member, it is malformed, or its CRC is
  /// wrong.
  std::string Read(const std::string& name) const;

 private:
  struct Member {
    int method = 0;
    std::uint32_t crc = 0;
    std::uint32_t packed = 0;  ///< bytes
    std::uint32_t size = 0;    ///< bytes
    std::uint32_t offset = 0;
  };
  class Directory;

  std::string_view bytes_;
  std::string file_;
  std::map<std::string, Member> members_;
};

/// Whether a file's first bytes are those of a ZIP archive.
bool IsZip(std::string_view bytes);

/// All members of a ZIP archive by name. @throws InputError as ZipReader does.
std::map<std::string, std::string> ReadZip(const std::string& bytes,
                                           const std::filesystem::path& file);

}  // namespace possibility::models
