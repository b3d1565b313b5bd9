#include "experiments/viewer/viewer_input.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "models/input/input_error.h"

namespace possibility::experiments {
namespace {

namespace fs = std::filesystem;

class FormatOfTest : public ::testing::Test {
 protected:
  void TearDown() override { fs::remove(file_); }

  std::string Of(const std::string& text) const {
    std::ofstream(file_, std::ios::binary) << text;
    return FormatOf(file_);
  }

  const fs::path file_ =
      fs::temp_directory_path() / ("possibility_format_" + std::to_string(::getpid()) + ".json");
};

TEST_F(FormatOfTest, IsThatOfTheOutermostObject) {
  EXPECT_EQ(Of(R"({"format": "a/1"})"), "a/1");
  EXPECT_EQ(Of(R"({"x": {"format": "inner"}, "y": [{"format": "inner"}], "format": "outer"})"),
            "outer");
  EXPECT_EQ(Of(R"({"x": [[], {}], "format": "a/1"})"), "a/1");
}

TEST_F(FormatOfTest, IsFoundInATruncatedFile) {
  EXPECT_EQ(Of(R"({"format": "a/1", "x": [1, 2)"), "a/1");
}

TEST_F(FormatOfTest, IsEmptyWithoutAFormat) {
  for (const char* text :
       {"", "no JSON", "[]", "{}", "1", R"(["format", "a"])", R"([{"format": "a"}])",
        R"({"format": 1})", R"({"format": null, "x": "a"})", R"({"format": ["a"]})",
        R"({"format": {"format": "a"}})", R"({"formats": "a"})", R"({"x": "format"})",
        R"({"x": {"format": "inner"}})", R"({"format")"}) {
    EXPECT_EQ(Of(text), "") << text;
  }
}

TEST_F(FormatOfTest, RefusesAMissingFile) {
  EXPECT_THROW(FormatOf(file_.string() + ".none"), InputError);
  EXPECT_THROW(FormatOf(fs::temp_directory_path()), InputError);
}

}  // namespace
}  // namespace possibility::experiments
