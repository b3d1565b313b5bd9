#include "experiments/imports/csv_records.h"

#include <gtest/gtest.h>

#include "models/input/input_error.h"

namespace possibility::experiments {
namespace {

using Fields = std::vector<std::string>;

std::vector<Fields> AllRecords(const std::string& text) {
  CsvRecords records(text, "table.csv");
  std::vector<Fields> all;
  for (Fields fields; records.Next(&fields);) all.push_back(fields);
  return all;
}

TEST(CsvRecordsTest, ReadsPlainAndQuotedFields) {
  EXPECT_EQ(AllRecords("a,b\n1,\n"), std::vector<Fields>({{"a", "b"}, {"1", ""}}));
  EXPECT_EQ(AllRecords("\"a,\"\"b\"\"\",\"two\nlines\"\r\nx,y"),
            std::vector<Fields>({{"a,\"b\"", "two\nlines"}, {"x", "y"}}));
  EXPECT_EQ(AllRecords("\xef\xbb\xbf"
                       "a\n\n\r\nb\n"),
            std::vector<Fields>({{"a"}, {"b"}}));
  EXPECT_TRUE(AllRecords("").empty());
}

TEST(CsvRecordsTest, RefusesStrayQuotesAndNamesTheLine) {
  for (const std::string text : {"a\nb\n\"c", "a\nb\nc\"d\"", "a\nb\n\"c\"d"}) {
    try {
      AllRecords(text);
      ADD_FAILURE() << text;
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find("table.csv:3: "), 0u) << error.what();
    }
  }
}

TEST(CsvRecordsTest, NumbersAreFinite) {
  EXPECT_EQ(CsvNumber(" -1.5e-3 ", "x"), -1.5e-3);
  for (const char* text : {"", "nan", "inf", "1e999", "1,5", "1 2", "0x10"}) {
    EXPECT_THROW(CsvNumber(text, "x"), InputError) << text;
  }
}

}  // namespace
}  // namespace possibility::experiments
