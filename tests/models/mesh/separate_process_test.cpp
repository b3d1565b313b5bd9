#include "models/mesh/separate_process.h"

#include <gtest/gtest.h>

#include <atomic>
#include <csignal>
#include <stdexcept>

namespace possibility::models {
namespace {

TEST(SeparateProcess, ReturnsWhatTheWorkReturns) {
  std::string long_text(3000000, 'x');
  long_text += '\0';
  EXPECT_EQ(InSeparateProcess([&] { return long_text; }, 5), long_text);
  EXPECT_EQ(InSeparateProcess([] { return std::string(); }, 5), "");
}

TEST(SeparateProcess, SurvivesCrashesEndlessLoopsAndExceptions) {
  int changed = 0;
  EXPECT_FALSE(InSeparateProcess(
      [&]() -> std::string {
        changed = 1;
        std::raise(SIGABRT);
        return "done";
      },
      5));
  EXPECT_EQ(changed, 0);
  EXPECT_FALSE(InSeparateProcess([]() -> std::string { throw std::runtime_error("no"); }, 5));
  EXPECT_FALSE(InSeparateProcess(
      []() -> std::string {
        for (std::atomic<int> i = 0;; ++i) {
        }
      },
      1));
}

}  // namespace
}  // namespace possibility::models
