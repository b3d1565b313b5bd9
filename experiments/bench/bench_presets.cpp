#include "experiments/bench/bench_presets.h"

#include <fmt/format.h>

#include <iterator>
#include <string>
#include <vector>

#include "actions/planner/planner.h"
#include "models/world/scenario.h"

namespace possibility::experiments {
namespace {

constexpr const char* kScenarios[] = {"three_routes_a", "three_routes_b", "three_routes_c",
                                      "hallway", "double_jump"};

struct Trials {
  std::vector<double> microseconds;
  int found = 0;
};

void AddTrial(const models::RobotModel& robot, const models::Scenario& scenario,
              actions::PlanRequest request, actions::PlannerPreset preset, Trials* trials) {
  request.preset = preset;
  const actions::PlanResult result = actions::PlanTraversal(robot, scenario, request);
  const bool found = result.status == actions::PlanStatus::kFound;
  const double seconds = found ? result.plan.timings.graph_s : request.time_limit;
  trials->microseconds.push_back(seconds * 1e6);
  trials->found += found ? 1 : 0;
}

BenchmarkRow RowOf(const std::string& name, const Trials& trials) {
  const double count = static_cast<double>(trials.microseconds.size());
  return {name,
          Median(trials.microseconds),
          trials.microseconds,
          {{"success", trials.found / count}, {"trials", count}}};
}

}  // namespace

int NumPresetPlans(int seeds) { return 2 * seeds * static_cast<int>(std::size(kScenarios)); }

void ComparePresets(const models::RobotModel& robot, const std::filesystem::path& scenarios,
                    int seeds, double time_limit, const std::function<void()>& on_plan,
                    BenchmarkReport* report) {
  std::vector<double> ratios;
  for (const std::string name : kScenarios) {
    const models::Scenario scenario = models::LoadScenario(scenarios / (name + ".yaml"));
    actions::PlanRequest request;
    request.time_limit = time_limit;
    request.library = robot.file.parent_path() / "jumps";
    request.actions = {"walk", "crawl", "jump"};
    Trials ours;
    Trials papers;
    for (int seed = 1; seed <= seeds; ++seed) {
      request.seed = static_cast<std::uint64_t>(seed);
      AddTrial(robot, scenario, request, actions::PlannerPreset::kDefault, &ours);
      on_plan();
      AddTrial(robot, scenario, request, actions::PlannerPreset::kPaper, &papers);
      on_plan();
    }
    report->rows.push_back(RowOf(fmt::format("{}: default preset", name), ours));
    report->rows.push_back(RowOf(fmt::format("{}: paper preset", name), papers));
    ratios.push_back(Median(papers.microseconds) / Median(ours.microseconds));
  }
  report->ratios.push_back({"default_vs_paper_preset", Median(ratios),
                            "time in the graph with three actions: paper preset / default"});
}

}  // namespace possibility::experiments
