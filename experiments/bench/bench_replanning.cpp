#include "experiments/bench/bench_replanning.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "actions/replanning/replanner.h"
#include "actions/verify/verifier.h"
#include "common/stopwatch.h"
#include "experiments/bench/scenario_folder.h"
#include "models/input/input_error.h"
#include "models/world/scenario.h"

namespace possibility::experiments {
namespace {

using models::Obstacle;

constexpr double kLeastMove = 0.05, kFarthestMove = 0.5;  // m
constexpr double kTenth = 0.1;
constexpr int kDraws = 100;

/// Obstacles that may be moved: neither ground nor pieces of a mesh.
std::vector<std::size_t> Movable(const models::Environment& environment) {
  std::vector<std::size_t> movable;
  for (std::size_t i = 0; i < environment.obstacles.size(); ++i) {
    const Obstacle& obstacle = environment.obstacles[i];
    if (!obstacle.is_ground && obstacle.surface < 0) movable.push_back(i);
  }
  return movable;
}

/// The scene with a crate at the middle of its longer side, if it has nothing to move.
models::Scenario WithSomethingToMove(models::Scenario scenario) {
  if (!Movable(scenario.environment).empty()) return scenario;
  const Eigen::AlignedBox2d& bounds = scenario.environment.bounds;
  Obstacle crate;
  crate.name = "crate";
  crate.shape = models::Shape::Box({0.4, 0.4, 0.6});
  crate.X_WO.translation() << bounds.center().x(), bounds.max().y() - 0.2, 0.3;
  scenario.environment.obstacles.push_back(crate);
  scenario.content_hash += " with a crate";
  return scenario;
}

struct Move {
  models::Scenario scenario;
  std::string name;  ///< of the obstacle
  double by = 0;     ///< m
};

Move Moved(const models::Scenario& scenario, std::mt19937_64* generator) {
  // Not a standard distribution: the moves are the same everywhere.
  const auto unit = [&] { return static_cast<double>((*generator)() >> 11) * 0x1p-53; };
  Move move{scenario, {}, kLeastMove + (kFarthestMove - kLeastMove) * unit()};
  const std::vector<std::size_t> movable = Movable(scenario.environment);
  const std::size_t which = movable[(*generator)() % movable.size()];
  Obstacle& moved = move.scenario.environment.obstacles[which];
  const double direction = 2 * std::numbers::pi * unit();
  moved.X_WO.translation() +=
      move.by * Eigen::Vector3d(std::cos(direction), std::sin(direction), 0);
  move.name = moved.name;
  move.scenario.content_hash += fmt::format(" {} {} {}", which, move.by, direction);
  return move;
}

actions::PlanRequest UsualRequest(const models::Scenario& scenario,
                                  const models::RobotModel& robot) {
  actions::PlanRequest request;
  request.seed = scenario.seed;
  request.time_limit = scenario.time_limit;
  request.library = robot.file.parent_path() / "jumps";
  return request;
}

/// The scenes of a folder that have a plan.
std::vector<models::Scenario> ScenesOf(const models::RobotModel& robot,
                                       const std::filesystem::path& folder) {
  std::vector<models::Scenario> scenes;
  for (const models::Scenario& scenario : ScenariosOf(robot, folder)) {
    const models::Scenario scene = WithSomethingToMove(scenario);
    const actions::PlanResult plan =
        actions::PlanTraversal(robot, scene, UsualRequest(scene, robot));
    if (plan.status == actions::PlanStatus::kFound) scenes.push_back(scene);
  }
  return scenes;
}

struct MoveOutcome {
  std::string name;
  double from_nothing_s = 0, replan_s = 0;
  bool found_from_nothing = false, found = false, kept = false, verified = false;
  /// Of a plan that is new: motion that was generated, and its verification, s. No memory of other
  /// plans can spare them.
  double new_motion_s = 0;

