// The program itself with spoilt files. Exit codes are 0 to 3, an exit code of 1 comes with one
// line on standard error, and the program ends in time.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <fstream>
#include <ostream>
#include <thread>

#include "models/input/file_contents.h"
#include "tests/experiments/program_run.h"
#include "tests/fuzz/case_runner.h"
#include "tests/fuzz/onboarding_subjects.h"
#include "tests/fuzz/subjects.h"
#include "tests/replaced.h"

namespace possibility::fuzz {
namespace {

namespace fs = std::filesystem;

struct Kind {
  const char* name;
  Subject (*make)(const fs::path&);
  /// Arguments of the program. SPOILT is the file, SOURCE the project's folder.
  std::vector<std::string> commands;
  std::string before = {};  ///< shell commands to run before
  int many = 100;           ///< cases of the long test
};

void PrintTo(const Kind& kind, std::ostream* out) { *out << kind.name; }

const std::string kPlan =
    " --out out --time-limit 1 --threads 1 --library 'SOURCE/models/drchubo1/jumps'";

const Kind kKinds[] = {
    {"Scenario", &ScenarioSubject, {"plan SPOILT" + kPlan}},
    {"Robot", &RobotSubject, {"plan scenario.yaml" + kPlan}},
    {"Urdf", &UrdfSubject, {"plan scenario.yaml" + kPlan}},
    {"Plan",
     &PlanSubject,
     {"verify SPOILT", "verify SPOILT --json", "rollout SPOILT --perturb mass=1.05",
      "view SPOILT --out page.html", "export SPOILT --csv tables", "export SPOILT --plan a.zip"}},
    {"PackedPlan",
     &PackedPlanSubject,
     {"verify SPOILT", "verify SPOILT --json", "view SPOILT --out page.html",
      "export SPOILT --csv tables", "export SPOILT --plan a.json"}},
    {"Trajectory",
     &TrajectorySubject,
     {"import SPOILT --scenario 'SOURCE/experiments/scenarios/three_routes_b.yaml' --out out",
      "import SPOILT --scenario 'SOURCE/experiments/scenarios/three_routes_b.yaml' --out out "
      "--json"}},
    {"Solution",
     &SolutionSubject,
     {"view SPOILT --robot 'SOURCE/models/drchubo1/drchubo1.yaml' --out page.html"}},
    {"Library",
     &LibrarySubject,
     {"plan 'SOURCE/experiments/scenarios/double_jump.yaml' --out out --time-limit 1 --threads 1 "
      "--library library"},
     "for f in library/*; do cp spoilt.json $f/reach.json; cp spoilt.json $f/paces_walk.json; "
     "done;"},
    {"InitUrdf", &InitUrdfSubject, {"robot init SPOILT --out out --fit-seconds 1"}, "", 200},
    {"InitSrdf",
     &InitSrdfSubject,
     {"robot init 'SOURCE/models/t1/t1.urdf' --srdf SPOILT --out out --fit-seconds 1"},
     "",
     200},
    {"InitMesh",
     &InitMeshSubject,
     {"robot init whole/robot.urdf --out out --fit-seconds 1"},
     "cp spoilt.mesh whole/foot.stl;",
     200},
};

class ProgramFuzz : public experiments::testing::ProgramRun,
                    public ::testing::WithParamInterface<Kind> {
 protected:
  void RunCases(std::uint64_t first_seed, int count) {
    fs::create_directories(folder_ / "whole");
    const Subject subject = GetParam().make(folder_ / "whole");
    WriteWholeFiles(subject);
    for (std::uint64_t seed = first_seed; seed < first_seed + count; ++seed) {
      const std::string text = SpoiltText(subject, seed);
      std::ofstream(folder_ / ("spoilt" + subject.extension), std::ios::binary) << text;
      for (const std::string& command : GetParam().commands) {
        const std::string words =
            ReplacedEverywhere(ReplacedEverywhere(command, "SPOILT", "spoilt" + subject.extension),
                               "SOURCE", POSSIBILITY_SOURCE_DIR);
        const int code = WaitInTime(Start(words, GetParam().before));
        if (IsRight(code)) continue;
        ADD_FAILURE() << subject.name << ", seed " << seed << ": " << words << ": exit code "
                      << code << "\n"
                      << Errors() << "\n"
                      << KeepFailure(subject.name + "_program", seed, subject.extension, text);
      }
    }
  }

 private:
  /// Writes a scenario whose robot is the spoilt one, and a library.
  void WriteWholeFiles(const Subject& subject) const {
    const fs::path source = POSSIBILITY_SOURCE_DIR;
    fs::copy(source / "models/drchubo1/jumps", folder_ / "library", fs::copy_options::recursive);
    const std::string scenario =
        models::ReadFileContents(source / "experiments/scenarios/closed_room.yaml");
    const bool is_urdf = subject.extension == ".urdf";
    std::ofstream(folder_ / "scenario.yaml") << ReplacedEverywhere(
        scenario, "../../models/drchubo1/drchubo1.yaml", is_urdf ? "robot.yaml" : "spoilt.yaml");
    std::ofstream(folder_ / "robot.yaml")
        << ReplacedEverywhere(models::ReadFileContents(source / "models/drchubo1/drchubo1.yaml"),
                              "drchubo1.urdf", "spoilt.urdf");
  }

  /// The exit code; -1: killed by a signal, -2: still running after two minutes.
  static int WaitInTime(pid_t program) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(2);
    int status = 0;
    while (::waitpid(program, &status, WNOHANG) == 0) {
      if (std::chrono::steady_clock::now() > end) {
        ::kill(program, SIGKILL);
        ::waitpid(program, &status, 0);
        return -2;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  bool IsRight(int code) const {
    const std::string errors = Errors();
    const bool is_one_line = std::count(errors.begin(), errors.end(), '\n') == 1;
    return code >= 0 && code <= 3 && (code != 1 || is_one_line);
  }
};

TEST_P(ProgramFuzz, SpoiltFilesEndWithADocumentedExitCode) { RunCases(20000, 2); }

class ProgramFuzzLong : public ProgramFuzz {};

TEST_P(ProgramFuzzLong, SpoiltFilesEndWithADocumentedExitCode) { RunCases(21000, GetParam().many); }

std::string NameOf(const ::testing::TestParamInfo<Kind>& info) { return info.param.name; }

INSTANTIATE_TEST_SUITE_P(Kinds, ProgramFuzz, ::testing::ValuesIn(kKinds), &NameOf);
INSTANTIATE_TEST_SUITE_P(Kinds, ProgramFuzzLong, ::testing::ValuesIn(kKinds), &NameOf);

}  // namespace
}  // namespace possibility::fuzz
