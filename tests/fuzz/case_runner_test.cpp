// The fuzzer finds the failures that it is meant to find.

#include "tests/fuzz/case_runner.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <functional>
#include <new>
#include <set>
#include <stdexcept>

#include "models/input/input_error.h"

namespace possibility::fuzz {
namespace {

Subject With(const std::function<void(std::uint64_t)>& use) {
  Subject subject;
  subject.name = "sample";
  subject.extension = ".json";
  subject.syntax = Syntax::kJson;
  // As long as a real file. A text of a few bytes has only a few mutations.
  subject.text = [](std::uint64_t) {
    std::string text = "{\"b\": [0.5";
    for (int i = 0; i < 200; ++i) text += ", {\"a\": " + std::to_string(i) + "}";
    return text + "]}";
  };
  subject.use = [use](std::uint64_t seed, const std::string&) { use(seed); };
  subject.limit_s = 0.1;
  return subject;
}

TEST(CaseRunner, NamesEachKindOfFailureAndContinues) {
  const Findings findings = FindFailures(With([](std::uint64_t seed) {
                                           if (seed == 3) std::abort();
                                           if (seed == 5) throw std::runtime_error("oh");
                                           if (seed == 7) throw InputError("two\nlines");
                                           if (seed == 9) {
                                             for (std::atomic<int> turns = 0;;) ++turns;
                                           }
                                           if (seed == 11) std::_Exit(4);
                                           if (seed % 2 == 0) throw InputError("refused");
                                         }),
                                         0, 20);
  const std::string expected[] = {"signal 6", "another exception: oh", "a message that is not one",
                                  "too much processor time", "exit code 4"};
  ASSERT_EQ(findings.failures.size(), 5u);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(findings.failures[i].seed, 3 + 2 * i);
    EXPECT_TRUE(findings.failures[i].what.starts_with(expected[i])) << findings.failures[i].what;
  }
  EXPECT_EQ(findings.used, 5);
  EXPECT_EQ(findings.refused, 10);
}

TEST(CaseRunner, OneSeedGivesOneTextAndSeedsDiffer) {
  const Subject subject = With([](std::uint64_t) {});
  std::set<std::string> texts;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    EXPECT_EQ(SpoiltText(subject, seed), SpoiltText(subject, seed));
    texts.insert(SpoiltText(subject, seed));
  }
  EXPECT_GT(texts.size(), 150u);
}

}  // namespace
}  // namespace possibility::fuzz
