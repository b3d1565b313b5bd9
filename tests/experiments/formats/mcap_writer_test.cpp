#include "experiments/formats/mcap_writer.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/experiments/exports/mcap_reader.h"
#include "tests/experiments/read_text.h"

namespace possibility::experiments {
namespace {

using testing::McapFields;
using testing::McapMessage;
using testing::McapRecord;

class McapWriterTest : public ::testing::Test {
 protected:
  /// Two channels, enough messages for several chunks.
  void SetUp() override {
    McapWriter writer(file_, "test");
    writer.AddMetadata("plan", {{"robot", "hopper"}});
    const auto schema = writer.AddSchema("Number", "{\"type\":\"object\"}");
    const auto other = writer.AddSchema("Text", "{}");
    const std::uint16_t channels[] = {writer.AddChannel("/numbers", schema),
                                      writer.AddChannel("/texts", other)};
    for (int i = 0; i < kMessages; ++i) {
      const int channel = i % 10 == 0 ? 1 : 0;
      sent_.push_back(
          {channels[channel], static_cast<std::uint32_t>(count_[channel]++),
           static_cast<std::uint64_t>(i / 2 * 1000),
           fmt::format("{{\"i\":{},\"pad\":\"{}\"}}", i, std::string(500, 'a' + i % 26))});
      writer.Write(channels[channel], sent_.back().time, sent_.back().data);
    }
    writer.Commit();
    bytes_ = testing::ReadText(file_);
  }
  void TearDown() override { std::filesystem::remove(file_); }

  /// All records between the magic bytes.
  std::vector<McapRecord> AllRecords() const {
    return testing::McapRecords(bytes_, 8, bytes_.size() - 8);
  }
  std::vector<McapRecord> RecordsOf(int opcode) const {
    std::vector<McapRecord> records;
    for (const McapRecord& record : AllRecords()) {
      if (record.opcode == opcode) records.push_back(record);
    }
    return records;
  }

