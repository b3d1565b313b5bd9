#include "actions/planner.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include "actions/exploration_pose.h"
#include "actions/guarded_manoeuvre.h"
#include "actions/locomotion_model.h"
#include "actions/long_jump.h"
#include "actions/quasi_static_action.h"
#include "actions/route.h"
#include "actions/route_flood.h"
#include "actions/route_motion.h"
#include "actions/route_refinement.h"
#include "actions/route_suggestion.h"
#include "models/ground_map.h"
#include "models/input_error.h"

namespace possibility::actions {
namespace {

class Stopwatch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Whether the same motion may be free of such a violation elsewhere.
bool DependsOnPlace(ViolationKind kind) {
  return kind == ViolationKind::kPenetration || kind == ViolationKind::kContactGround ||
         kind == ViolationKind::kStart || kind == ViolationKind::kGoal;
}

std::string Describe(const models::Stance& stance) {
  return fmt::format("({:.3f}, {:.3f}, {:.3f}) heading {:.1f} deg", stance.x, stance.y, stance.z,
                     stance.yaw * 180 / EIGEN_PI);
}

std::string Describe(const Violation& violation) {
  return fmt::format("its motion does not verify: {}, {}", ToString(violation.kind),
                     violation.quantity);
}

std::vector<std::string> NamesOf(const std::vector<ManoeuvreFactory>& factories) {
  std::vector<std::string> names;
  names.reserve(factories.size());
  for (const ManoeuvreFactory& factory : factories) names.push_back(factory.name);
  return names;
}

/// @throws InputError if a manoeuvre has the name of another action.
void RequireNewNames(const models::RobotModel& robot, const models::Scenario& scenario,
                     const std::vector<ManoeuvreFactory>& manoeuvres) {
  std::vector<std::string> taken = NamesOf(JumpFactories(robot));
  for (const models::Gait& gait : robot.gaits) taken.push_back(gait.name);
  for (const std::string& name : NamesOf(manoeuvres)) {
    if (std::find(taken.begin(), taken.end(), name) != taken.end()) {
      throw InputError(
          fmt::format("{}: actions: a manoeuvre is called '{}', as another action of robot '{}' or "
                      "of this request is already",
                      scenario.file.string(), name, robot.name));
    }
    taken.push_back(name);
  }
}

void FillHeader(const models::RobotModel& robot, const models::Scenario& scenario,
                const PlanRequest& request, Plan* plan) {
  plan->robot_file = robot.file;
  plan->robot_hash = robot.content_hash;
  plan->scenario_file = scenario.file;
  plan->scenario_hash = scenario.content_hash;
  plan->seed = request.seed;
  for (const models::Joint& joint : robot.joints) plan->joints.push_back(joint.name);
}

void SayNo(PlanStatus status, const std::string& explanation, PlanResult* result) {
  result->status = status;
  result->explanation = explanation;
  result->plan.no = NoPlan{ToString(status), explanation, {}};
}

/// One request, from the checked scenario to a verified plan.
class TraversalPlanner {
 public:
  TraversalPlanner(const models::RobotModel& robot, const models::Scenario& scenario,
                   const PlanRequest& request)
      : robot_(robot),
        scenario_(scenario),
        request_(request),
        switches_(SwitchesOf(request.preset)),
        ground_(scenario.environment),
        world_{&scenario_.environment, &ground_},
        factories_(AllFactories()),
        model_(BuildLocomotionModel(
            robot, GaitNames(), [this] { return Remaining() > 0; }, TransitionLibrary())) {
    if (ground_.levels().empty()) {
      throw InputError(
          fmt::format("{}: environment: there is no ground to stand on", scenario_.file.string()));
    }
    space_ = std::make_shared<PelvisPoseSpace>(scenario_.environment.bounds, ground_.levels(),
                                               scenario_.planner.rotation_weight);
    for (size_t gait = 0; gait < model_.gaits.size(); ++gait) {
      actions_.push_back(std::make_shared<QuasiStaticAction>(model_, static_cast<int>(gait), world_,
                                                             space_, scenario_.planner.step));
    }
    PrepareManoeuvres();
    start_ = CheckedStance(scenario_.start, "start");
    for (size_t i = 0; i < scenario_.goals.size(); ++i) {
      goals_.push_back(CheckedStance(scenario_.goals[i], fmt::format("goals[{}]", i)));
    }
    preparation_s_ = clock_.seconds();
  }

