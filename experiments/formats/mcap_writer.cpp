#include "experiments/formats/mcap_writer.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <zlib.h>
#include <zstd.h>

#include <stdexcept>

#include "models/archive/little_endian.h"

namespace possibility::experiments {
namespace {

using models::AppendLittleEndian;

using mcap::Opcode;

constexpr std::size_t kChunkSize = 1 << 20;  // bytes, before compression
constexpr int kCompressionLevel = 9;

void AppendText(std::string_view text, std::string* bytes) {
  AppendLittleEndian(static_cast<std::uint32_t>(text.size()), bytes);
  *bytes += text;
}

/// A map or list: its length in bytes, then its entries.
void AppendCounted(const std::string& entries, std::string* bytes) { AppendText(entries, bytes); }

std::string Record(Opcode opcode, std::string_view content) {
  std::string record(1, static_cast<char>(opcode));
  AppendLittleEndian(static_cast<std::uint64_t>(content.size()), &record);
  return record.append(content);
}

std::uint32_t UpdatedCrc(std::uint32_t crc, std::string_view bytes) {
  return static_cast<std::uint32_t>(
      crc32(crc, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size())));
}

std::string Compressed(const std::string& bytes) {
  std::string packed(ZSTD_compressBound(bytes.size()), '\0');
  const std::size_t size =
      ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), kCompressionLevel);
  if (ZSTD_isError(size)) {
    throw std::runtime_error(fmt::format("zstd: {}", ZSTD_getErrorName(size)));
  }
  packed.resize(size);
  return packed;
}

}  // namespace

McapWriter::McapWriter(const std::filesystem::path& file, const std::string& library)
    : file_(file) {
  std::string header;
  AppendText("", &header);  // no profile
  AppendText(library, &header);
  Put(mcap::kMagic);
  Put(Record(Opcode::kHeader, header));
}

void McapWriter::Put(std::string_view bytes) {
  file_.Write(bytes);
  size_ += bytes.size();
  crc_ = UpdatedCrc(crc_, bytes);
}

std::uint16_t McapWriter::AddSchema(const std::string& name, const std::string& schema) {
  const auto id = static_cast<std::uint16_t>(schemas_.size() + 1);  // 0 means none
  std::string content;
  AppendLittleEndian(id, &content);
  AppendText(name, &content);
  AppendText("jsonschema", &content);
  AppendText(schema, &content);
  schemas_.push_back(Record(Opcode::kSchema, content));
  Put(schemas_.back());
  return id;
}

std::uint16_t McapWriter::AddChannel(const std::string& topic, std::uint16_t schema) {
  const auto id = static_cast<std::uint16_t>(channels_.size());
  std::string content;
  AppendLittleEndian(id, &content);
  AppendLittleEndian(schema, &content);
  AppendText(topic, &content);
  AppendText("json", &content);
  AppendCounted("", &content);  // no metadata
  channels_.push_back(Record(Opcode::kChannel, content));
  message_counts_[id] = 0;
  Put(channels_.back());
  return id;
}

void McapWriter::AddMetadata(const std::string& name,
                             const std::map<std::string, std::string>& entries) {
  std::string map;
  for (const auto& [key, value] : entries) {
    AppendText(key, &map);
    AppendText(value, &map);
  }
  std::string content;
  AppendText(name, &content);
  AppendCounted(map, &content);
  const std::string record = Record(Opcode::kMetadata, content);
  metadata_.push_back({name, size_, record.size()});
  Put(record);
}

void McapWriter::Write(std::uint16_t channel, std::uint64_t time, std::string_view json) {
  if (chunk_.empty()) chunk_start_ = time;
  chunk_end_ = time;
  chunk_index_[channel].push_back({time, chunk_.size()});
  std::string content;
  AppendLittleEndian(channel, &content);
  AppendLittleEndian(static_cast<std::uint32_t>(message_counts_[channel]++), &content);
  AppendLittleEndian(time, &content);  // logged
  AppendLittleEndian(time, &content);  // published
  content += json;
  chunk_ += Record(Opcode::kMessage, content);
  if (chunk_.size() >= kChunkSize) WriteChunk();
}

