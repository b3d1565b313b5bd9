#include "experiments/program/bench_command.h"

#include <fmt/format.h>
#include <unistd.h>

#include <map>
#include <memory>
#include <string>

#include "common/stopwatch.h"
#include "experiments/bench/bench_anytime.h"
#include "experiments/bench/bench_collocation.h"
#include "experiments/bench/bench_confirmation.h"
#include "experiments/bench/bench_dynamics.h"
#include "experiments/bench/bench_graph.h"
#include "experiments/bench/bench_replanning.h"
#include "experiments/bench/benchmark.h"
#include "experiments/support/option_values.h"
#include "experiments/support/standard_streams.h"
#include "models/input/input_error.h"
#include "models/input/json_text.h"
#include "models/input/nearest_name.h"
#include "models/robot/robot_yaml.h"

namespace possibility::experiments {
namespace {

struct BenchOptions {
  std::string subject;
  std::string robot = "models/drchubo1/drchubo1.yaml";
  std::string scenarios = GraphBenchSettings().scenarios;
  std::string seeds;
  std::string moves;
  std::string time_limit;
  std::string plot;
  bool json = false;
};

using Progress = std::function<void(int, int)>;
using Bench =
    std::function<BenchmarkReport(const BenchOptions&, const models::RobotModel&, const Progress&)>;

/// A subject that needs only the robot.
template <typename Function>
Bench OfRobot(Function bench) {
  return [bench](const BenchOptions&, const models::RobotModel& robot, const Progress& progress) {
    return bench(robot, progress);
  };
}

BenchmarkReport BenchGraphAsAsked(const BenchOptions& options, const models::RobotModel& robot,
                                  const Progress& progress) {
  GraphBenchSettings settings;
  settings.scenarios = options.scenarios;
  if (!options.seeds.empty()) {
    settings.seeds = static_cast<int>(ParseInteger("--seeds", options.seeds, 1, 100000));
  }
  return BenchGraph(robot, settings, progress);
}

BenchmarkReport BenchReplanningAsAsked(const BenchOptions& options, const models::RobotModel& robot,
                                       const Progress& progress) {
  ReplanningBenchSettings settings;
  settings.scenarios = options.scenarios;
  if (!options.moves.empty()) {
    settings.moves = static_cast<int>(ParseInteger("--moves", options.moves, 1, 100000));
  }
  return BenchReplanning(robot, settings, progress);
}

BenchmarkReport BenchAnytimeAsAsked(const BenchOptions& options, const models::RobotModel& robot,
                                    const Progress& progress) {
  AnytimeBenchSettings settings;
  settings.scenarios = options.scenarios;
  settings.plot = options.plot;
  if (!options.time_limit.empty()) {
    settings.time_limit = ParseSeconds("--time-limit", options.time_limit);
  }
  return BenchAnytime(robot, settings, progress);
}

const std::map<std::string, Bench>& Benches() {
  static const std::map<std::string, Bench> benches = {
      {"anytime", &BenchAnytimeAsAsked},
      {"collocation", OfRobot(&BenchCollocation)},
      {"confirmation", OfRobot(&BenchConfirmation)},
      {"dynamics", OfRobot(&BenchDynamics)},
      {"graph", &BenchGraphAsAsked},
      {"replanning", &BenchReplanningAsAsked}};
  return benches;
}

/// Rewrites "3 of 15, about 40 s left" on stderr, if it is a terminal.
class ShownProgress {
 public:
  void Show(int done, int all) {
    if (isatty(STDERR_FILENO) == 0) return;
    if (done == 0) stopwatch_ = Stopwatch();
    PrintError("\r\x1b[K");
    if (done == all) return;
    PrintError("{} of {}", done, all);
    if (done > 0) PrintError(", about {:.0f} s left", stopwatch_.Seconds() * (all - done) / done);
  }

 private:
  Stopwatch stopwatch_;
};

ExitCode RunBench(const BenchOptions& options) {
  const auto found = Benches().find(options.subject);
  if (found == Benches().end()) {
    std::vector<std::string> known;
    for (const auto& [name, bench] : Benches()) known.push_back(name);
    throw InputError(fmt::format("bench: unknown subject '{}', expected {}{}", options.subject,
                                 fmt::join(known, ", "),
                                 models::DidYouMean(options.subject, known)));
  }
  ShownProgress shown;
  const BenchmarkReport report =
      found->second(options, models::LoadRobotModel(options.robot),
                    [&shown](int done, int all) { shown.Show(done, all); });
  if (options.json) {
    PrintOut("{}\n", models::JsonText(report.Json()));
  } else {
    PrintOut("{}", report.Text());
  }
  return kDone;
}

}  // namespace

Command AddBenchCommand(CLI::App& program) {
  CommandOptions command(program, "bench", "Measures speed, against peers in the same run.");
  auto options = std::make_shared<BenchOptions>();
  command.AddRequired("SUBJECT", &options->subject,
                      "anytime, collocation, confirmation, dynamics, graph or replanning");
  command.AddOptional("--robot", &options->robot, "Robot YAML");
  command.AddOptional("--scenarios", &options->scenarios,
                      "anytime, graph, replanning: folder of the scenarios");
  command.AddOptional("--seeds", &options->seeds, "graph: searches of each planner (default 20)");
  command.AddOptional("--time-limit", &options->time_limit, "anytime: s, of each plan (30)");
  command.AddOptional("--plot", &options->plot, "anytime: SVG of durations over time");
  command.AddOptional("--moves", &options->moves, "replanning: moved scenes (default 50)");
  command.AddFlag("--json", &options->json, "One JSON object on stdout, nothing else");
  return {command, [options] { return RunBench(*options); }};
}

}  // namespace possibility::experiments