  PlanResult Plan() {
    PlanResult result;
    FillHeader(robot_, scenario_, request_, &result.plan);
    result.plan.timings.preparation_s = preparation_s_;
    for (std::uint64_t attempt = 0;; ++attempt) {
      const graph::PathResult path = Explore(attempt);
      result.plan.timings.graph_s += path.seconds;
      for (const graph::ConfirmationReport& job : path.confirmations) {
        result.plan.timings.confirmation_s += job.seconds;
        if (job.outcome != graph::JobOutcome::kFailed) continue;
        failures_[AllActions()[static_cast<size_t>(job.action)]->name()].push_back(
            {job.points, job.reason});
      }
      Record(path, &result);
      if (path.status != graph::PathStatus::kFound) return result;
      try {
        if (Realise(path, &result)) return result;
      } catch (const Abandoned&) {
        result.plan.segments.clear();
        SayNo(PlanStatus::kTimeLimit,
              fmt::format("a route was found in {:.2f} s, but time ran out before its motion was "
                          "verified.",
                          result.plan.timings.graph_s),
              &result);
        return result;
      }
    }
  }

 private:
  /// Those of the robot's file come first.
  std::vector<ManoeuvreFactory> AllFactories() const {
    std::vector<ManoeuvreFactory> factories = JumpFactories(robot_);
    factories.insert(factories.end(), request_.manoeuvres.begin(), request_.manoeuvres.end());
    return factories;
  }

  const std::vector<std::string>& ActionNames() const {
    return request_.actions.empty() ? scenario_.actions : request_.actions;
  }

  std::vector<std::string> GaitNames() const {
    models::CheckActionsOfRobot(ActionNames(), robot_, scenario_.file.string() + ": actions",
                                NamesOf(request_.manoeuvres));
    std::vector<std::string> names;
    for (const std::string& name : ActionNames()) {
      const bool is_gait =
          std::none_of(factories_.begin(), factories_.end(),
                       [&](const ManoeuvreFactory& factory) { return factory.name == name; });
      if (is_gait) names.push_back(name);
    }
    return names;
  }

  void PrepareManoeuvres() {
    PlanningContext context;
    context.model = &model_;
    context.world = world_;
    context.gaits.assign(actions_.begin(), actions_.end());
    context.space = space_;
    context.settings = scenario_.planner;
    context.settings.skip_jumps = switches_.skip_jumps.value_or(scenario_.planner.skip_jumps);
    context.library = request_.library;
    context.solved_motions = switches_.solved_motions;
    context.keep_going = [this] { return Remaining() > 0; };
    const std::string where = scenario_.file.string() + ": actions";
    manoeuvres_ = MakeManoeuvres(factories_, ActionNames(), context, where);
    for (const auto& manoeuvre : manoeuvres_) {
      guarded_.push_back(Guarded(context, manoeuvre, where));
    }
  }

  std::vector<std::shared_ptr<const graph::Action>> AllActions() const {
    std::vector<std::shared_ptr<const graph::Action>> all(actions_.begin(), actions_.end());
    all.insert(all.end(), guarded_.begin(), guarded_.end());
    return all;
  }

  /// Empty: none.
  std::filesystem::path TransitionLibrary() const {
    return switches_.solved_motions ? request_.library : std::filesystem::path();
  }

  double Remaining() const { return request_.time_limit - clock_.seconds(); }