void McapWriter::WriteChunk() {
  if (chunk_.empty()) return;
  const std::string packed = Compressed(chunk_);
  std::string content;
  AppendLittleEndian(chunk_start_, &content);
  AppendLittleEndian(chunk_end_, &content);
  AppendLittleEndian(static_cast<std::uint64_t>(chunk_.size()), &content);
  AppendLittleEndian(UpdatedCrc(0, chunk_), &content);
  AppendText("zstd", &content);
  AppendLittleEndian(static_cast<std::uint64_t>(packed.size()), &content);
  content += packed;
  const std::string record = Record(Opcode::kChunk, content);
  ChunkPlace place{chunk_start_, chunk_end_, size_,         record.size(),
                   {},           0,          packed.size(), chunk_.size()};
  Put(record);
  const std::uint64_t begin = size_;
  for (const auto& [channel, messages] : chunk_index_) {
    std::string entries;
    for (const MessagePlace& message : messages) {
      AppendLittleEndian(message.time, &entries);
      AppendLittleEndian(message.offset, &entries);
    }
    std::string index;
    AppendLittleEndian(channel, &index);
    AppendCounted(entries, &index);
    place.index_offsets[channel] = size_;
    Put(Record(Opcode::kMessageIndex, index));
  }
  place.index_length = size_ - begin;
  chunks_.push_back(place);
  chunk_.clear();
  chunk_index_.clear();
}

std::string McapWriter::Statistics() const {
  std::uint64_t messages = 0;
  std::string counts;
  for (const auto& [channel, count] : message_counts_) {
    messages += count;
    AppendLittleEndian(channel, &counts);
    AppendLittleEndian(count, &counts);
  }
  std::string content;
  AppendLittleEndian(messages, &content);
  AppendLittleEndian(static_cast<std::uint16_t>(schemas_.size()), &content);
  AppendLittleEndian(static_cast<std::uint32_t>(channels_.size()), &content);
  AppendLittleEndian(std::uint32_t{0}, &content);  // attachments
  AppendLittleEndian(static_cast<std::uint32_t>(metadata_.size()), &content);
  AppendLittleEndian(static_cast<std::uint32_t>(chunks_.size()), &content);
  AppendLittleEndian(chunks_.empty() ? 0 : chunks_.front().start_time, &content);
  AppendLittleEndian(chunks_.empty() ? 0 : chunks_.back().end_time, &content);
  AppendCounted(counts, &content);
  return Record(Opcode::kStatistics, content);
}

/// Groups of records of one kind, then where each group is.
std::string McapWriter::SummarySection() {
  std::string chunk_indexes;
  for (const ChunkPlace& chunk : chunks_) {
    std::string offsets;
    for (const auto& [channel, offset] : chunk.index_offsets) {
      AppendLittleEndian(channel, &offsets);
      AppendLittleEndian(offset, &offsets);
    }
    std::string content;
    for (const std::uint64_t field :
         {chunk.start_time, chunk.end_time, chunk.offset, chunk.length}) {
      AppendLittleEndian(field, &content);
    }
    AppendCounted(offsets, &content);
    AppendLittleEndian(chunk.index_length, &content);
    AppendText("zstd", &content);
    AppendLittleEndian(chunk.compressed, &content);
    AppendLittleEndian(chunk.uncompressed, &content);
    chunk_indexes += Record(Opcode::kChunkIndex, content);
  }
  std::string metadata_indexes;
  for (const MetadataPlace& metadata : metadata_) {
    std::string content;
    AppendLittleEndian(metadata.offset, &content);
    AppendLittleEndian(metadata.length, &content);
    AppendText(metadata.name, &content);
    metadata_indexes += Record(Opcode::kMetadataIndex, content);
  }
  const std::pair<Opcode, std::string> groups[] = {
      {Opcode::kSchema, fmt::format("{}", fmt::join(schemas_, ""))},
      {Opcode::kChannel, fmt::format("{}", fmt::join(channels_, ""))},
      {Opcode::kStatistics, Statistics()},
      {Opcode::kChunkIndex, chunk_indexes},
      {Opcode::kMetadataIndex, metadata_indexes}};
  std::string section;
  std::string offsets;
  for (const auto& [opcode, records] : groups) {
    if (records.empty()) continue;
    std::string content(1, static_cast<char>(opcode));
    AppendLittleEndian(size_ + section.size(), &content);
    AppendLittleEndian(static_cast<std::uint64_t>(records.size()), &content);
    offsets += Record(Opcode::kSummaryOffset, content);
    section += records;
  }
  summary_offset_ = size_ + section.size();
  return section + offsets;
}

void McapWriter::Commit() {
  WriteChunk();
  std::string data_crc;
  AppendLittleEndian(crc_, &data_crc);
  Put(Record(Opcode::kDataEnd, data_crc));
  const std::uint64_t begin = size_;
  std::string summary = SummarySection();
  constexpr std::uint64_t kFooterSize = 20;  // bytes of content
  summary += static_cast<char>(Opcode::kFooter);
  AppendLittleEndian(kFooterSize, &summary);
  AppendLittleEndian(begin, &summary);
  AppendLittleEndian(summary_offset_, &summary);
  AppendLittleEndian(UpdatedCrc(0, summary), &summary);
  Put(summary);
  Put(mcap::kMagic);
  file_.Commit();
}

}  // namespace possibility::experiments
