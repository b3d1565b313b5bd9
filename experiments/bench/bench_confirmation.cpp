#include "experiments/bench/bench_confirmation.h"

#include <fmt/format.h>

#include <filesystem>

#include "actions/jump/jump_sweep.h"
#include "common/stopwatch.h"
#include "experiments/support/temporary_folder.h"
#include "models/input/input_error.h"

namespace possibility::experiments {
namespace {

using actions::JumpAnswer;
using actions::JumpSweepEntry;
using actions::JumpTask;

/// Fraction confirmed of the entries between the first and the last possible one of each height.
double ConfirmedFraction(const std::vector<JumpSweepEntry>& entries,
                         const actions::JumpReach& reach) {
  int inside = 0;
  int confirmed = 0;
  for (const JumpSweepEntry& entry : entries) {
    for (const actions::JumpReach::Row& row : reach.rows) {
      if (row.height != entry.task.height || entry.task.distance < row.shortest ||
          entry.task.distance > row.farthest) {
        continue;
      }
      ++inside;
      confirmed += entry.is_possible ? 1 : 0;
    }
  }
  return inside > 0 ? static_cast<double>(confirmed) / inside : 0;
}

/// Median time, s, with a folder that another run filled.
double LibraryMedian(const actions::JumpSolver& solver, const std::filesystem::path& folder,
                     const std::vector<JumpSweepEntry>& entries) {
  actions::JumpLibrary library(solver, folder);
  std::vector<double> seconds;
  for (const JumpSweepEntry& entry : entries) {
    if (!entry.is_possible) continue;
    const Stopwatch stopwatch;
    library.Find(entry.task);
    seconds.push_back(stopwatch.Seconds());
  }
  return seconds.empty() ? 0 : Median(seconds);
}

void AddTimes(const std::vector<JumpSweepEntry>& entries, BenchmarkReport* report) {
  std::vector<double> total, iterations, functions, kkt, rest, realisation;
  for (const JumpSweepEntry& entry : entries) {
    if (!entry.is_possible) continue;
    const actions::JumpEffort& effort = entry.effort;
    total.push_back(effort.total);
    iterations.push_back(effort.iterations);
    functions.push_back(effort.solver.functions + effort.solver.derivatives);
    kkt.push_back(effort.solver.factorisation + effort.solver.back_solves);
    rest.push_back(effort.solver.rest);
    realisation.push_back(effort.realisation);
  }
  if (total.empty()) return;
  report->figures = {
      {"cold_s_median", Median(total)},          {"iterations_median", Median(iterations)},
      {"functions_s_median", Median(functions)}, {"kkt_s_median", Median(kkt)},
      {"ipopt_rest_s_median", Median(rest)},     {"realisation_s_median", Median(realisation)}};
}

}  // namespace

BenchmarkReport BenchConfirmation(const models::RobotModel& robot,
                                  const std::function<void(int, int)>& progress) {
  if (robot.jumps.empty()) {
    throw InputError(fmt::format("{}: jumps: the robot has none", robot.file.string()));
  }
  const models::Jump& jump = robot.jumps.front();
  const auto launch = actions::SolveNominalStance(robot, robot.GaitNamed(jump.from));
  const auto landing = actions::SolveNominalStance(robot, robot.GaitNamed(jump.to));
  const actions::JumpSolver solver(robot, launch, landing);
  const TemporaryFolder folder;
  actions::JumpLibrary library(solver, folder.path());
  actions::JumpSweep sweep;
  sweep.heights = {-0.2, -0.1, 0, 0.1, 0.2};
  sweep.progress = progress;
  const std::vector<JumpSweepEntry> entries = actions::SweepJumps(sweep, &library);
  const actions::JumpReach reach = actions::ReachOf(entries);

  BenchmarkReport report;
  for (const JumpSweepEntry& entry : entries) {
    report.rows.push_back(
        {fmt::format("jump {:.2f} m by {:+.2f} m{}", entry.task.distance, entry.task.height,
                     entry.is_possible ? "" : ": " + entry.reason),
         1e6 * entry.effort.total,
         {}});
  }
  AddTimes(entries, &report);
  report.figures.push_back({"library_s_median", LibraryMedian(solver, folder.path(), entries)});
  report.ratios.push_back(
      {"confirmed_fraction", ConfirmedFraction(entries, reach), "of the jumps within the reach"});
  const auto worker = [&solver]() -> std::function<void(int)> {
    return [&solver](int i) { solver.Solve({0.3 + 0.05 * (i % 8), 0}); };
  };
  report.ratios.push_back({"two_worker_throughput", TwoThreadThroughput(worker, 8, 3),
                           "jumps per second, two workers over one"});
  return report;
}

}  // namespace possibility::experiments
