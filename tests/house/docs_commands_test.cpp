// The documents' commands are run in the order in which a reader types them, in a folder that looks
// to them like the project's.
#include "tests/house/docs_commands.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>

#include "tests/house/docs_commands_table.h"

namespace possibility::house {
namespace {

namespace fs = std::filesystem;

const fs::path kRoot = POSSIBILITY_SOURCE_DIR;

std::vector<std::string> Documents() {
  std::vector<std::string> documents = {"CONTRIBUTING.md", "README.md"};
  for (const auto& entry : fs::directory_iterator(kRoot / "docs")) {
    if (entry.path().extension() == ".md") {
      documents.push_back("docs/" + entry.path().filename().string());
    }
  }
  std::sort(documents.begin(), documents.end());
  return documents;
}

const CommandRule* RuleOf(const DocsCommand& command) {
  for (const CommandRule& rule : CommandRules()) {
    if (rule.document == command.document && command.text.starts_with(rule.begins)) return &rule;
  }
  return nullptr;
}

bool IsQuick(const DocsCommand& command) { return RuleOf(command) == nullptr; }

bool IsLong(const DocsCommand& command) {
  const CommandRule* rule = RuleOf(command);
  return rule != nullptr && rule->kind == CommandKind::kLong;
}

std::vector<std::string> DocumentsWith(bool (*wanted)(const DocsCommand&)) {
  std::vector<std::string> documents;
  for (const std::string& document : Documents()) {
    const std::vector<DocsCommand> commands = CommandsOf(kRoot, document);
    if (std::any_of(commands.begin(), commands.end(), wanted)) documents.push_back(document);
  }
  return documents;
}

std::string ReadText(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

/// A folder with the project's inputs, the script `run`, and the program that has been built.
class DocsCommands : public ::testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "cmake");
    fs::create_directories(folder_ / "build/release/experiments/examples");
    fs::create_directories(folder_ / "experiments");
    for (const char* input :
         {"models", "experiments/scenarios", "experiments/sweeps", "experiments/examples"}) {
      fs::copy(kRoot / input, folder_ / input, fs::copy_options::recursive);
    }
    fs::copy(kRoot / "run", folder_ / "run");
    std::ofstream(folder_ / "cmake/build_release.sh") << "# It has been built.\n";
    fs::create_symlink(POSSIBILITY_PROGRAM, folder_ / "build/release/experiments/possibility");
    fs::create_symlink(POSSIBILITY_STEP_UP,
                       folder_ / "build/release/experiments/examples/plan_step_up");
  }
  void TearDown() override { fs::remove_all(folder_); }

  void ExpectWorks(const DocsCommand& command) const {
    const std::string place =
        fmt::format("{}:{}: {}\n", command.document, command.line, command.text);
    const std::string call = fmt::format(
        "cd '{}' && unset SLURM_ARRAY_TASK_ID SLURM_ARRAY_TASK_COUNT && "
        "PATH=\"$PWD/build/release/experiments:$PATH\" && {{ {}\n}} >stdout.txt 2>stderr.txt",
        folder_.string(), command.text);
    const int status = std::system(call.c_str());
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0)
        << place << ReadText(folder_ / "stdout.txt") << ReadText(folder_ / "stderr.txt");
    if (!command.output) return;
    EXPECT_EQ(OutputDifference(*command.output, ReadText(folder_ / "stdout.txt"), MeasuredNames()),
              "")
        << place << "- the document shows, + the program prints";
  }

  void ExpectAllWork(const std::string& document, bool with_long) const {
    for (const DocsCommand& command : CommandsOf(kRoot, document)) {
      if (IsQuick(command) || (with_long && IsLong(command))) ExpectWorks(command);
    }
  }

  const fs::path folder_ =
      fs::temp_directory_path() / fmt::format("possibility_docs_{}", ::getpid());
};

using DocsCommandsLong = DocsCommands;

TEST_P(DocsCommands, DoWhatTheDocumentSays) { ExpectAllWork(GetParam(), false); }

TEST_P(DocsCommandsLong, DoWhatTheDocumentSays) { ExpectAllWork(GetParam(), true); }

std::string NameOf(const ::testing::TestParamInfo<std::string>& info) {
  return fs::path(info.param).stem().string();
}

INSTANTIATE_TEST_SUITE_P(Documents, DocsCommands, ::testing::ValuesIn(DocumentsWith(IsQuick)),
                         NameOf);
INSTANTIATE_TEST_SUITE_P(Documents, DocsCommandsLong, ::testing::ValuesIn(DocumentsWith(IsLong)),
                         NameOf);

TEST(DocsCommandsTable, EveryCommandStandsInABlockThatIsRun) {
  int commands = 0;
  for (const std::string& document : Documents()) {
    commands += static_cast<int>(CommandsOf(kRoot, document).size());
    EXPECT_EQ(CommandsOutsideBlocks(kRoot, document), std::vector<std::string>());
  }
  EXPECT_GT(commands, 30);
}

TEST(DocsCommandsTable, EveryRuleHasACommand) {
  std::set<const CommandRule*> used;
  for (const std::string& document : Documents()) {
    for (const DocsCommand& command : CommandsOf(kRoot, document)) used.insert(RuleOf(command));
  }
  for (const CommandRule& rule : CommandRules()) {
    EXPECT_TRUE(used.contains(&rule)) << rule.document << ": " << rule.begins;
  }
}

TEST(DocsCommandsTable, OutputIsComparedButForMeasuredNumbers) {
  const std::vector<std::string> measured = {"graph"};
  const std::vector<std::string> shown = {"length 3.10 m", "graph    0.02 s", "end"};
  EXPECT_EQ(OutputDifference(shown, "length 3.10 m\ngraph   12.30 s\nend\n", measured), "");
  EXPECT_EQ(OutputDifference({"length 3.10 m", "..."}, "length 3.10 m\na\nb\n", measured), "");
  EXPECT_EQ(OutputDifference({"...", "end"}, "a\nend\n", measured), "");
  EXPECT_EQ(OutputDifference(shown, "length 3.20 m\ngraph 1 s\nend\n", measured),
            "- length 3.10 m\n+ length 3.20 m\n  graph    0.02 s\n  end\n");
  EXPECT_EQ(OutputDifference(shown, "length 3.10 m\nend\n", measured),
            "  length 3.10 m\n- graph    0.02 s\n  end\n");
  EXPECT_EQ(OutputDifference({"a"}, "a\nb\n", measured), "  a\n+ b\n");
}

}  // namespace
}  // namespace possibility::house