  /// @throws InputError unless C_S holds at the stance.
  GroundedStance CheckedStance(const models::Stance& stance, const std::string& key) const {
    const int gait = model_.GaitIndex(stance.action);
    if (gait < 0) {
      throw InputError(fmt::format("{}: {}.action: '{}' is not among the actions planned with ({})",
                                   scenario_.file.string(), key, stance.action,
                                   fmt::join(ActionNames(), ", ")));
    }
    if (!scenario_.environment.bounds.contains(Eigen::Vector2d(stance.x, stance.y))) {
      throw InputError(fmt::format("{}: {}: {} lies outside environment.bounds",
                                   scenario_.file.string(), key, Describe(stance)));
    }
    const GroundedStance grounded{gait, {stance.x, stance.y, stance.yaw}, stance.z};
    switch (actions_[gait]->Examine(grounded)) {
      case StanceFault::kNone:
        return grounded;
      case StanceFault::kOutOfBounds:
        throw InputError(
            fmt::format("{}: {}: the pelvis of {} at {} lies outside environment.bounds",
                        scenario_.file.string(), key, stance.action, Describe(stance)));
      case StanceFault::kOffGround:
        throw InputError(fmt::format(
            "{}: {}: the {} stance at {} is off the ground; every contact point must be on ground "
            "of height {:.3f}",
            scenario_.file.string(), key, stance.action, Describe(stance), stance.z));
      default:
        throw InputError(fmt::format(
            "{}: {}: the {} stance at {} is in collision with '{}' (the whole swept volume of the "
            "gait must be free there)",
            scenario_.file.string(), key, stance.action, Describe(stance),
            actions_[gait]->FirstBlocker(grounded)));
    }
  }

  graph::Point PointOf(const GroundedStance& stance) const {
    return ToPoint(model_.gaits[stance.gait]->stance.RootPose(stance.pose, stance.z));
  }

  graph::PathResult Explore(std::uint64_t attempt) {
    graph::FindPathSettings settings;
    settings.time_limit = std::max(Remaining(), 0.0);
    settings.seed = request_.seed + attempt * 0x9E3779B97F4A7C15u;
    settings.max_transitions_per_cycle = scenario_.planner.max_transitions_per_cycle;
    settings.confirmation_threads = std::max(0, request_.threads - 1);
    settings.ask_oracle_after = scenario_.planner.flood_after_cycles;
    settings.straight_first = switches_.suggestions;
    if (switches_.suggestions) settings.suggestion = [this] { return Suggestion(); };
    if (switches_.floods) settings.oracle = [this] { return AskFloods(); };
    if (request_.progress) {
      settings.progress = [this](const graph::FindPathProgress& progress) {
        request_.progress({"exploring", progress, 0});
      };
    }
    std::vector<graph::Point> goals;
    for (const GroundedStance& goal : goals_) goals.push_back(PointOf(goal));
    for (const auto& manoeuvre : manoeuvres_) {
      settings.skip_growth[manoeuvre->name()] = manoeuvre->skip_growth();
    }
    return graph::FindPath(PointOf(start_), goals, AllActions(), *space_, settings);
  }

  std::vector<graph::PathEdge> Suggestion() const {
    return SuggestRoute({&model_, &actions_, &guarded_}, start_, goals_,
                        [this] { return Remaining() > 0; });
  }

  graph::RouteOracleAnswer AskFloods() {
    try {
      return AnswerOfFloods();
    } catch (const Abandoned&) {
      return graph::RouteOracleAnswer::kUnknown;
    }
  }

  /// @throws Abandoned at the time limit.
  graph::RouteOracleAnswer AnswerOfFloods() {
    const double resolution = scenario_.planner.flood_resolution;
    const auto keep_going = [this] { return Remaining() > 0; };
    std::optional<std::vector<FloodManoeuvre>> manoeuvres = FloodManoeuvres();
    const bool leads_are_known = manoeuvres.has_value();
    if (leads_are_known) {
      flood_ = FloodCoarseToFine(*manoeuvres);
      if (!flood_->route_may_exist && ReplaceGuesses(keep_going)) {
        manoeuvres = FloodManoeuvres();
        if (!manoeuvres) return graph::RouteOracleAnswer::kUnknown;
        flood_ = FloodCoarseToFine(*manoeuvres);
      }
      if (flood_->route_may_exist) return graph::RouteOracleAnswer::kUnknown;
    }
    const graph::RouteOracleAnswer otherwise =
        leads_are_known ? graph::RouteOracleAnswer::kExhausted : graph::RouteOracleAnswer::kUnknown;
    const std::optional<std::vector<FlightBounds>> flights = Flights();
    if (!flights) return otherwise;
    FloodResult necessary =
        FloodNecessary(model_, world_, start_, goals_, resolution, keep_going, *flights);
    if (necessary.route_may_exist) return otherwise;
    if (flood_) {
      std::move(flood_->barrier.reached.begin(), flood_->barrier.reached.end(),
                std::back_inserter(necessary.barrier.reached));
    }
    flood_ = std::move(necessary);
    return graph::RouteOracleAnswer::kProvenInfeasible;
  }

