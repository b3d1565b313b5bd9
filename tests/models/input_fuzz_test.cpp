// Whatever bytes a robot or scenario file holds: it loads, or InputError says in one line why not.

#include <gtest/gtest.h>

#include <random>

#include "models/file_contents.h"
#include "models/input_error.h"
#include "models/scenario.h"
#include "tests/models/temporary_folder.h"
#include "tests/models/two_legged_robot.h"

namespace possibility::models {
namespace {

class Mutator {
 public:
  explicit Mutator(unsigned seed) : random_(seed) {}

  std::string operator()(std::string text) {
    for (int i = Below(2); i >= 0; --i) MutateOnce(&text);
    return text;
  }

 private:
  int Below(std::size_t n) {
    return std::uniform_int_distribution<int>(0,
                                              std::max<int>(static_cast<int>(n) - 1, 0))(random_);
  }

  // A stretch of the text that starts and ends where words do.
  std::pair<std::size_t, std::size_t> Words(const std::string& text, int longest) {
    const std::string edges = " \n,:<>\"[]{}/=";
    const std::size_t from = text.find_first_of(edges, Below(text.size()));
    if (from == std::string::npos) return {0, 0};
    const std::size_t to = text.find_first_of(edges, from + 1 + Below(longest));
    return {from, (to == std::string::npos ? text.size() : to) - from};
  }

  void MutateOnce(std::string* text) {
    static const std::vector<std::string> kTokens = {"nan",
                                                     "inf",
                                                     "-1",
                                                     "0",
                                                     "1e308",
                                                     "-0",
                                                     "1e-320",
                                                     "~",
                                                     "[]",
                                                     "{}",
                                                     "\"",
                                                     "'",
                                                     ": ",
                                                     "- ",
                                                     "&a ",
                                                     "*a",
                                                     "!!binary ",
                                                     "---\n",
                                                     "%YAML",
                                                     "<",
                                                     "/>",
                                                     "</link>",
                                                     "<!--",
                                                     "]]>",
                                                     "&lt;",
                                                     "&#0;",
                                                     "\t",
                                                     "\r",
                                                     std::string(1, '\0'),
                                                     "\xff",
                                                     "\xef\xbb\xbf",
                                                     "9999999999999999999"};
    if (text->empty()) return;
    switch (Below(6)) {
      case 0:  // one byte
        (*text)[Below(text->size())] = static_cast<char>(Below(256));
        return;
      case 1:
        text->insert(Below(text->size()), kTokens[Below(kTokens.size())]);
        return;
      case 2: {
        const auto [from, length] = Words(*text, 20);
        text->replace(from, length, text->substr(from, 1) + kTokens[Below(kTokens.size())]);
        return;
      }
      case 3: {
        const auto [from, length] = Words(*text, 60);
        text->erase(from, length);
        return;
      }
      case 4: {
        const auto [from, length] = Words(*text, 200);
        text->insert(Below(text->size()), text->substr(from, length));
        return;
      }
      default:
        text->resize(Below(text->size()));
    }
  }

  std::mt19937 random_;
};

constexpr int kMutations = 1200;

struct Outcome {
  int loaded = 0;
  int refused = 0;
};

// Anything but InputError escapes and fails the test.
template <typename Load>
void Try(Load load, Outcome* outcome) {
  try {
    load();
    ++outcome->loaded;
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_FALSE(message.empty());
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    ++outcome->refused;
  }
}

TEST(InputFuzz, RobotYaml) {
  const TemporaryFolder folder;
  folder.Write("robot.urdf", TwoLeggedUrdf());
  Mutator mutate(1);
  Outcome outcome;
  for (int i = 0; i < kMutations; ++i) {
    const auto file = folder.Write("robot.yaml", mutate(TwoLeggedYaml()));
    Try([&] { LoadRobotModel(file); }, &outcome);
  }
  EXPECT_GT(outcome.loaded, 0);
  EXPECT_GT(outcome.refused, kMutations / 2);
}

TEST(InputFuzz, Urdf) {
  const TemporaryFolder folder;
  const auto file = folder.Write("robot.yaml", TwoLeggedYaml());
  Mutator mutate(2);
  Outcome outcome;
  for (int i = 0; i < kMutations; ++i) {
    folder.Write("robot.urdf", mutate(TwoLeggedUrdf()));
    Try([&] { LoadRobotModel(file); }, &outcome);
  }
  EXPECT_GT(outcome.loaded, 0);
  EXPECT_GT(outcome.refused, kMutations / 2);
}

TEST(InputFuzz, Scenario) {
  const TemporaryFolder folder;
  const std::string scenario = ReadFileContents(std::string(POSSIBILITY_SOURCE_DIR) +
                                                "/experiments/scenarios/three_routes_b.yaml");
  Mutator mutate(3);
  Outcome outcome;
  for (int i = 0; i < kMutations; ++i) {
    const auto file = folder.Write("scenario.yaml", mutate(scenario));
    Try([&] { LoadScenario(file); }, &outcome);
  }
  EXPECT_GT(outcome.loaded, 0);
  EXPECT_GT(outcome.refused, kMutations / 2);
}

}  // namespace
}  // namespace possibility::models
