#include "experiments/bench/single_gait_search.h"

#include <fmt/format.h>

#include <utility>

#include "actions/route/lattice_explorer.h"
#include "common/stopwatch.h"
#include "graph/search/random_explorer.h"
#include "models/input/input_error.h"

namespace possibility::experiments {
namespace {

using actions::GroundedStance;
using actions::PlanarPose;

PlanarPose PoseOf(const models::Stance& stance) { return {stance.x, stance.y, stance.yaw}; }

}  // namespace

SingleGaitSearch::SingleGaitSearch(const models::RobotModel& robot, const std::string& gait,
                                   models::Scenario scenario)
    : model_(actions::BuildLocomotionModel(robot, {gait})),
      scenario_(std::move(scenario)),
      ground_(scenario_.environment, robot.friction),
      world_{&scenario_.environment, &ground_},
      start_(PoseOf(scenario_.start)),
      goal_(PoseOf(scenario_.goals.front())) {
  if (model_.gaits.size() != 1) {
    throw InputError(fmt::format("{}: '{}' is not a gait", robot.file.string(), gait));
  }
  space_ = std::make_shared<actions::PelvisPoseSpace>(
      scenario_.environment.bounds, ground_.levels(), scenario_.planner.rotation_weight);
  gaits_.push_back(std::make_shared<actions::QuasiStaticAction>(model_, 0, world_, space_,
                                                                scenario_.planner.step));
  for (const PlanarPose& end : {start_, goal_}) {
    if (IsValid(end)) continue;
    throw InputError(fmt::format("{}: '{}' is impossible at ({}, {}), where the way begins or ends",
                                 scenario_.name, gait, end.x, end.y));
  }
}

graph::Point SingleGaitSearch::PointAt(const PlanarPose& pose) const {
  return actions::ToPoint(model_.gaits[0]->stance.RootPose(pose, scenario_.start.z));
}

PlanarPose SingleGaitSearch::PoseAt(const graph::Point& point) const {
  return actions::AsStance(model_, 0, actions::ToPose(point)).value().pose;
}

bool SingleGaitSearch::IsValid(const PlanarPose& pose) const {
  return gaits_[0]->CS(PointAt(pose));
}

bool SingleGaitSearch::IsValid(const PlanarPose& from, const PlanarPose& to) const {
  return gaits_[0]->CS(graph::Edge{PointAt(from), PointAt(to)});
}

FoundPath SingleGaitSearch::Find(actions::PlannerPreset preset, std::uint64_t seed,
                                 double time_limit) const {
  graph::FindPathSettings settings;
  settings.time_limit = time_limit;
  settings.seed = seed;
  settings.max_transitions_per_cycle = scenario_.planner.max_transitions_per_cycle;
  const std::vector<std::shared_ptr<actions::SearchedManoeuvre>> no_manoeuvres;
  if (actions::SwitchesOf(preset).lattice) {
    settings.straight_first = true;
    const double z = scenario_.start.z;
    settings.explorers = {actions::LatticeExploration({&model_, &gaits_, &no_manoeuvres},
                                                      {0, start_, z}, {{0, goal_, z}}),
                          graph::RandomExploration()};
  }
  // The query is set up before the clock starts, as for other planners.
  const graph::Point start = PointAt(start_);
  const std::vector<graph::Point> goals = {PointAt(goal_)};
  const std::vector<std::shared_ptr<const graph::Action>> actions = {gaits_[0]};
  const Stopwatch stopwatch;
  const graph::PathResult result = graph::FindPath(start, goals, actions, *space_, settings);
  FoundPath path;
  path.seconds = stopwatch.Seconds();
  path.found = result.status == graph::PathStatus::kFound;
  if (!path.found) return path;
  path.explorers = result.found_by;
  path.poses.push_back(start_);
  for (const graph::PathEdge& edge : result.path) path.poses.push_back(PoseAt(edge.points.to));
  return path;
}

double LengthOf(const std::vector<PlanarPose>& path) {
  double length = 0;
  for (std::size_t i = 1; i < path.size(); ++i) {
    length += (path[i].position() - path[i - 1].position()).norm();
  }
  return length;
}

}  // namespace possibility::experiments