  /// The flood over C_S; a finer one, as far as it gets, where coarse cells find no barrier.
  FloodResult FloodCoarseToFine(const std::vector<FloodManoeuvre>& manoeuvres) const {
    constexpr int kHalvings = 3;
    constexpr std::int64_t kMostCells = 500000;  // no limit of time: the same answer anywhere
    const double resolution = scenario_.planner.flood_resolution;
    FloodResult coarse = FloodSufficient(
        model_, world_, start_, goals_, resolution, [this] { return Remaining() > 0; }, manoeuvres);
    if (!coarse.route_may_exist) return coarse;
    std::int64_t cells = 0;
    return FloodSufficient(
        model_, world_, start_, goals_, resolution,
        [&] { return ++cells <= kMostCells && Remaining() > 0; }, manoeuvres, kHalvings);
  }

  /// Nothing if some manoeuvre does not say where it leads: then no closed barrier is a proof.
  std::optional<std::vector<FloodManoeuvre>> FloodManoeuvres() const {
    std::vector<FloodManoeuvre> result;
    for (const auto& manoeuvre : manoeuvres_) {
      ManoeuvreBounds bounds = manoeuvre->Bounds();
      if (!bounds.landings) return std::nullopt;
      result.push_back({manoeuvre->from(), manoeuvre->to(), std::move(bounds.landings)});
    }
    return result;
  }

  /// Nothing if some manoeuvre does not say how it flies.
  std::optional<std::vector<FlightBounds>> Flights() const {
    std::vector<FlightBounds> result;
    for (const auto& manoeuvre : manoeuvres_) {
      const std::optional<FlightBounds> flight = manoeuvre->Bounds().flight;
      if (!flight) return std::nullopt;
      result.push_back(*flight);
    }
    return result;
  }

  /// @throws Abandoned at the time limit.
  bool ReplaceGuesses(const std::function<bool()>& keep_going) {
    bool replaced = false;
    for (const auto& manoeuvre : manoeuvres_) {
      replaced = manoeuvre->ReplaceGuesses(keep_going) || replaced;
    }
    return replaced;
  }

  void Record(const graph::PathResult& path, PlanResult* result) const {
    for (const auto& [name, count] : path.counters) result->plan.statistics[name] += count;
    result->plan.statistics["cycles"] = path.statistics.cycles;
    result->plan.statistics["vertices"] = path.statistics.vertices;
    result->plan.statistics["edges"] = path.statistics.edges;
    result->plan.goal = std::max(path.goal, 0);
    ExploredGraph& explored = result->plan.explored;
    explored = {};
    for (const graph::Point& point : path.graph.vertices) {
      explored.vertices.push_back({point.head<3>(), Heading(ToPose(point).linear())});
    }
    const std::vector<std::shared_ptr<const graph::Action>> all = AllActions();
    for (const graph::GraphSnapshot::Edge& edge : path.graph.edges) {
      explored.edges.push_back({edge.from, edge.to, all[edge.action]->name()});
    }
    result->status = StatusOf(path.status);
    if (path.status == graph::PathStatus::kFound) return;
    SayNo(result->status, Explain(*result), result);
    if (result->status != PlanStatus::kTimeLimit) result->plan.no->barrier = flood_->barrier;
  }