  static constexpr int kMessages = 6000;
  const std::filesystem::path file_ =
      std::filesystem::temp_directory_path() / fmt::format("writer_{}.mcap", ::getpid());
  int count_[2] = {0, 0};
  std::vector<McapMessage> sent_;
  std::string bytes_;
};

TEST_F(McapWriterTest, MessagesReadBackInOrder) {
  std::size_t next = 0;
  for (const McapRecord& chunk : RecordsOf(6)) {
    const std::string unpacked = testing::UnpackedChunk(chunk);
    for (const McapRecord& record : testing::McapRecords(unpacked, 0, unpacked.size())) {
      const McapMessage message = testing::ReadMessage(record);
      ASSERT_LT(next, sent_.size());
      EXPECT_EQ(message.channel, sent_[next].channel);
      EXPECT_EQ(message.sequence, sent_[next].sequence);
      EXPECT_EQ(message.time, sent_[next].time);
      EXPECT_EQ(message.data, sent_[next].data);
      ++next;
    }
  }
  EXPECT_EQ(next, sent_.size());
  EXPECT_GE(RecordsOf(6).size(), 3u);
}

TEST_F(McapWriterTest, BeginsAndEndsAsSpecified) {
  const std::string magic("\x89MCAP0\r\n", 8);
  EXPECT_EQ(bytes_.substr(0, 8), magic);
  EXPECT_EQ(bytes_.substr(bytes_.size() - 8), magic);
  const std::vector<McapRecord> records = AllRecords();
  EXPECT_EQ(records.front().opcode, 1);
  EXPECT_EQ(records.back().opcode, 2);
  McapFields header(records.front().content);
  EXPECT_EQ(header.Text(), "");
  EXPECT_EQ(header.Text(), "test");
}

TEST_F(McapWriterTest, CrcsCoverDataAndSummary) {
  const McapRecord data_end = RecordsOf(15).at(0);
  EXPECT_EQ(McapFields(data_end.content).Take<std::uint32_t>(),
            testing::SlowCrc(bytes_.substr(0, data_end.offset)));
  const McapRecord last = AllRecords().back();
  McapFields footer(last.content);
  const auto summary = footer.Take<std::uint64_t>();
  const auto offsets = footer.Take<std::uint64_t>();
  EXPECT_EQ(summary, data_end.offset + 9 + 4);
  EXPECT_EQ(bytes_[offsets], 14);
  // Up to the CRC itself: opcode, length and two fields of the footer.
  EXPECT_EQ(footer.Take<std::uint32_t>(),
            testing::SlowCrc(bytes_.substr(summary, last.offset + 9 + 16 - summary)));
}

TEST_F(McapWriterTest, ChunkIndexesLeadToEveryMessage) {
  std::size_t found = 0;
  for (const McapRecord& record : RecordsOf(8)) {
    McapFields index(record.content);
    const auto start = index.Take<std::uint64_t>();
    const auto end = index.Take<std::uint64_t>();
    const auto offset = index.Take<std::uint64_t>();
    const auto length = index.Take<std::uint64_t>();
    const auto chunk = testing::McapRecords(bytes_, offset, offset + length);
    ASSERT_EQ(chunk.size(), 1u);
    const std::string unpacked = testing::UnpackedChunk(chunk[0]);
    McapFields places(index.Text());
    const std::size_t after_chunk = offset + length;
    std::size_t index_end = after_chunk;
    while (!places.AtEnd()) {
      const int channel = places.Take<std::uint16_t>();
      const auto place = places.Take<std::uint64_t>();
      const McapRecord messages = testing::McapRecords(bytes_, place, bytes_.size() - 8).front();
      ASSERT_EQ(messages.opcode, 7);
      index_end = std::max(index_end, place + 9 + messages.content.size());
      McapFields fields(messages.content);
      EXPECT_EQ(fields.Take<std::uint16_t>(), channel);
      McapFields entries(fields.Text());
      while (!entries.AtEnd()) {
        const auto time = entries.Take<std::uint64_t>();
        const auto within = entries.Take<std::uint64_t>();
        EXPECT_GE(time, start);
        EXPECT_LE(time, end);
        const McapMessage message =
            testing::ReadMessage(testing::McapRecords(unpacked, within, unpacked.size()).front());
        EXPECT_EQ(message.channel, channel);
        EXPECT_EQ(message.time, time);
        ++found;
      }
    }
    EXPECT_EQ(index.Take<std::uint64_t>(), index_end - after_chunk);
    EXPECT_EQ(index.Text(), "zstd");
    index.Take<std::uint64_t>();
    EXPECT_EQ(index.Take<std::uint64_t>(), unpacked.size());
    EXPECT_TRUE(index.AtEnd());
  }
  EXPECT_EQ(found, sent_.size());
}

TEST_F(McapWriterTest, TheSummaryRepeatsSchemasAndChannelsAndCounts) {
  EXPECT_EQ(RecordsOf(3).size(), 4u) << "two schemas, and again";
  EXPECT_EQ(RecordsOf(4).size(), 4u);
  McapFields statistics(RecordsOf(11).at(0).content);
  EXPECT_EQ(statistics.Take<std::uint64_t>(), sent_.size());
  EXPECT_EQ(statistics.Take<std::uint16_t>(), 2);
  EXPECT_EQ(statistics.Take<std::uint32_t>(), 2u);
  EXPECT_EQ(statistics.Take<std::uint32_t>(), 0u);
  EXPECT_EQ(statistics.Take<std::uint32_t>(), 1u);
  EXPECT_EQ(statistics.Take<std::uint32_t>(), RecordsOf(6).size());
  EXPECT_EQ(statistics.Take<std::uint64_t>(), 0u);
  EXPECT_EQ(statistics.Take<std::uint64_t>(), sent_.back().time);
  McapFields counts(statistics.Text());
  for (int channel = 0; channel < 2; ++channel) {
    EXPECT_EQ(counts.Take<std::uint16_t>(), channel);
    EXPECT_EQ(counts.Take<std::uint64_t>(), static_cast<std::uint64_t>(count_[channel]));
  }
  for (const McapRecord& record : RecordsOf(14)) {
    McapFields offset(record.content);
    const int opcode = offset.Take<std::uint8_t>();
    const auto start = offset.Take<std::uint64_t>();
    const auto length = offset.Take<std::uint64_t>();
    for (const McapRecord& member : testing::McapRecords(bytes_, start, start + length)) {
      EXPECT_EQ(member.opcode, opcode);
    }
  }
  EXPECT_EQ(RecordsOf(14).size(), 5u);
}

TEST_F(McapWriterTest, MetadataAreIndexed) {
  McapFields index(RecordsOf(13).at(0).content);
  const auto offset = index.Take<std::uint64_t>();
  const auto length = index.Take<std::uint64_t>();
  EXPECT_EQ(index.Text(), "plan");
  const auto metadata = testing::McapRecords(bytes_, offset, offset + length);
  ASSERT_EQ(metadata.size(), 1u);
  EXPECT_EQ(metadata[0].opcode, 12);
  McapFields fields(metadata[0].content);
  EXPECT_EQ(fields.Text(), "plan");
  McapFields entries(fields.Text());
  EXPECT_EQ(entries.Text(), "robot");
  EXPECT_EQ(entries.Text(), "hopper");
}

}  // namespace
}  // namespace possibility::experiments
