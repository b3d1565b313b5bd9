#include "experiments/support/option_values.h"

#include <gtest/gtest.h>

#include <limits>

#include "models/input/input_error.h"

namespace possibility::experiments {
namespace {

TEST(OptionValues, AcceptsIntegersWithinTheRangeOnly) {
  EXPECT_EQ(ParseInteger("--threads", "1", 1, 256), 1u);
  EXPECT_EQ(ParseInteger("--threads", "256", 1, 256), 256u);
  for (const char* text : {"0", "257", "-1", "1.5", "1e2", "0x10", " 1", "1 ", "", "many",
                           "99999999999999999999999"}) {
    EXPECT_THROW(ParseInteger("--threads", text, 1, 256), InputError) << text;
  }
}

TEST(OptionValues, AcceptsPositiveFiniteSecondsOnly) {
  EXPECT_EQ(ParseSeconds("--time-limit", "0.25"), 0.25);
  EXPECT_EQ(ParseSeconds("--time-limit", "1e3"), 1000);
  for (const char* text : {"0", "-1", "inf", "nan", "1e999", "1s", "", "ten"}) {
    EXPECT_THROW(ParseSeconds("--time-limit", text), InputError) << text;
  }
}

TEST(OptionValues, SplitsNamesAndRejectsEmptyAndRepeatedOnes) {
  EXPECT_EQ(ParseNames("--actions", "walk,crawl"), (std::vector<std::string>{"walk", "crawl"}));
  for (const char* text : {",walk", "walk,", "walk,,crawl", "walk,walk", ","}) {
    EXPECT_THROW(ParseNames("--actions", text), InputError) << text;
  }
}

TEST(OptionValues, ErrorsNameTheOptionAndTheValue) {
  try {
    ParseInteger("--threads", "none", 1, 256);
    FAIL() << "expected InputError";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "--threads: 'none' is not valid, expected an integer from 1 to 256");
  }
}

}  // namespace
}  // namespace possibility::experiments
