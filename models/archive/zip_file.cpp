#include "models/archive/zip_file.h"

#include <fmt/format.h>
#include <zlib.h>

#include <limits>

#include "models/archive/little_endian.h"
#include "models/input/input_error.h"

namespace possibility::models {
namespace {

constexpr std::uint32_t kLocalHeader = 0x04034b50;
constexpr std::uint32_t kDirectoryEntry = 0x02014b50;
constexpr std::uint32_t kEndOfDirectory = 0x06054b50;
constexpr std::uint16_t kVersion = 20;  // deflate
constexpr std::uint16_t kStored = 0;
constexpr std::uint16_t kDeflated = 8;
constexpr std::uint16_t kEncrypted = 1;
constexpr std::uint16_t kFirstOfJanuary1980 = 0x21;  // the earliest date of the format
constexpr std::size_t kEndSize = 22;
constexpr std::size_t kLongestComment = 65535;
constexpr std::uint64_t kMaxUnpacked = 1u << 30;

std::string Deflated(std::string_view content, Deflation deflation,
                     const std::filesystem::path& file) {
  z_stream stream = {};
  const int level = deflation == Deflation::kFast ? Z_BEST_SPEED : Z_BEST_COMPRESSION;
  // Without zlib's own header, as ZIP wants it.
  if (deflateInit2(&stream, level, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY) != Z_OK) {
    throw InputError(fmt::format("{}: not enough memory to compress", file.string()));
  }
  std::string packed(deflateBound(&stream, content.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(content.data()));
  stream.avail_in = static_cast<uInt>(content.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  deflate(&stream, Z_FINISH);  // one call is enough: the output has deflateBound bytes
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

std::string Inflated(std::string_view packed, std::size_t size, const std::string& where) {
  z_stream stream = {};
  std::string content(size, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
  stream.avail_in = static_cast<uInt>(packed.size());
  stream.next_out = reinterpret_cast<Bytef*>(content.data());
  stream.avail_out = static_cast<uInt>(size);
  if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) {
    throw InputError(fmt::format("{}: not enough memory to decompress", where));
  }
  const int status = inflate(&stream, Z_FINISH);
  const bool whole = status == Z_STREAM_END && stream.total_out == size;
  inflateEnd(&stream);
  if (!whole) throw InputError(fmt::format("{}: spoilt, expected a deflated member", where));
  return content;
}

std::uint32_t Crc(std::string_view content) {
  return static_cast<std::uint32_t>(
      crc32(0, reinterpret_cast<const Bytef*>(content.data()), static_cast<uInt>(content.size())));
}

}  // namespace

ZipWriter::ZipWriter(const std::filesystem::path& file, Deflation deflation)
    : path_(file), deflation_(deflation), file_(file) {}

void ZipWriter::Write(const std::string& bytes) {
  size_ += bytes.size();
  if (size_ > std::numeric_limits<std::uint32_t>::max()) {
    throw InputError(fmt::format(
        "{}: exceeds the 4 GiB of a ZIP archive, expected less motion or a longer period",
        path_.string()));
  }
  file_.Write(bytes);
}

void ZipWriter::Add(const std::string& name, std::string_view content) {
  if (content.size() > std::numeric_limits<std::uint32_t>::max()) {
    throw InputError(
        fmt::format("{}: {} exceeds the 4 GiB of a ZIP archive, expected less motion or a longer "
                    "period",
                    path_.string(), name));
  }
  const std::string packed = Deflated(content, deflation_, path_);
  members_.push_back({name, Crc(content), static_cast<std::uint32_t>(packed.size()),
                      static_cast<std::uint32_t>(content.size()),
                      static_cast<std::uint32_t>(size_)});
  const Member& member = members_.back();
  std::string header;
  AppendLittleEndian(kLocalHeader, &header);
  for (const std::uint16_t field :
       {kVersion, std::uint16_t{0}, kDeflated, std::uint16_t{0}, kFirstOfJanuary1980}) {
    AppendLittleEndian(field, &header);
  }
  for (const std::uint32_t field : {member.crc, member.packed, member.size}) {
    AppendLittleEndian(field, &header);
  }
  AppendLittleEndian(static_cast<std::uint16_t>(name.size()), &header);
  AppendLittleEndian(std::uint16_t{0}, &header);
  Write(header + name);
  Write(packed);
}

void ZipWriter::Commit() {
  const auto begin = static_cast<std::uint32_t>(size_);
  for (const Member& member : members_) {
    std::string entry;
    AppendLittleEndian(kDirectoryEntry, &entry);
    for (const std::uint16_t field :
         {kVersion, kVersion, std::uint16_t{0}, kDeflated, std::uint16_t{0}, kFirstOfJanuary1980}) {
      AppendLittleEndian(field, &entry);
    }
    for (const std::uint32_t field : {member.crc, member.packed, member.size}) {
      AppendLittleEndian(field, &entry);
    }
    AppendLittleEndian(static_cast<std::uint16_t>(member.name.size()), &entry);
    entry.append(12, '\0');  // no extra field, comment, disk or attributes
    AppendLittleEndian(member.offset, &entry);
    Write(entry + member.name);
  }
  const auto end = static_cast<std::uint32_t>(size_);
  const auto count = static_cast<std::uint16_t>(members_.size());
  std::string text;
  AppendLittleEndian(kEndOfDirectory, &text);
  AppendLittleEndian(std::uint32_t{0}, &text);  // this and the first disk
  AppendLittleEndian(count, &text);
  AppendLittleEndian(count, &text);
  AppendLittleEndian(end - begin, &text);
  AppendLittleEndian(begin, &text);
  AppendLittleEndian(std::uint16_t{0}, &text);  // no comment
  Write(text);
  file_.Commit();
}

/// Reads the directory, which is at the end of the archive.
class ZipReader::Directory {
 public:
  explicit Directory(ZipReader* reader) : reader_(reader) {}

  void Read() {
    LittleEndianReader end = At(*reader_, FindEnd());
    end.Skip(10);
    const auto count = end.Read<std::uint16_t>();
    end.Skip(4);
    LittleEndianReader directory = At(*reader_, end.Read<std::uint32_t>());
    for (int i = 0; i < count; ++i) ReadEntry(&directory);
  }

  static LittleEndianReader At(const ZipReader& reader, std::size_t offset) {
    if (offset > reader.bytes_.size()) Fail(reader, "truncated");
    return {reader.bytes_.substr(offset), reader.file_};
  }

  [[noreturn]] static void Fail(const ZipReader& reader, const std::string& what) {
    throw InputError(fmt::format("{}: {}, expected a ZIP archive", reader.file_, what));
  }

 private:
  std::size_t FindEnd() const {
    std::string mark;
    AppendLittleEndian(kEndOfDirectory, &mark);
    const std::string_view bytes = reader_->bytes_;
    const std::size_t place = bytes.rfind(mark);
    if (place == std::string::npos || place + kEndSize > bytes.size() ||
        bytes.size() - place > kEndSize + kLongestComment) {
      Fail(*reader_, "no directory of a ZIP archive");
    }
    return place;
  }

  void ReadEntry(LittleEndianReader* directory) {
    if (directory->Read<std::uint32_t>() != kDirectoryEntry) Fail(*reader_, "spoilt directory");
    Member member;
    directory->Skip(4);
    const auto flags = directory->Read<std::uint16_t>();
    member.method = directory->Read<std::uint16_t>();
    directory->Skip(4);
    member.crc = directory->Read<std::uint32_t>();
    member.packed = directory->Read<std::uint32_t>();
    member.size = directory->Read<std::uint32_t>();
    const auto name_size = directory->Read<std::uint16_t>();
    const auto extra_size = directory->Read<std::uint16_t>();
    const auto comment_size = directory->Read<std::uint16_t>();
    directory->Skip(8);
    member.offset = directory->Read<std::uint32_t>();
    const std::string name(directory->Bytes(name_size));
    directory->Skip(static_cast<std::size_t>(extra_size) + comment_size);
    if (flags & kEncrypted) Fail(*reader_, "encrypted");
    unpacked_ += member.size;
    if (unpacked_ > kMaxUnpacked) Fail(*reader_, "more than 1 GiB of members");
    if (!reader_->members_.emplace(name, member).second) Fail(*reader_, "two members " + name);
  }

  ZipReader* reader_;
  std::uint64_t unpacked_ = 0;
};

ZipReader::ZipReader(std::string_view bytes, const std::filesystem::path& file)
    : bytes_(bytes), file_(file.string()) {
  Directory(this).Read();
}

std::vector<std::string> ZipReader::Names() const {
  std::vector<std::string> names;
  names.reserve(members_.size());
  for (const auto& [name, member] : members_) names.push_back(name);
  return names;
}

std::uint64_t ZipReader::SizeOf(const std::string& name) const {
  const auto found = members_.find(name);
  return found == members_.end() ? 0 : found->second.size;
}

std::string ZipReader::Read(const std::string& name) const {
  const auto found = members_.find(name);
  if (found == members_.end()) Directory::Fail(*this, "no member " + name);
  const Member& member = found->second;
  LittleEndianReader local = Directory::At(*this, member.offset);
  if (local.Read<std::uint32_t>() != kLocalHeader) {
    Directory::Fail(*this, "spoilt header of a member");
  }
  local.Skip(22);
  const auto name_size = local.Read<std::uint16_t>();
  const auto extra_size = local.Read<std::uint16_t>();
  local.Skip(static_cast<std::size_t>(name_size) + extra_size);
  const std::string_view packed = local.Bytes(member.packed);
  std::string content;
  if (member.method == kDeflated) {
    content = Inflated(packed, member.size, file_ + ": " + name);
  } else if (member.method == kStored && packed.size() == member.size) {
    content = packed;
  } else {
    Directory::Fail(*this, name +
                               " is compressed in a way unknown here, expected a stored or "
                               "deflated member");
  }
  if (Crc(content) != member.crc) Directory::Fail(*this, "wrong CRC of " + name);
  return content;
}

bool IsZip(std::string_view bytes) {
  return bytes.substr(0, 4) == std::string_view("PK\x03\x04", 4);
}

std::map<std::string, std::string> ReadZip(const std::string& bytes,
                                           const std::filesystem::path& file) {
  const ZipReader reader(bytes, file);
  std::map<std::string, std::string> members;
  for (const std::string& name : reader.Names()) members[name] = reader.Read(name);
  return members;
}

}  // namespace possibility::models
