#include "experiments/bench/bench_graph.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "experiments/bench/bench_presets.h"
#include "experiments/bench/obstacle_field.h"
#include "experiments/bench/single_gait_search.h"
#include "models/world/scenario.h"
#ifdef POSSIBILITY_WITH_OMPL
#include "experiments/bench/ompl_peers.h"
#endif

namespace possibility::experiments {
namespace {

constexpr std::uint64_t kFieldSeed = 1;
constexpr int kFailuresToGiveUp = 3;

struct Contender {
  std::string name;
  bool is_peer = false;
  std::function<FoundPath(std::uint64_t seed)> search;
};

struct Standing {
  std::vector<double> seconds;
  std::vector<double> lengths;  ///< m, of the ways found

  bool HasGivenUp() const { return lengths.empty() && seconds.size() >= kFailuresToGiveUp; }

  void Add(const FoundPath& path, double time_limit) {
    seconds.push_back(path.found ? path.seconds : time_limit);
    if (path.found) lengths.push_back(LengthOf(path.poses));
  }
};

std::vector<Contender> Ours(const SingleGaitSearch& search, double time_limit) {
  const auto find = [&search, time_limit](actions::PlannerPreset preset) {
    return [&search, time_limit, preset](std::uint64_t seed) {
      return search.Find(preset, seed, time_limit);
    };
  };
  return {{"possibility graph (straight, lattice, random)", false,
           find(actions::PlannerPreset::kDefault)},
          {"possibility graph (random)", false, find(actions::PlannerPreset::kPaper)}};
}

#ifdef POSSIBILITY_WITH_OMPL
void AddPeers(const SingleGaitSearch& search, double time_limit,
              std::vector<Contender>* contenders) {
  const PlanarQuery query = QueryOf(search);
  const auto solve = [query, time_limit](const std::string& planner, double range) {
    return [=](std::uint64_t seed) {
      return PathOf(
          SolveWithOmpl(planner, query, static_cast<std::uint32_t>(seed), time_limit, range));
    };
  };
  for (const std::string& planner : OmplPlanners()) {
    contenders->push_back({"OMPL " + planner, true, solve(planner, 0)});
  }
  // A fifth of the space's extent (the default) is long in a crowded field, so the best planner
  // also runs with shorter motions.
  const double step = search.scenario().planner.step;
  for (const double range : {step, 4 * step}) {
    contenders->push_back(
        {fmt::format("OMPL RRTConnect, range {}", range), true, solve("RRTConnect", range)});
  }
}
#endif

BenchmarkRow RowOf(const std::string& name, const Standing& standing) {
  const double trials = static_cast<double>(standing.seconds.size());
  BenchmarkRow row{name, Median(standing.seconds) * 1e6, {}, {}};
  for (const double seconds : standing.seconds) row.rounds.push_back(seconds * 1e6);
  row.figures = {{"success", static_cast<double>(standing.lengths.size()) / trials},
                 {"trials", trials}};
  if (!standing.lengths.empty()) row.figures.emplace_back("length_m", Median(standing.lengths));
  return row;
}

/// All contenders search with the first seed, then all with the next.
std::vector<Standing> Race(const std::vector<Contender>& contenders,
                           const GraphBenchSettings& settings,
                           const std::function<void()>& on_seed) {
  std::vector<Standing> standings(contenders.size());
  for (int seed = 1; seed <= settings.seeds; ++seed) {
    for (std::size_t i = 0; i < contenders.size(); ++i) {
      if (standings[i].HasGivenUp()) continue;
      standings[i].Add(contenders[i].search(static_cast<std::uint64_t>(seed)), settings.time_limit);
    }
    on_seed();
  }
  return standings;
}

/// The best peer's median over ours (the first contender's); infinite without peers.
double Lead(const std::vector<Contender>& contenders, const std::vector<Standing>& standings) {
  double best_peer = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < contenders.size(); ++i) {
    if (contenders[i].is_peer) best_peer = std::min(best_peer, Median(standings[i].seconds));
  }
  return best_peer / Median(standings.front().seconds);
}

/// One gait on all scenes; returns the smallest lead.
double BenchGait(const models::RobotModel& robot, const std::string& gait,
                 const std::vector<models::Scenario>& scenes, const GraphBenchSettings& settings,
                 const std::function<void()>& on_seed, BenchmarkReport* report) {
  double least_lead = std::numeric_limits<double>::infinity();
  for (const models::Scenario& scene : scenes) {
    const SingleGaitSearch search(robot, gait, scene);
    std::vector<Contender> contenders = Ours(search, settings.time_limit);
#ifdef POSSIBILITY_WITH_OMPL
    AddPeers(search, settings.time_limit, &contenders);
#endif
    const std::vector<Standing> standings = Race(contenders, settings, on_seed);
    for (std::size_t i = 0; i < contenders.size(); ++i) {
      const std::string name = fmt::format("{}, {}: {}", scene.name, gait, contenders[i].name);
      report->rows.push_back(RowOf(name, standings[i]));
    }
    least_lead = std::min(least_lead, Lead(contenders, standings));
  }
  return least_lead;
}

}  // namespace

BenchmarkReport BenchGraph(const models::RobotModel& robot, const GraphBenchSettings& settings,
                           const std::function<void(int, int)>& progress) {
  const std::vector<models::Scenario> scenes = {
      models::LoadScenario(settings.scenarios / "three_routes_a.yaml"),
      ObstacleField(settings.obstacles, kFieldSeed)};
  const int searches = static_cast<int>(robot.gaits.size() * scenes.size()) * settings.seeds;
  const int plans = settings.preset_seeds > 0 ? NumPresetPlans(settings.preset_seeds) : 0;
  int done = 0;
  const auto step = [&] { progress(++done, searches + plans); };

  BenchmarkReport report;
  for (const models::Gait& gait : robot.gaits) {
    const double lead = BenchGait(robot, gait.name, scenes, settings, step, &report);
    if (lead == std::numeric_limits<double>::infinity()) continue;
    report.ratios.push_back({"first_solution_vs_ompl_" + gait.name, lead,
                             "time to the first solution: OMPL's best planner / ours"});
  }
  if (settings.preset_seeds > 0) {
    ComparePresets(robot, settings.scenarios, settings.preset_seeds, settings.preset_time_limit,
                   step, &report);
  }
  return report;
}

}  // namespace possibility::experiments
