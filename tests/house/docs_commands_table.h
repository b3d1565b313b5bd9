#pragma once

#include <string>
#include <vector>

namespace possibility::house {

enum class CommandKind {
  kLong,   ///< takes more than 10 s: only with the long tests
  kExempt  ///< is not run
};

struct CommandRule {
  std::string document;
  std::string begins;  ///< how the command begins
  CommandKind kind = CommandKind::kLong;
  std::string why;
};

/// Every command of README.md, CONTRIBUTING.md and docs/*.md that is not run by the quick tests.
inline const std::vector<CommandRule>& CommandRules() {
  using enum CommandKind;
  static const std::vector<CommandRule> rules = {
      {"README.md", "./test", kExempt, "installs, builds and runs all tests"},
      {"README.md", "./run plan experiments/scenarios/hallway.yaml", kLong, "plans jumps"},
      {"README.md", "./run plan experiments/scenarios/everything.yaml", kLong, "is a long course"},
      {"README.md", "./run bench", kLong, "measures for ten seconds"},
      {"README.md", "./run library", kLong, "solves every jump"},
      {"README.md", "sh cmake/build_release.sh", kExempt, "installs and builds"},
      {"README.md", "PYTHONPATH=", kExempt, "python.pytest runs the example"},
      {"CONTRIBUTING.md", "./test", kExempt, "installs, builds and runs all tests"},
      {"docs/anytime.md", "./run plan", kLong, "plans for half a minute"},
      {"docs/anytime.md", "./run bench", kExempt, "plans every scene for half a minute"},
      {"docs/cluster.md", "possibility table", kExempt, "takes hours"},
      {"docs/cluster.md", "possibility merge", kExempt, "merges what takes hours"},
      {"docs/cluster.md", "mkdir", kExempt, "needs a cluster; Slurm.JobArray has the like"},
      {"docs/cluster.md", "sbatch", kExempt, "needs a cluster; Slurm.JobArray has the like"},
      {"docs/cluster.md", "build/release", kExempt, "needs a cluster; Slurm.JobArray has the like"},
      {"docs/cpp.md", "cmake", kExempt, "Outside.ExampleProject and Outside.Reference do the like"},
      {"docs/cpp.md", "example/built", kExempt, "Outside.ExampleProject does the like"},
      {"docs/development.md", "cmake", kExempt, "builds"},
      {"docs/development.md", "ctest", kExempt, "runs all tests"},
      {"docs/experiments.md", "./run table --trials 50", kExempt, "takes hours"},
      {"docs/experiments.md", "./run table --twins", kLong, "plans many times"},
      {"docs/experiments.md", "./run sweep", kExempt, "takes hours"},
      {"docs/python.md", "sh cmake/build_release.sh", kExempt, "installs and builds"},
      {"docs/python.md", "PYTHONPATH=", kExempt, "python.pytest runs all of the page"},
      {"docs/python.md", "cmake --install", kExempt, "installs"},
      {"docs/replanning.md", "./run plan", kExempt,
       "runs until it is interrupted: PlanWatch has the like"},
      {"docs/replanning.md", "./run bench", kExempt, "plans a hundred and fifty times"},
      {"docs/robots.md", "./run robot init", kLong, "fits a gait"},
      {"docs/robots.md", "./run robot check", kLong, "reports on what the command before makes"},
      {"docs/robots.md", "./run robot fit", kLong, "fits a gait"},
      {"docs/tutorial.md", "./run plan experiments/scenarios/my_room.yaml --seed 7", kExempt,
       "walks only once the reader has raised the bars"},
      {"docs/tutorial_new_action.md", "cmake", kExempt, "builds"},
      {"docs/verification.md", "/usr/bin/python3", kExempt,
       "needs dartpy; OtherEngine.quick runs the script"},
      {"docs/viewer.md", "./run view out/a --record", kExempt,
       "needs Chromium; Record.WritesFramesOrAFilm has the like"},
  };
  return rules;
}

/// How the lines of an output begin whose numbers depend on the machine and on the day.
inline const std::vector<std::string>& MeasuredNames() {
  static const std::vector<std::string> names = {"preparation", "graph",        "confirmation",
                                                 "motion",      "verification", "real-time ratio"};
  return names;
}

}  // namespace possibility::house
