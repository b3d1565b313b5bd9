#include "models/archive/zip_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include "models/input/file_contents.h"
#include "models/input/input_error.h"

namespace possibility::models {
namespace {

class ZipFile : public ::testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(file_); }

  std::string Written(Deflation deflation = Deflation::kFast) const {
    ZipWriter archive(file_, deflation);
    for (const auto& [name, content] : members_) archive.Add(name, content);
    archive.Commit();
    return ReadFileContents(file_);
  }

  const std::filesystem::path file_ =
      std::filesystem::temp_directory_path() / ("zip_" + std::to_string(::getpid()) + ".zip");
  const std::map<std::string, std::string> members_ = {
      {"empty", ""}, {"long.txt", std::string(100000, 'x')}, {"short", std::string("a\0b", 3)}};
};

TEST_F(ZipFile, ReadsBackWhatItWrites) {
  const std::string bytes = Written();
  EXPECT_EQ(ReadZip(bytes, file_), members_);
  EXPECT_LT(bytes.size(), 2000u) << "is deflated";
  EXPECT_EQ(Written(), bytes);
}

TEST_F(ZipFile, RefusesASpoiltArchive) {
  const std::string bytes = Written();
  for (std::size_t length = 0; length < bytes.size(); length += 7) {
    EXPECT_THROW(ReadZip(bytes.substr(0, length), file_), InputError) << length;
  }
  std::string spoilt = bytes;
  spoilt[bytes.find("short") + 5] ^= 0x10;  // of the packed bytes
  EXPECT_THROW(ReadZip(spoilt, file_), InputError);
  EXPECT_THROW(ReadZip("no archive at all", file_), InputError);
}

TEST_F(ZipFile, ReadsOneMemberAtATime) {
  const std::string bytes = Written(Deflation::kThorough);
  const ZipReader reader(bytes, file_);
  EXPECT_TRUE(IsZip(bytes));
  EXPECT_EQ(reader.Names(), (std::vector<std::string>{"empty", "long.txt", "short"}));
  EXPECT_EQ(reader.SizeOf("long.txt"), 100000u);
  EXPECT_EQ(reader.Read("short"), members_.at("short"));
  EXPECT_FALSE(reader.Has("tall"));
  EXPECT_THROW(reader.Read("tall"), InputError);
  EXPECT_FALSE(IsZip("PK"));
}

TEST_F(ZipFile, AWrongCrcIsNamed) {
  std::string bytes = Written();
  const std::size_t entry = bytes.rfind("PK\x01\x02");  // of "short"
  bytes[entry + 16] ^= 1;
  try {
    ReadZip(bytes, file_);
    FAIL() << "the CRC was not checked";
  } catch (const InputError& error) {
    EXPECT_EQ(error.what(), file_.string() + ": wrong CRC of short, expected a ZIP archive");
  }
}

}  // namespace
}  // namespace possibility::models