  static PlanStatus StatusOf(graph::PathStatus status) {
    switch (status) {
      case graph::PathStatus::kFound:
        return PlanStatus::kFound;
      case graph::PathStatus::kProvenInfeasible:
        return PlanStatus::kProvenInfeasible;
      case graph::PathStatus::kExhausted:
        return PlanStatus::kExhausted;
      case graph::PathStatus::kTimeLimit:
        break;
    }
    return PlanStatus::kTimeLimit;
  }

  std::string Explain(const PlanResult& result) const {
    std::string text = result.status == PlanStatus::kTimeLimit
                           ? fmt::format("no route found within {:.1f} s.", request_.time_limit)
                           : ExplainBarrier(result.status, flood_->barrier);
    if (result.plan.statistics.at("cycles") > 0) {
      text += " Tried:";
      for (const auto& [name, count] : result.plan.statistics) {
        if (count != 0) text += fmt::format(" {} {};", name, count);
      }
      text.back() = '.';
    }
    return text + ExplainManoeuvres();
  }

  static std::string ExplainBarrier(PlanStatus status, const Barrier& barrier) {
    return fmt::format(
        "{}: the search came within {:.2f} m of a goal, at ({:.2f}, {:.2f}); the way on is closed "
        "by {}.",
        status == PlanStatus::kProvenInfeasible
            ? "no route exists within the scenario's bounds, not even for the pelvis alone"
            : "no route exists that these actions could confirm",
        barrier.distance, barrier.closest.x(), barrier.closest.y(),
        barrier.closed_by.empty() ? "the bounds"
                                  : fmt::format("{}", fmt::join(barrier.closed_by, ", ")));
  }

  /// What came of manoeuvres that are no part of the answer.
  std::string ExplainManoeuvres() const {
    std::string text;
    for (const auto& manoeuvre : manoeuvres_) {
      text += Listed(manoeuvre->Refusals(), fmt::format("of '{}' refuted", manoeuvre->name()));
      const auto failures = failures_.find(manoeuvre->name());
      if (failures == failures_.end()) continue;
      text += Listed(failures->second, fmt::format("jobs of '{}' failed", manoeuvre->name()));
    }
    return text;
  }

  /// The first few, and why.
  static std::string Listed(const std::vector<Manoeuvre::Refusal>& refusals,
                            const std::string& what) {
    constexpr size_t kAtMost = 3;
    if (refusals.empty()) return {};
    std::string text = fmt::format(" {} {}:", refusals.size(), what);
    for (size_t i = 0; i < std::min(refusals.size(), kAtMost); ++i) {
      const graph::Point& from = refusals[i].edge.from;
      text += fmt::format("{} from ({:.2f}, {:.2f}): {}", i == 0 ? "" : ";", from.x(), from.y(),
                          refusals[i].reason);
    }
    return text + (refusals.size() > kAtMost ? "; ..." : ".");
  }

  /// Turns a confirmed path into a verified plan. On failure the legs at fault are forbidden.
  /// @throws Abandoned at the time limit.
  bool Realise(const graph::PathResult& path, PlanResult* result) {
    const Stopwatch motion_clock;
    Route route = RouteAlong(model_, manoeuvres_, path.path);
    if (switches_.refinement) {
      route = RefineRoute(model_, route, actions_, [this] { return Remaining() > 0; });
    }
    if (route.empty()) route = {Pause(start_)};
    const bool moved = Generate(route, &result->plan);
    result->plan.timings.motion_s += motion_clock.seconds();
    return moved && IsVerified(route, result);
  }

  bool Generate(const Route& route, actions::Plan* plan) {
    try {
      plan->segments = GenerateMotion(model_, route, request_.threads, [this](double fraction) {
        return KeepGoing("generating motion", fraction);
      });
      return true;
    } catch (const LegError& error) {
      Forbid(route[static_cast<size_t>(error.leg())], error.what());
      plan->statistics["routes refuted by motion generation"]++;
      return false;
    }
  }

