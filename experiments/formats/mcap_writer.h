#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "models/input/atomic_file.h"

namespace possibility::experiments {

/// Bytes of records of an MCAP file (version 0 of the public specification).
namespace mcap {

inline constexpr std::string_view kMagic("\x89MCAP0\r\n", 8);

enum class Opcode : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kAttachment = 0x09,
  kAttachmentIndex = 0x0a,
  kStatistics = 0x0b,
  kMetadata = 0x0c,
  kMetadataIndex = 0x0d,
  kSummaryOffset = 0x0e,
  kDataEnd = 0x0f,
};

}  // namespace mcap

/// Writes an MCAP file: JSON messages in chunks that are compressed with zstd, indexed by time and
/// channel, with CRCs. Equal calls give equal bytes.
class McapWriter {
 public:
  /// `library`: names the program. @throws InputError naming the file if it cannot be created.
  McapWriter(const std::filesystem::path& file, const std::string& library);

  /// `schema`: JSON schema of messages called `name`.
  std::uint16_t AddSchema(const std::string& name, const std::string& schema);
  /// Before the channel's first message. `schema`: from AddSchema.
  std::uint16_t AddChannel(const std::string& topic, std::uint16_t schema);
  void AddMetadata(const std::string& name, const std::map<std::string, std::string>& entries);

  /// `time`: ns, not before the last message's.
  /// @throws InputError if the disk is full or fails.
  void Write(std::uint16_t channel, std::uint64_t time, std::string_view json);

  /// Writes indexes and replaces an older file. Call once, at the end.
  void Commit();

 private:
  struct ChunkPlace {
    std::uint64_t start_time = 0, end_time = 0;
    std::uint64_t offset = 0, length = 0;  ///< of the chunk record
    std::map<std::uint16_t, std::uint64_t> index_offsets;
    std::uint64_t index_length = 0;
    std::uint64_t compressed = 0, uncompressed = 0;
  };
  struct MessagePlace {
    std::uint64_t time = 0;
    std::uint64_t offset = 0;  ///< within the uncompressed records of the chunk
  };
  struct MetadataPlace {
    std::string name;
    std::uint64_t offset = 0, length = 0;
  };

  /// Appends to the file, and to its CRC.
  void Put(std::string_view bytes);
  void WriteChunk();
  std::string SummarySection();
  std::string Statistics() const;

  models::AtomicFile file_;
  std::uint64_t size_ = 0;
  std::uint32_t crc_ = 0;             ///< of all bytes so far
  std::uint64_t summary_offset_ = 0;  ///< where the summary offsets begin

  std::vector<std::string> schemas_;   ///< records
  std::vector<std::string> channels_;  ///< records
  std::map<std::uint16_t, std::uint64_t> message_counts_;
  std::vector<ChunkPlace> chunks_;
  std::vector<MetadataPlace> metadata_;

  std::string chunk_;  ///< records, not compressed
  std::map<std::uint16_t, std::vector<MessagePlace>> chunk_index_;
  std::uint64_t chunk_start_ = 0, chunk_end_ = 0;
};

}  // namespace possibility::experiments
