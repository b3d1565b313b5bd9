#include "experiments/support/file_name.h"

#include <gtest/gtest.h>

namespace possibility::experiments {
namespace {

TEST(SafeFileNameTest, KeepsLettersDigitsAndDashesOnly) {
  EXPECT_EQ(SafeFileName("left_hip-2"), "left_hip-2");
  EXPECT_EQ(SafeFileName("../a b/\xc3\xa9%"), "___a_b____");
  EXPECT_EQ(SafeFileName(""), "");
}

}  // namespace
}  // namespace possibility::experiments
