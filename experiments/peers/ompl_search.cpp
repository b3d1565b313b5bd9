#include "experiments/peers/ompl_search.h"

#include <ompl/base/MotionValidator.h>
#include <ompl/base/PlannerTerminationCondition.h>
#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/ScopedState.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/objectives/PathLengthOptimizationObjective.h>
#include <ompl/base/spaces/SE2StateSpace.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/est/BiEST.h>
#include <ompl/geometric/planners/est/EST.h>
#include <ompl/geometric/planners/informedtrees/ABITstar.h>
#include <ompl/geometric/planners/informedtrees/AITstar.h>
#include <ompl/geometric/planners/informedtrees/BITstar.h>
#include <ompl/geometric/planners/kpiece/KPIECE1.h>
#include <ompl/geometric/planners/kpiece/LBKPIECE1.h>
#include <ompl/geometric/planners/prm/LazyPRM.h>
#include <ompl/geometric/planners/prm/PRM.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include <map>
#include <memory>
#include <stdexcept>
#include <utility>

#include "common/stopwatch.h"

namespace possibility::experiments {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;

using Space = ob::SE2StateSpace;

PeerPose ToPose(const ob::State* state) {
  const auto* pose = state->as<Space::StateType>();
  return {pose->getX(), pose->getY(), pose->getYaw()};
}

class Motions : public ob::MotionValidator {
 public:
  Motions(const ob::SpaceInformationPtr& information, const PlanarQuery& query)
      : ob::MotionValidator(information), query_(query) {}

  bool checkMotion(const ob::State* from, const ob::State* to) const override {
    return query_.motion_is_valid(ToPose(from), ToPose(to));
  }

  /// Finds the valid part of an invalid motion by bisection.
  bool checkMotion(const ob::State* from, const ob::State* to,
                   std::pair<ob::State*, double>& last_valid) const override {
    if (checkMotion(from, to)) return true;
    ob::State* part = si_->allocState();
    last_valid.second = 0;
    for (const double fraction : {0.5, 0.25}) {
      si_->getStateSpace()->interpolate(from, to, fraction, part);
      if (checkMotion(from, part)) {
        last_valid.second = fraction;
        break;
      }
    }
    if (last_valid.first != nullptr) {
      si_->copyState(last_valid.first, last_valid.second > 0 ? part : from);
    }
    si_->freeState(part);
    return false;
  }

 private:
  const PlanarQuery& query_;
};

ob::SpaceInformationPtr MakeSpace(const PlanarQuery& query) {
  const auto space = std::make_shared<Space>();
  ob::RealVectorBounds bounds(2);
  for (unsigned i = 0; i < 2; ++i) {
    bounds.setLow(i, query.low[i]);
    bounds.setHigh(i, query.high[i]);
  }
  space->setBounds(bounds);
  space->setSubspaceWeight(0, 1 - query.rotation_weight);
  space->setSubspaceWeight(1, query.rotation_weight);
  const auto information = std::make_shared<ob::SpaceInformation>(space);
  information->setStateValidityChecker(
      [&query](const ob::State* state) { return query.pose_is_valid(ToPose(state)); });
  information->setMotionValidator(std::make_shared<Motions>(information, query));
  information->setup();
  return information;
}

ob::ProblemDefinitionPtr MakeProblem(const ob::SpaceInformationPtr& information,
                                     const PlanarQuery& query) {
  const auto state = [&](const PeerPose& pose) {
    ob::ScopedState<Space> scoped(information->getStateSpace());
    scoped->setXY(pose.x, pose.y);
    scoped->setYaw(pose.yaw);
    information->enforceBounds(scoped.get());
    return scoped;
  };
  const auto problem = std::make_shared<ob::ProblemDefinition>(information);
  problem->setStartAndGoalStates(ob::ScopedState<>(state(query.start)),
                                 ob::ScopedState<>(state(query.goal)));
  // The first solution ends the search, also for planners that would improve it.
  const auto length = std::make_shared<ob::PathLengthOptimizationObjective>(information);
  length->setCostThreshold(length->infiniteCost());
  problem->setOptimizationObjective(length);
  return problem;
}

using Maker = std::function<ob::PlannerPtr(const ob::SpaceInformationPtr&)>;

template <typename Planner>
Maker Make() {
  return [](const ob::SpaceInformationPtr& information) {
    return std::make_shared<Planner>(information);
  };
}

const std::map<std::string, Maker>& Makers() {
  static const std::map<std::string, Maker> makers = {
      {"RRTConnect", Make<og::RRTConnect>()}, {"PRM", Make<og::PRM>()},
      {"LazyPRM", Make<og::LazyPRM>()},       {"KPIECE1", Make<og::KPIECE1>()},
      {"LBKPIECE1", Make<og::LBKPIECE1>()},   {"EST", Make<og::EST>()},
      {"BiEST", Make<og::BiEST>()},           {"BITstar", Make<og::BITstar>()},
      {"ABITstar", Make<og::ABITstar>()},     {"AITstar", Make<og::AITstar>()}};
  return makers;
}

/// Seeds all generators created from now on. (OMPL logs a warning that earlier ones keep their
/// seeds: none of them outlives its search.)
void SeedGenerators(std::uint32_t seed) {
  ompl::msg::noOutputHandler();
  ompl::RNG::setSeed(seed + 1);  // 0 is refused
}

std::vector<PeerPose> PathOf(const ob::ProblemDefinition& problem) {
  std::vector<PeerPose> poses;
  for (const ob::State* state : problem.getSolutionPath()->as<og::PathGeometric>()->getStates()) {
    poses.push_back(ToPose(state));
  }
  return poses;
}

}  // namespace

const std::vector<std::string>& OmplPlanners() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const auto& [name, maker] : Makers()) all.push_back(name);
    return all;
  }();
  return names;
}

PeerSearch SolveWithOmpl(const std::string& planner, const PlanarQuery& query, std::uint32_t seed,
                         double time_limit, double range) {
  const auto maker = Makers().find(planner);
  if (maker == Makers().end()) {
    throw std::invalid_argument("SolveWithOmpl: no planner is called " + planner);
  }
  SeedGenerators(seed);
  const ob::SpaceInformationPtr information = MakeSpace(query);
  const ob::ProblemDefinitionPtr problem = MakeProblem(information, query);
  const ob::PlannerPtr solver = maker->second(information);
  if (range > 0 && solver->params().hasParam("range")) {
    solver->params().setParam("range", std::to_string(range));
  }
  solver->setProblemDefinition(problem);
  solver->setup();
  const ob::PlannerTerminationCondition end =
      ob::plannerOrTerminationCondition(ob::timedPlannerTerminationCondition(time_limit),
                                        ob::exactSolnPlannerTerminationCondition(problem));
  PeerSearch search;
  const Stopwatch stopwatch;
  search.found = solver->solve(end) == ob::PlannerStatus::EXACT_SOLUTION;
  search.seconds = stopwatch.Seconds();
  if (search.found) search.path = PathOf(*problem);
  return search;
}

}  // namespace possibility::experiments
