#include "experiments/bench/bench_anytime.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "actions/planner/planner.h"
#include "actions/verify/verifier.h"
#include "common/stopwatch.h"
#include "experiments/bench/scenario_folder.h"
#include "experiments/report/svg_plot.h"
#include "experiments/support/output_file.h"
#include "models/world/scenario.h"

namespace possibility::experiments {
namespace {

/// The plans of one scenario, in the order they were found.
struct AnytimeRun {
  std::string name;
  std::vector<double> times;      ///< s since the beginning
  std::vector<double> durations;  ///< s
  double least_duration = 0;      ///< s, the lower bound; the greatest of all times
  bool verified = true;           ///< all
};

AnytimeRun RunAnytime(const models::RobotModel& robot, const models::Scenario& scenario,
                      double time_limit) {
  AnytimeRun run;
  run.name = scenario.name;
  actions::PlanRequest request;
  request.seed = scenario.seed;
  request.time_limit = time_limit;
  request.library = robot.file.parent_path() / "jumps";
  std::vector<actions::Plan> plans;
  const Stopwatch stopwatch;
  request.improved = [&](const actions::PlanResult& result) {
    run.times.push_back(stopwatch.Seconds());
    run.durations.push_back(result.plan.duration());
    run.least_duration = std::max(run.least_duration, result.least_duration);
    plans.push_back(result.plan);
  };
  actions::PlanTraversal(robot, scenario, request);
  for (const actions::Plan& plan : plans) {
    run.verified = run.verified && actions::Verify(plan, robot, scenario).accepted();
  }
  return run;
}

BenchmarkRow RowOfRun(const AnytimeRun& run) {
  const double first = run.durations.front();
  const double last = run.durations.back();
  return {run.name,
          run.times.back() * 1e6,
          {run.times.back() * 1e6},
          {{"first_at_s", run.times.front()},
           {"last_at_s", run.times.back()},
           {"plans", static_cast<double>(run.durations.size())},
           {"first_duration_s", first},
           {"last_duration_s", last},
           {"share", last / first},
           {"least_duration_s", run.least_duration},
           {"gap", 1 - run.least_duration / last},
           {"verified", run.verified}}};
}

/// Steps down from plan to plan, until the time limit.
PlotCurve CurveOf(const AnytimeRun& run, double time_limit) {
  PlotCurve curve;
  curve.label = run.name;
  for (std::size_t i = 0; i < run.times.size(); ++i) {
    const double share = run.durations[i] / run.durations.front();
    const double until = i + 1 < run.times.size() ? run.times[i + 1] : time_limit;
    curve.x.insert(curve.x.end(), {run.times[i], until});
    curve.y.insert(curve.y.end(), {share, share});
  }
  return curve;
}

void WritePlot(const std::vector<AnytimeRun>& runs, const AnytimeBenchSettings& settings) {
  Plot plot;
  plot.title = "Duration of the plan over that of the first plan";
  plot.x = {"time since the beginning", "s", true, {}};
  plot.y = {"share", "", false, {}};
  plot.height = 420;
  for (const AnytimeRun& run : runs) plot.curves.push_back(CurveOf(run, settings.time_limit));
  WriteOutput(settings.plot, SvgDocument({plot}));
}

}  // namespace

BenchmarkReport BenchAnytime(const models::RobotModel& robot, const AnytimeBenchSettings& settings,
                             const std::function<void(int, int)>& progress) {
  const std::vector<models::Scenario> scenarios = ScenariosOf(robot, settings.scenarios);
  std::vector<AnytimeRun> runs;
  std::vector<double> shares, gaps;
  BenchmarkReport report;
  for (std::size_t i = 0; i < scenarios.size(); ++i) {
    progress(static_cast<int>(i), static_cast<int>(scenarios.size()));
    AnytimeRun run = RunAnytime(robot, scenarios[i], settings.time_limit);
    if (run.durations.empty()) continue;
    report.rows.push_back(RowOfRun(run));
    shares.push_back(run.durations.back() / run.durations.front());
    gaps.push_back(1 - run.least_duration / run.durations.back());
    runs.push_back(std::move(run));
  }
  progress(static_cast<int>(scenarios.size()), static_cast<int>(scenarios.size()));
  if (runs.empty()) return report;
  report.figures = {{"scenes", static_cast<double>(runs.size())},
                    {"share_median", Median(shares)},
                    {"share_least", *std::min_element(shares.begin(), shares.end())},
                    {"gap_median", Median(gaps)},
                    {"gap_least", *std::min_element(gaps.begin(), gaps.end())}};
  if (!settings.plot.empty()) WritePlot(runs, settings);
  return report;
}

}  // namespace possibility::experiments
