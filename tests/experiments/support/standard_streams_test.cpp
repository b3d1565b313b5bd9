// Every command reports that its output cannot be written, and none is killed by that.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <regex>
#include <string>
#include <thread>

#include "tests/experiments/program_run.h"
#include "tests/experiments/read_text.h"
#include "tests/experiments/standing_plan.h"

namespace possibility::experiments {
namespace {

namespace fs = std::filesystem;
using testing::ProgramRun;
using testing::ReadText;

const std::string kRepository = POSSIBILITY_SOURCE_DIR;

class StandardStreams : public ProgramRun {
 protected:
  /// Runs with standard output set by `stream`. Expects exit code 1 and one line on standard error.
  void ExpectUnwritable(const std::string& arguments, const std::string& stream) const {
    const int code = Wait(Start(arguments, "", stream + " 2>stderr.txt"));
    const std::string errors = Errors();
    EXPECT_EQ(code, 1) << arguments << stream << "\n" << errors;
    EXPECT_EQ(std::count(errors.begin(), errors.end(), '\n'), 1) << arguments << "\n" << errors;
    EXPECT_TRUE(errors.starts_with("standard output: cannot be written")) << errors;
  }
  void WriteStandingPlan() const {
    testing::WriteStandingPlan(kRepository + "/experiments/scenarios/three_routes_b.yaml",
                               folder_ / "plan.json");
  }
  std::ptrdiff_t FilesIn(const std::string& folder) const {
    return std::distance(fs::directory_iterator(folder_ / folder), fs::directory_iterator());
  }
};

TEST_F(StandardStreams, EveryCommandReportsAFullDisk) {
  WriteStandingPlan();
  const std::string room = "'" + kRepository + "/experiments/scenarios/closed_room.yaml'";
  const std::string commands[] = {
      "--help",
      "plan --help",
      "plan " + room + " --out out",
      "plan " + room + " --out out --json",
      "verify plan.json",
      "verify plan.json --json",
      "view plan.json",
      "export plan.json --csv tables",
      "regress --problem kirk",
      "regress --problem kirk --json",
  };
  for (const std::string& command : commands) ExpectUnwritable(command, ">/dev/full");
}

// The remaining commands take minutes. They write through the same functions.
TEST_F(StandardStreams, SourcesWriteThroughThemOnly) {
  const std::regex other(R"(fmt::print\(|std::cout|std::cerr|\bprintf\(|std::puts\()");
  int sources = 0;
  for (const char* floor :
       {"models", "dynamics", "collocation", "graph", "actions", "experiments"}) {
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(kRepository) / floor)) {
      const std::string extension = entry.path().extension().string();
      if (extension != ".cpp" && extension != ".h") continue;
      // The tutorial's program is one of its own.
      if (entry.path().parent_path().filename() == "examples") continue;
      ++sources;
      EXPECT_FALSE(std::regex_search(ReadText(entry.path()), other)) << entry.path();
    }
  }
  EXPECT_GT(sources, 100);
}

TEST_F(StandardStreams, AClosedStreamIsReportedLikeAFullDisk) {
  WriteStandingPlan();
  ExpectUnwritable("export plan.json --csv tables", ">&-");
  ExpectUnwritable("verify plan.json --json", ">&-");
  // The program starts after the reader has closed the pipe.
  Wait(Start("export plan.json --csv tables", "{ until [ -e closed ]; do sleep 0.01; done; (",
             "2>stderr.txt); echo $? >code.txt; } | { exec <&-; touch closed; }"));
  EXPECT_EQ(ReadText(folder_ / "code.txt"), "1\n");
  EXPECT_TRUE(Errors().starts_with("standard output: cannot be written")) << Errors();
}

TEST_F(StandardStreams, OutputToClosedStreamsGoesIntoNoOpenedFile) {
  WriteStandingPlan();
  EXPECT_EQ(Wait(Start("export plan.json --csv tables", "", ">&- 2>&-")), 1);
  const std::string table = ReadText(folder_ / "tables/trajectory.csv");
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 1 + 3);
  EXPECT_TRUE(table.starts_with("t,segment")) << table;
  EXPECT_EQ(table.find("tables/"), std::string::npos);
}

TEST_F(StandardStreams, AnErrorThatCannotBePrintedKeepsItsExitCode) {
  EXPECT_EQ(Wait(Start("plan missing.yaml", "", ">/dev/full 2>/dev/full")), 1);
  EXPECT_EQ(Wait(Start("plan missing.yaml --json", "", ">/dev/full 2>/dev/full")), 1);
  EXPECT_EQ(Wait(Start("verify missing", "", ">&- 2>&-")), 1);
}

TEST_F(StandardStreams, AFileThatCannotBeWrittenIsRemoved) {
  WriteStandingPlan();
  // The limit is in blocks of 512 bytes, so there is room for a few rows only.
  const int code = Wait(Start("export plan.json --csv tables --step 1e-4", "ulimit -f 1000;",
                              ">stdout.txt 2>stderr.txt"));
  EXPECT_EQ(code, 1);
  const std::string errors = Errors();
  EXPECT_EQ(std::count(errors.begin(), errors.end(), '\n'), 1) << errors;
  EXPECT_NE(errors.find("cannot be written"), std::string::npos) << errors;
  EXPECT_EQ(FilesIn("tables"), 0);
}

TEST_F(StandardStreams, UnfinishedFilesOfAKilledRunAreRemovedByTheNext) {
  WriteStandingPlan();
  const pid_t run = Start("export plan.json --csv tables --step 1e-7");
  const fs::path tables = folder_ / "tables";
  std::error_code error;
  for (int i = 0; i < 3000; ++i) {
    if (fs::is_directory(tables, error) && FilesIn("tables") == 2) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  ::kill(run, SIGKILL);
  EXPECT_EQ(Wait(run), -1);
  EXPECT_EQ(FilesIn("tables"), 2) << "two unfinished files";
  EXPECT_FALSE(fs::exists(tables / "trajectory.csv"));
  EXPECT_EQ(Run("export plan.json --csv tables").code, 0);
  EXPECT_EQ(FilesIn("tables"), 4);
  EXPECT_TRUE(fs::exists(tables / "trajectory.csv"));
  EXPECT_TRUE(fs::exists(tables / "contact_forces.csv"));
}

// The sanitizers keep freed memory.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
TEST_F(StandardStreams, MemoryOfExportDoesNotGrowWithTheNumberOfRows) {
  WriteStandingPlan();
  const auto peak_bytes = [&](const std::string& step) {
    const pid_t run = Start("export plan.json --csv tables --step " + step);
    int status = 0;
    struct rusage usage = {};
    ::wait4(run, &status, 0, &usage);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << Errors();
    return usage.ru_maxrss * 1024L;
  };
  const long few = peak_bytes("0.1");
  const long many = peak_bytes("2e-5");  // 50,001 rows
  EXPECT_GT(fs::file_size(folder_ / "tables/trajectory.csv"), 10000000u);
  EXPECT_LT(many, few + 10000000);
}
#endif

}  // namespace
}  // namespace possibility::experiments
