#include "experiments/support/base64.h"

#include <gtest/gtest.h>

namespace possibility::experiments {
namespace {

TEST(Base64, GivesTheTestVectorsOfRfc4648) {
  EXPECT_EQ(Base64(""), "");
  EXPECT_EQ(Base64("f"), "Zg==");
  EXPECT_EQ(Base64("fo"), "Zm8=");
  EXPECT_EQ(Base64("foo"), "Zm9v");
  EXPECT_EQ(Base64("foob"), "Zm9vYg==");
  EXPECT_EQ(Base64("fooba"), "Zm9vYmE=");
  EXPECT_EQ(Base64("foobar"), "Zm9vYmFy");
}

TEST(Base64, TakesBytesAbove127) { EXPECT_EQ(Base64("\xff\xfe\xfd\xfb"), "//79+w=="); }

}  // namespace
}  // namespace possibility::experiments
