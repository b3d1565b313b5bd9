#include "experiments/support/base64.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

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

TEST(Base64, TurnsBack) {
  std::string bytes;
  for (int i = 0; i < 300; ++i) {
    EXPECT_EQ(FromBase64(Base64(bytes)), bytes) << i;
    bytes += static_cast<char>(i * 37);
  }
}

TEST(Base64, RefusesWhatIsNone) {
  for (const char* text : {"Zg", "Zg=", "Z===", "Zg==Zg==", "Z g=", "Zm9\xff"}) {
    EXPECT_THROW(FromBase64(text), std::invalid_argument) << text;
  }
}

}  // namespace
}  // namespace possibility::experiments
