#include "models/input/file_contents.h"

#include <gtest/gtest.h>

#include "models/input/input_error.h"
#include "tests/models/temporary_folder.h"

namespace possibility::models {
namespace {

TEST(ContentHash, IsTheCanonicalXxh3) {
  // The value that xxHash's specification gives for empty input.
  EXPECT_EQ(ContentHash(""), "99aa06d3014798d86001c324468d497f");
  EXPECT_NE(ContentHash("abc"), ContentHash("abd"));
}

TEST(HashOfParts, IsTheHashOfNumberLengthsAndBytes) {
  const std::string two("\2\0\0\0\0\0\0\0", 8);
  const std::string one("\1\0\0\0\0\0\0\0", 8);
  EXPECT_EQ(HashOfParts({"ab", "c"}), ContentHash(two + two + "ab" + one + "c"));
}

TEST(HashOfParts, DependsOnWhereAPartEnds) {
  EXPECT_NE(HashOfParts({"ab", "c"}), HashOfParts({"a", "bc"}));
  EXPECT_NE(HashOfParts({"ab", "c"}), HashOfParts({"abc"}));
  EXPECT_NE(HashOfParts({"abc", ""}), HashOfParts({"", "abc"}));
  EXPECT_NE(HashOfParts({"abc", ""}), HashOfParts({"abc"}));
}

TEST(ReadFileContents, ReturnsEveryByte) {
  const TemporaryFolder folder;
  const std::string bytes("a\0b\r\n\xff", 6);
  EXPECT_EQ(ReadFileContents(folder.Write("bytes", bytes)), bytes);
  EXPECT_EQ(ReadFileContents(folder.Write("empty", "")), "");
}

TEST(ReadFileContents, RefusesAFolderAndAMissingFile) {
  const TemporaryFolder folder;
  EXPECT_THROW(ReadFileContents(folder.path()), InputError);
  EXPECT_THROW(ReadFileContents(folder.path() / "missing"), InputError);
  EXPECT_THROW(ReadFileContents(folder.path() / std::string(5000, 'a')), InputError);
}

}  // namespace
}  // namespace possibility::models