  bool IsVerified(const Route& route, PlanResult* result) {
    VerifierSettings settings;
    settings.threads = request_.threads;
    settings.keep_going = [this](double fraction) { return KeepGoing("verifying", fraction); };
    result->verification = Verify(result->plan, robot_, scenario_, settings);
    result->plan.timings.verification_s += result->verification.seconds;
    if (result->verification.abandoned) throw Abandoned();
    if (result->verification.accepted()) {
      result->explanation = ExplainManoeuvres();
      if (!result->explanation.empty()) result->explanation.erase(0, 1);
      return true;
    }
    bool somebody_is_at_fault = false;
    for (const Violation& violation : result->verification.violations) {
      if (violation.segment < 0) continue;
      somebody_is_at_fault = true;
      Forbid(route[static_cast<size_t>(violation.segment)], Describe(violation),
             !DependsOnPlace(violation.kind));
    }
    if (!somebody_is_at_fault) {
      for (const RouteLeg& leg : route) {
        if (leg.manoeuvre != nullptr) {
          Forbid(leg, Describe(result->verification.violations.front()), false);
        }
      }
    }
    result->plan.statistics["routes refuted by verification"]++;
    result->plan.segments.clear();
    return false;
  }

  /// The route of a plan whose start is its goal.
  static RouteLeg Pause(const GroundedStance& stance) {
    RouteLeg leg;
    leg.gait = stance.gait;
    leg.from = leg.to = stance.pose;
    leg.z = leg.z_to = stance.z;
    return leg;
  }

  void Forbid(const RouteLeg& leg, const std::string& reason, bool anywhere = false) {
    const graph::PointPair edge = LegEdge(model_, leg);
    if (leg.manoeuvre != nullptr) return leg.manoeuvre->Forbid(edge, reason, anywhere);
    for (const auto& action : actions_) action->Forbid(edge);
  }

  /// Reports progress, from any thread; false once time is up.
  bool KeepGoing(const std::string& stage, double fraction) const {
    if (request_.progress) {
      const std::lock_guard lock(progress_mutex_);
      request_.progress({stage, {}, fraction});
    }
    return Remaining() > 0;
  }

  const models::RobotModel& robot_;
  const models::Scenario& scenario_;
  const PlanRequest& request_;
  PlannerSwitches switches_;
  Stopwatch clock_;
  models::GroundMap ground_;
  World world_;
  std::vector<ManoeuvreFactory> factories_;
  LocomotionModel model_;
  std::shared_ptr<PelvisPoseSpace> space_;
  std::vector<std::shared_ptr<QuasiStaticAction>> actions_;  ///< by gait
  std::vector<std::shared_ptr<Manoeuvre>> manoeuvres_;
  std::vector<std::shared_ptr<Manoeuvre>> guarded_;  ///< these, for the search
  /// Jobs that failed, by the name of their action.
  std::map<std::string, std::vector<Manoeuvre::Refusal>> failures_;
  GroundedStance start_;
  std::vector<GroundedStance> goals_;
  double preparation_s_ = 0;
  std::optional<FloodResult> flood_;
  mutable std::mutex progress_mutex_;
};

}  // namespace

std::string ToString(PlanStatus status) {
  switch (status) {
    case PlanStatus::kFound:
      return "found";
    case PlanStatus::kProvenInfeasible:
      return "proven_infeasible";
    case PlanStatus::kExhausted:
      return "exhausted";
    case PlanStatus::kTimeLimit:
      return "time_limit";
  }
  return "unknown";
}

PlanResult PlanTraversal(const models::RobotModel& robot, const models::Scenario& scenario,
                         const PlanRequest& request) {
  RequireNewNames(robot, scenario, request.manoeuvres);
  models::CheckScenarioAgainstRobot(scenario, robot, NamesOf(request.manoeuvres));
  try {
    return TraversalPlanner(robot, scenario, request).Plan();
  } catch (const Abandoned&) {
    PlanResult result;
    FillHeader(robot, scenario, request, &result.plan);
    SayNo(PlanStatus::kTimeLimit, "time ran out while the robot's swept volumes were computed.",
          &result);
    return result;
  }
}

}  // namespace possibility::actions
