#include "experiments/recording/headless_browser.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "models/input/input_error.h"
#include "tests/experiments/recording/png_size.h"

namespace possibility::experiments {
namespace {

class HeadlessBrowserTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!FindProgram({"chromium", "chromium-browser", "google-chrome"})) {
      GTEST_SKIP() << "chromium is not installed";
    }
  }
};

TEST_F(HeadlessBrowserTest, EvaluatesInThePageThatItOpened) {
  HeadlessBrowser browser({320, 240});
  browser.Open(
      "<meta charset=utf-8><script>const shown = {n: 7, words: ['one', 'zwölf']};</script>",
      "#t=5");
  EXPECT_EQ(browser.Evaluate("shown.n * 6"), 42);
  EXPECT_EQ(browser.Evaluate("shown.words")[1], "zwölf");
  EXPECT_EQ(browser.Evaluate("location.hash"), "#t=5");
  EXPECT_EQ(browser.Evaluate("new Promise((done) => setTimeout(() => done('late'), 20))"), "late");
  try {
    browser.Evaluate("missing.name");
    FAIL() << "expected an exception";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("missing is not defined"), std::string::npos);
  }
}

TEST_F(HeadlessBrowserTest, APictureShowsThePageInItsSize) {
  HeadlessBrowser browser({322, 244});
  browser.Open("<body style='background: red'>", "");
  const std::string red = browser.Picture();
  EXPECT_EQ(testing::PngSize(red), std::pair(322, 244));
  EXPECT_EQ(browser.Picture(), red);
  browser.Evaluate("document.body.style.background = 'blue'");
  EXPECT_NE(browser.Picture(), red);
}

TEST(ChildProcessTest, AProgramThatEndsEarlyIsNamed) {
  ChildProcess process("/bin/true", {}, {0, 1});
  try {
    process.Read(10);
    FAIL() << "expected an exception";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "true: ended before its work was done");
  }
}

TEST(ChildProcessTest, GivesBackWhatCatHears) {
  ChildProcess process("/bin/cat", {}, {0, 1});
  process.Write("a line");
  std::string heard;
  while (heard.size() < 6) heard += process.Read(10);
  EXPECT_EQ(heard, "a line");
  EXPECT_EQ(process.Finish(), 0);
}

TEST(ChildProcessTest, SaysThatNothingWasHeard) {
  ChildProcess process("/bin/cat", {}, {0, 1});
  EXPECT_THROW(process.Read(0.05), InputError);
}

TEST(FindProgramTest, LooksInTheFoldersOfPath) {
  EXPECT_TRUE(FindProgram({"no such program", "sh"}));
  EXPECT_FALSE(FindProgram({"no such program"}));
}

}  // namespace
}  // namespace possibility::experiments
