#pragma once

#include <zstd.h>

#include <cstdint>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace possibility::experiments::testing {

/// Reads MCAP by the public specification, without code of the writer.
/// Every function throws std::runtime_error or std::out_of_range if the bytes are not as specified.
struct McapRecord {
  int opcode = 0;
  std::size_t offset = 0;  ///< of the opcode
  std::string content;
};

/// Consecutive fields of a record.
class McapFields {
 public:
  explicit McapFields(const std::string& bytes) : bytes_(bytes.begin(), bytes.end()) {}

  /// An unsigned number, its lowest byte first.
  template <typename Number>
  Number Take() {
    std::uint64_t number = 0;
    for (std::size_t i = 0; i < sizeof(Number); ++i) {
      number |= std::uint64_t{bytes_.at(place_++)} << 8 * i;
    }
    return static_cast<Number>(number);
  }
  std::string Text() { return Bytes(Take<std::uint32_t>()); }
  std::string Bytes(std::size_t size) {
    if (size > bytes_.size() - place_) throw std::runtime_error("truncated record");
    place_ += size;
    return {bytes_.data() + place_ - size, bytes_.data() + place_};
  }
  std::string Rest() { return Bytes(bytes_.size() - place_); }
  bool AtEnd() const { return place_ == bytes_.size(); }

 private:
  std::vector<unsigned char> bytes_;  // of a string GCC 12 thinks them uninitialised
  std::size_t place_ = 0;
};

/// The records in `bytes` from `begin` on, up to `end`.
inline std::vector<McapRecord> McapRecords(const std::string& bytes, std::size_t begin,
                                           std::size_t end) {
  std::vector<McapRecord> records;
  while (begin < end) {
    McapFields head(bytes.substr(begin, 9));
    McapRecord record{head.Take<std::uint8_t>(), begin, ""};
    const auto size = head.Take<std::uint64_t>();
    if (begin + 9 + size > end) throw std::runtime_error("truncated record");
    record.content = bytes.substr(begin + 9, size);
    records.push_back(record);
    begin += 9 + size;
  }
  return records;
}

/// CRC-32 (ISO 3309), bit by bit.
inline std::uint32_t SlowCrc(std::string_view bytes) {
  std::uint32_t crc = 0xffffffff;
  for (const char c : bytes) {
    crc ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320 : 0);
  }
  return ~crc;
}

struct McapMessage {
  int channel = 0;
  std::uint32_t sequence = 0;
  std::uint64_t time = 0;
  std::string data;
};

inline McapMessage ReadMessage(const McapRecord& record) {
  if (record.opcode != 5) throw std::runtime_error("expected a message");
  McapFields fields(record.content);
  McapMessage message;
  message.channel = fields.Take<std::uint16_t>();
  message.sequence = fields.Take<std::uint32_t>();
  message.time = fields.Take<std::uint64_t>();
  if (fields.Take<std::uint64_t>() != message.time) throw std::runtime_error("published later");
  message.data = fields.Rest();
  return message;
}

/// The records of a chunk, decompressed, its size and CRC checked.
inline std::string UnpackedChunk(const McapRecord& record) {
  if (record.opcode != 6) throw std::runtime_error("expected a chunk");
  McapFields fields(record.content);
  fields.Take<std::uint64_t>();
  fields.Take<std::uint64_t>();
  const auto size = fields.Take<std::uint64_t>();
  const auto crc = fields.Take<std::uint32_t>();
  if (fields.Text() != "zstd") throw std::runtime_error("expected zstd");
  const std::string packed = fields.Bytes(fields.Take<std::uint64_t>());
  if (!fields.AtEnd()) throw std::runtime_error("bytes after a chunk");
  std::string unpacked(size, '\0');
  if (ZSTD_decompress(unpacked.data(), size, packed.data(), packed.size()) != size ||
      SlowCrc(unpacked) != crc) {
    throw std::runtime_error("spoilt chunk");
  }
  return unpacked;
}

}  // namespace possibility::experiments::testing
