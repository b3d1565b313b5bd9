#include "experiments/formats/zip_file.h"

#include <fmt/format.h>
#include <zlib.h>

#include <limits>

#include "experiments/formats/little_endian.h"
#include "models/input/input_error.h"

namespace possibility::experiments {
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

std::string Deflated(std::string_view content, const std::filesystem::path& file) {
  z_stream stream = {};
  // Without zlib's own header, as ZIP wants it. Fast, because numbers hardly shrink.
  if (deflateInit2(&stream, Z_BEST_SPEED, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY) != Z_OK) {
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

/// Reads an archive from its directory, which is at its end.
class ZipReader {
 public:
  ZipReader(const std::string& bytes, const std::filesystem::path& file)
      : bytes_(bytes), file_(file.string()) {}

  std::map<std::string, std::string> Read() {
    LittleEndianReader end = At(FindEnd());
    end.Skip(10);
    const auto count = end.Read<std::uint16_t>();
    end.Skip(4);
    LittleEndianReader directory = At(end.Read<std::uint32_t>());
    std::map<std::string, std::string> members;
    for (int i = 0; i < count; ++i) ReadMember(&directory, &members);
    return members;
  }

 private:
  LittleEndianReader At(std::size_t offset) const {
    if (offset > bytes_.size()) Fail("truncated");
    return {std::string_view(bytes_).substr(offset), file_};
  }

  std::size_t FindEnd() const {
    std::string mark;
    AppendLittleEndian(kEndOfDirectory, &mark);
    const std::size_t place = bytes_.rfind(mark);
    if (place == std::string::npos || place + kEndSize > bytes_.size() ||
        bytes_.size() - place > kEndSize + kLongestComment) {
      Fail("no directory of a ZIP archive");
    }
    return place;
  }

  void ReadMember(LittleEndianReader* directory, std::map<std::string, std::string>* members) {
    if (directory->Read<std::uint32_t>() != kDirectoryEntry) Fail("spoilt directory");
    directory->Skip(4);
    const auto flags = directory->Read<std::uint16_t>();
    const auto method = directory->Read<std::uint16_t>();
    directory->Skip(4);
    const auto crc = directory->Read<std::uint32_t>();
    const auto packed = directory->Read<std::uint32_t>();
    const auto size = directory->Read<std::uint32_t>();
    const auto name_size = directory->Read<std::uint16_t>();
    const auto extra_size = directory->Read<std::uint16_t>();
    const auto comment_size = directory->Read<std::uint16_t>();
    directory->Skip(8);
    const auto offset = directory->Read<std::uint32_t>();
    const std::string name(directory->Bytes(name_size));
    directory->Skip(static_cast<std::size_t>(extra_size) + comment_size);
    if (flags & kEncrypted) Fail("encrypted");
    unpacked_ += size;
    if (unpacked_ > kMaxUnpacked) Fail("more than 1 GiB of members");
    const std::string content = Unpack(Packed(offset, packed), method, size, name);
    if (Crc(content) != crc) Fail("wrong CRC of " + name);
    if (!members->emplace(name, content).second) Fail("two members " + name);
  }

  std::string_view Packed(std::size_t offset, std::size_t size) const {
    LittleEndianReader local = At(offset);
    if (local.Read<std::uint32_t>() != kLocalHeader) Fail("spoilt header of a member");
    local.Skip(22);
    const auto name_size = local.Read<std::uint16_t>();
    const auto extra_size = local.Read<std::uint16_t>();
    local.Skip(static_cast<std::size_t>(name_size) + extra_size);
    return local.Bytes(size);
  }

  std::string Unpack(std::string_view packed, int method, std::size_t size,
                     const std::string& name) const {
    if (method == kDeflated) return Inflated(packed, size, file_ + ": " + name);
    if (method != kStored || packed.size() != size) {
      Fail(name + " is compressed in a way unknown here, expected a stored or deflated member");
    }
    return std::string(packed);
  }

  [[noreturn]] void Fail(const std::string& what) const {
    throw InputError(fmt::format("{}: {}, expected a ZIP archive", file_, what));
  }

  const std::string& bytes_;
  std::string file_;
  std::uint64_t unpacked_ = 0;
};

}  // namespace

ZipWriter::ZipWriter(const std::filesystem::path& file) : path_(file), file_(file) {}

void ZipWriter::Write(const std::string& bytes) {
  size_ += bytes.size();
  if (size_ > std::numeric_limits<std::uint32_t>::max()) {
    throw InputError(fmt::format(
        "{}: exceeds the 4 GiB of a ZIP archive, expected a longer --period", path_.string()));
  }
  file_.Write(bytes);
}

void ZipWriter::Add(const std::string& name, std::string_view content) {
  if (content.size() > std::numeric_limits<std::uint32_t>::max()) {
    throw InputError(
        fmt::format("{}: {} exceeds 4 GiB, expected a longer --period", path_.string(), name));
  }
  const std::string packed = Deflated(content, path_);
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

std::map<std::string, std::string> ReadZip(const std::string& bytes,
                                           const std::filesystem::path& file) {
  return ZipReader(bytes, file).Read();
}

}  // namespace possibility::experiments