  double ratio() const { return replan_s / from_nothing_s; }
  bool agrees() const { return found == found_from_nothing && verified == found; }
};

MoveOutcome CompareMove(const models::RobotModel& robot, const models::Scenario& scene,
                        const Move& move) {
  const actions::PlanRequest request = UsualRequest(move.scenario, robot);
  MoveOutcome outcome;
  outcome.name = fmt::format("{}: {} by {:.2f} m", scene.name, move.name, move.by);
  const Stopwatch from_nothing;
  const actions::PlanResult expected = actions::PlanTraversal(robot, move.scenario, request);
  outcome.from_nothing_s = from_nothing.Seconds();
  actions::Replanner replanner;
  replanner.Plan(robot, scene, request);
  const Stopwatch replan;
  const actions::PlanResult result = replanner.Plan(robot, move.scenario, request);
  outcome.replan_s = replan.Seconds();
  outcome.kept = replanner.reuse().plan;
  outcome.found_from_nothing = expected.status == actions::PlanStatus::kFound;
  outcome.found = result.status == actions::PlanStatus::kFound;
  if (outcome.found && !outcome.kept) {
    outcome.new_motion_s = result.plan.timings.motion_s + result.plan.timings.verification_s;
  }
  outcome.verified = outcome.found && actions::Verify(result.plan, robot, move.scenario).accepted();
  return outcome;
}

/// None if the move leaves no scene to plan: the obstacle is where the robot starts or ends.
std::optional<MoveOutcome> TryMove(const models::RobotModel& robot, const models::Scenario& scene,
                                   const Move& move) {
  try {
    return CompareMove(robot, scene, move);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

BenchmarkRow RowOfMove(const MoveOutcome& outcome) {
  return {outcome.name,
          outcome.replan_s * 1e6,
          {outcome.replan_s * 1e6},
          {{"from_nothing_s", outcome.from_nothing_s},
           {"replan_s", outcome.replan_s},
           {"ratio", outcome.ratio()},
           {"new_motion_s", outcome.new_motion_s},
           {"found", outcome.found},
           {"kept", outcome.kept},
           {"verified", outcome.verified},
           {"agrees", outcome.agrees()}}};
}

void SummariseMoves(const std::vector<MoveOutcome>& outcomes, BenchmarkReport* report) {
  std::vector<double> all, kept, anew;
  double agree = 0, within = 0;
  for (const MoveOutcome& outcome : outcomes) {
    all.push_back(outcome.ratio());
    (outcome.kept ? kept : anew).push_back(outcome.ratio());
    agree += outcome.agrees() ? 1 : 0;
    within += outcome.ratio() <= kTenth ? 1 : 0;
  }
  const auto add = [&](const std::string& name, const std::vector<double>& ratios) {
    report->figures.emplace_back(name + "_count", static_cast<double>(ratios.size()));
    if (ratios.empty()) return;
    report->figures.emplace_back(name + "_ratio_median", Median(ratios));
    report->figures.emplace_back(name + "_ratio_max",
                                 *std::max_element(ratios.begin(), ratios.end()));
  };
  add("all", all);
  add("kept", kept);
  add("anew", anew);
  report->figures.emplace_back("within_a_tenth", within);
  report->figures.emplace_back("agree", agree);
}

}  // namespace

BenchmarkReport BenchReplanning(const models::RobotModel& robot,
                                const ReplanningBenchSettings& settings,
                                const std::function<void(int, int)>& progress) {
  const std::vector<models::Scenario> scenes = ScenesOf(robot, settings.scenarios);
  std::mt19937_64 generator(1);
  std::vector<MoveOutcome> outcomes;
  BenchmarkReport report;
  const int most_draws = settings.moves * kDraws;
  for (int draw = 0; static_cast<int>(outcomes.size()) < settings.moves; ++draw) {
    if (scenes.empty() || draw == most_draws) {
      throw InputError(fmt::format("{}: no scene with a plan and an obstacle that can be moved",
                                   settings.scenarios.string()));
    }
    progress(static_cast<int>(outcomes.size()), settings.moves);
    const models::Scenario& scene = scenes[static_cast<std::size_t>(draw) % scenes.size()];
    const std::optional<MoveOutcome> outcome = TryMove(robot, scene, Moved(scene, &generator));
    if (!outcome) continue;
    outcomes.push_back(*outcome);
    report.rows.push_back(RowOfMove(*outcome));
  }
  progress(settings.moves, settings.moves);
  SummariseMoves(outcomes, &report);
  return report;
}

}  // namespace possibility::experiments
