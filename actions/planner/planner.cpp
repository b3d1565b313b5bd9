#include "actions/planner/planner.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <mutex>
#include <optional>

#include "actions/checks/structure_check.h"
#include "actions/conditions/exploration_pose.h"
#include "actions/conditions/locomotion_model.h"
#include "actions/conditions/quasi_static_action.h"
#include "actions/conditions/searched_manoeuvre.h"
#include "actions/crossing/step_over.h"
#include "actions/flood/flood_oracle.h"
#include "actions/footsteps/planned_steps.h"
#include "actions/jump/long_jump.h"
#include "actions/motion/motion_schedule.h"
#include "actions/plan/plan_rounding.h"
#include "actions/planner/least_duration.h"
#include "actions/planner/passage_explanation.h"
#include "actions/planner/plan_explanation.h"
#include "actions/planner/planner_memory.h"
#include "actions/planner/request_checks.h"
#include "actions/planner/route_improvement.h"
#include "actions/planner/route_refusals.h"
#include "actions/refinement/plan_refinement.h"
#include "actions/route/footstep_explorer.h"
#include "actions/route/island_explorer.h"
#include "actions/route/lattice_explorer.h"
#include "actions/route/route.h"
#include "actions/route/route_motion.h"
#include "actions/route/shortcut_explorer.h"
#include "actions/route/step_shortcut_explorer.h"
#include "common/cancellation_token.h"
#include "common/deadline.h"
#include "common/stopwatch.h"
#include "graph/search/random_explorer.h"
#include "models/input/input_error.h"
#include "models/world/ground_map.h"

namespace possibility::actions {
namespace {

/// Minimum time allowed for motion and verification after the time limit, s.
constexpr double kLeastToFinish = 10;

/// Gain in duration that is worth another plan, s.
constexpr double kLeastGain = 1e-3;
/// Time for one random exploration of another route, s.
constexpr double kElsewhere = 2;

/// Whether the same motion may be free of this violation elsewhere.
bool DependsOnPlace(ViolationKind kind) {
  return kind == ViolationKind::kPenetration || kind == ViolationKind::kContactGround ||
         kind == ViolationKind::kStart || kind == ViolationKind::kGoal ||
         kind == ViolationKind::kBounds;
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

PlannerSwitches SwitchesOf(const PlanRequest& request) {
  const PlannerSwitches switches = SwitchesOf(request.preset);
  return request.explorers.empty() ? switches
                                   : WithExplorers(switches, request.explorers, "explorers");
}

/// Rounded to a micrometre: the explored graph is for viewing, and large.
ExploredGraph::Vertex ExploredVertex(const graph::Point& point) {
  const auto rounded = [](double x) { return std::round(1e6 * x) / 1e6; };
  return {point.head<3>().unaryExpr(rounded), rounded(Heading(ToPose(point).linear()))};
}

/// One request, from the checked scenario to a verified plan.
class TraversalPlanner {
 public:
  TraversalPlanner(const models::RobotModel& robot, const models::Scenario& scenario,
                   const PlanRequest& request)
      : robot_(robot),
        scenario_(scenario),
        request_(request),
        switches_(SwitchesOf(request)),
        deadline_(request.time_limit),
        last_deadline_(request.time_limit + std::max(request.time_limit, kLeastToFinish)),
        ground_(scenario.environment, robot.friction),
        world_{&scenario_.environment, &ground_},
        factories_(AllFactories()),
        shared_model_(MakeModel()),
        model_(*shared_model_),
        floods_(model_, world_, manoeuvres_, scenario.planner.flood_resolution, Until(deadline_)) {
    if (ground_.levels().empty()) {
      throw InputError(fmt::format("{}: environment: there is no level ground to stand on",
                                   scenario_.file.string()));
    }
    space_ = std::make_shared<PelvisPoseSpace>(scenario_.environment.bounds, ground_.levels(),
                                               scenario_.planner.rotation_weight);
    for (size_t gait = 0; gait < model_.gaits.size(); ++gait) {
      gaits_.push_back(std::make_shared<QuasiStaticAction>(model_, static_cast<int>(gait), world_,
                                                           space_, scenario_.planner.step));
    }
    PrepareManoeuvres();
    const auto checked = [this](const models::Stance& stance, const std::string& key) {
      return CheckedStance(stance, key, scenario_, model_, gaits_, ActionNames());
    };
    start_ = checked(scenario_.start, "start");
    for (size_t i = 0; i < scenario_.goals.size(); ++i) {
      goals_.push_back(checked(scenario_.goals[i], fmt::format("goals[{}]", i)));
    }
    preparation_s_ = deadline_.Elapsed();
  }

  PlanResult Plan() {
    PlanResult result;
    FillHeader(robot_, scenario_, request_, &result.plan);
    result.plan.timings.preparation_s = preparation_s_;
    for (std::uint64_t attempt = 0;; ++attempt) {
      const graph::PathResult path = FindRoute(attempt);
      const bool found = path.status == graph::PathStatus::kFound;
      const double first_s = found ? path.first_path_seconds : path.seconds;
      result.plan.timings.graph_s += first_s;
      result.plan.timings.motion_s += path.seconds - first_s;
      for (const graph::ConfirmationReport& job : path.confirmations) {
        result.plan.timings.confirmation_s += job.seconds;
        if (job.outcome != graph::JobOutcome::kFailed) continue;
        failures_[AllActions()[static_cast<size_t>(job.action)]->name()].push_back(
            {job.points, job.reason});
      }
      Record(path, &result);
      if (path.status != graph::PathStatus::kFound) return result;
      try {
        if (Realise(path, &result)) {
          if (request_.improved) Improve(path, &result);
          return result;
        }
      } catch (const Cancelled&) {
        request_.cancellation.ThrowIfCancelled();
        DropMotion(&result.plan);
        SayNo(PlanStatus::kTimeLimit,
              fmt::format("a route was found in {:.2f} s, but time ran out before its motion was "
                          "verified.",
                          result.plan.timings.graph_s) +
                  refusals_.Explain() + ExplainManoeuvres(all_manoeuvres_, failures_),
              &result);
        return result;
      }
    }
  }

 private:
  /// Cancels at the deadline, or when the request does.
  CancellationToken Until(const Deadline& deadline) const {
    return CancellationToken([deadline, cancellation = request_.cancellation] {
      return !deadline.Passed() && cancellation.Proceed();
    });
  }

  /// The factories of the robot's file come first.
  std::vector<ManoeuvreFactory> AllFactories() const {
    std::vector<ManoeuvreFactory> factories =
        JumpFactories(robot_, switches_.skip_jumps.value_or(scenario_.planner.skip_jumps));
    factories.insert(factories.end(), request_.manoeuvres.begin(), request_.manoeuvres.end());
    return factories;
  }

  const std::vector<std::string>& ActionNames() const {
    return request_.actions.empty() ? scenario_.actions : request_.actions;
  }

  bool IsInUse(const ManoeuvreFactory& factory) const {
    const std::vector<std::string>& names = ActionNames();
    return std::find(names.begin(), names.end(), factory.name) != names.end();
  }

  std::vector<std::string> GaitNames() const {
    models::CheckActionsOfRobot(ActionNames(), robot_, scenario_.file.string() + ": actions",
                                FurtherNames(request_.gaits, request_.manoeuvres));
    std::vector<std::string> names;
    for (const std::string& name : ActionNames()) {
      const bool is_gait =
          std::none_of(factories_.begin(), factories_.end(),
                       [&](const ManoeuvreFactory& factory) { return factory.name == name; });
      if (is_gait) names.push_back(name);
    }
    return names;
  }

  /// Gaits of the request are functions, which cannot be compared with those of another request.
  std::shared_ptr<const LocomotionModel> MakeModel() const {
    const CancellationToken cancellation = Until(deadline_);
    if (request_.memory && request_.gaits.empty()) {
      return request_.memory->ModelOf(robot_, GaitNames(), cancellation, TransitionLibrary(),
                                      request_.threads);
    }
    return std::make_shared<const LocomotionModel>(BuildLocomotionModel(
        robot_, GaitNames(), cancellation, TransitionLibrary(), request_.gaits, request_.threads));
  }

  void PrepareManoeuvres() {
    PlanningContext context;
    context.model = &model_;
    context.world = world_;
    context.gaits.assign(gaits_.begin(), gaits_.end());
    context.space = space_;
    context.settings = scenario_.planner;
    context.library = request_.library;
    context.solved_motions = switches_.solved_motions;
    context.cancellation = Until(deadline_);
    const std::string where = scenario_.file.string() + ": actions";
    manoeuvres_ = MakeManoeuvres(factories_, ActionNames(), context, where);
    for (const auto& manoeuvre : manoeuvres_) {
      searched_.push_back(std::make_shared<SearchedManoeuvre>(manoeuvre, where));
    }
    PrepareSteps(context, where);
  }

  std::vector<std::shared_ptr<const graph::Action>> AllActions() const {
    std::vector<std::shared_ptr<const graph::Action>> all(gaits_.begin(), gaits_.end());
    all.insert(all.end(), all_manoeuvres_.begin(), all_manoeuvres_.end());
    return all;
  }

  /// The name under which a plan has the motion of an action.
  std::string PlanActionOf(int action) const {
    const std::size_t index = static_cast<std::size_t>(action);
    return index < gaits_.size() ? gaits_[index]->name()
                                 : all_manoeuvres_[index - gaits_.size()]->plan_action();
  }

  /// Steps of the start's gait, or of the first gait whose steps can be planned.
  void PrepareSteps(const PlanningContext& context, const std::string& where) {
    all_manoeuvres_ = searched_;
    if (!switches_.footsteps || !switches_.floods) return;
    const auto knows = [this](int gait) {
      return gait >= 0 && FootstepSearch::Knows(model_.gaits[gait]->gait);
    };
    int gait = model_.GaitIndex(scenario_.start.action);
    for (int other = 0; !knows(gait) && other < static_cast<int>(model_.gaits.size()); ++other) {
      gait = other;
    }
    if (!knows(gait)) return;
    steps_ = std::make_shared<PlannedSteps>(context, gait);
    all_manoeuvres_.push_back(std::make_shared<SearchedManoeuvre>(steps_, where));
  }

  std::vector<GroundedStance> GoalsOfSteps() const {
    std::vector<GroundedStance> goals;
    for (const GroundedStance& goal : goals_) {
      if (goal.gait == steps_->from()) goals.push_back(goal);
    }
    return goals;
  }

  /// Whether steps alone may lead from the start to a goal.
  bool StepsMayDo() const { return start_.gait == steps_->from() && !GoalsOfSteps().empty(); }
  bool StepsMayHelp() const { return steps_ && (StepsMayDo() || IsMixed()); }
  /// Whether there is anything else that steps can be joined with.
  bool IsMixed() const { return gaits_.size() > 1 || !searched_.empty(); }

  /// First through C_S and manoeuvres. Where the floods find no route there, or cannot tell,
  /// contacts are planned as well: beside manoeuvres in the same search, otherwise in a search of
  /// their own. If that leads nowhere either, the search goes on as long as the floods leave it
  /// open.
  graph::PathResult FindRoute(std::uint64_t attempt) {
    const bool nobody_else_explores =
        !switches_.straight && !switches_.lattice && !switches_.random;
    if (StepsMayHelp() && nobody_else_explores) {
      AskFloods();
      needs_steps_ = *oracle_answer_ != graph::RouteOracleAnswer::kProvenInfeasible;
    }
    if (!needs_steps_) {
      ends_at_oracle_ = StepsMayHelp();
      graph::PathResult path = Explore(attempt);
      ends_at_oracle_ = false;
      if (path.status == graph::PathStatus::kFound || !needs_steps_) return path;
    }
    graph::PathResult path = ExploreSteps(attempt);
    if (path.status == graph::PathStatus::kFound) return path;
    const bool is_open = *oracle_answer_ == graph::RouteOracleAnswer::kUnknown;
    if (is_open && !deadline_.Passed()) return Explore(attempt);
    path.status = is_open ? graph::PathStatus::kTimeLimit : graph::PathStatus::kExhausted;
    return path;
  }

  graph::RouteOracleAnswer AskFloods() {
    if (!oracle_answer_) {
      oracle_answer_ = floods_.Ask(start_, goals_);
      GuideExploration();
    }
    // A manoeuvre may still be found where the floods cannot tell.
    const bool is_open =
        *oracle_answer_ == graph::RouteOracleAnswer::kUnknown && !manoeuvres_.empty();
    steps_are_called_ = is_open;
    if (!ends_at_oracle_ || is_open ||
        *oracle_answer_ == graph::RouteOracleAnswer::kProvenInfeasible) {
      return *oracle_answer_;
    }
    needs_steps_ = true;
    return graph::RouteOracleAnswer::kExhausted;  // of this search
  }

  /// The way that the floods consider open shows random exploration where to go.
  void GuideExploration() {
    std::vector<graph::Point> samples;
    for (const GroundedStance& stance : floods_.way()) {
      samples.push_back(ToPoint(stance.pose.At(stance.z + 1)));
    }
    space_->Guide(std::move(samples), scenario_.planner.flood_resolution);
  }

  graph::PathResult ExploreSteps(std::uint64_t attempt) {
    graph::FindPathSettings settings = SearchSettings(attempt);
    if (switches_.shortcuts) settings.explorers = {ShortcutExploration(AllSpace(), goals_)};
    AddStepExplorers(&settings);
    steps_are_called_ = true;
    return graph::FindPath(PointOf(start_), GoalPoints(), AllActions(), *space_, settings);
  }

  RouteSpace AllSpace() const { return {&model_, &gaits_, &all_manoeuvres_}; }

  void AddStepExplorers(graph::FindPathSettings* settings) {
    steps_gave_up_ = !StepsMayDo();
    const int action = static_cast<int>(gaits_.size() + all_manoeuvres_.size()) - 1;
    if (StepsMayDo()) {
      settings->explorers.push_back(FootstepExploration(AllSpace(), *steps_, action, start_,
                                                        GoalsOfSteps(), &steps_are_called_,
                                                        &steps_gave_up_));
    }
    if (!IsMixed()) return;
    settings->explorers.push_back(
        StepShortcutExploration(AllSpace(), *steps_, action, &steps_are_called_));
    settings->explorers.push_back(IslandExploration({&model_, &gaits_, &searched_}, *steps_, action,
                                                    start_, goals_, &steps_are_called_,
                                                    &steps_gave_up_));
  }

  /// Empty: none.
  std::filesystem::path TransitionLibrary() const {
    return switches_.solved_motions ? request_.library : std::filesystem::path();
  }

  graph::Point PointOf(const GroundedStance& stance) const {
    return ToPoint(model_.gaits[stance.gait]->stance.RootPose(stance.pose, stance.z));
  }

  graph::PathResult Explore(std::uint64_t attempt) {
    graph::FindPathSettings settings = SearchSettings(attempt);
    settings.straight_first = switches_.straight;
    settings.explorers = Explorers();
    if (switches_.floods) settings.oracle = [this] { return AskFloods(); };
    if (StepsMayHelp()) settings.turns_after_oracle = scenario_.planner.turns_after_floods;
    for (const ManoeuvreFactory& factory : factories_) {
      if (IsInUse(factory)) settings.skip_growth[factory.name] = factory.skip_growth;
    }
    std::vector<std::shared_ptr<const graph::Action>> actions(gaits_.begin(), gaits_.end());
    actions.insert(actions.end(), searched_.begin(), searched_.end());
    if (ends_at_oracle_ && !manoeuvres_.empty()) {
      // Before random exploration, whose turns may be slow.
      std::vector<graph::ExplorerFactory> others = std::move(settings.explorers);
      const auto first_random = others.end() - (switches_.random ? 1 : 0);
      settings.explorers.assign(others.begin(), first_random);
      AddStepExplorers(&settings);
      settings.explorers.insert(settings.explorers.end(), first_random, others.end());
      actions = AllActions();
      settings.skip_growth[actions.back()->name()] = 1;  // random exploration knows no steps
    }
    return graph::FindPath(PointOf(start_), GoalPoints(), actions, *space_, settings);
  }

  /// What searches have in common.
  graph::FindPathSettings SearchSettings(std::uint64_t attempt) const {
    graph::FindPathSettings settings;
    settings.time_limit = deadline_.Remaining();
    settings.seed = request_.seed + attempt * 0x9E3779B97F4A7C15u;
    settings.max_transitions_per_cycle = scenario_.planner.max_transitions_per_cycle;
    settings.confirmation_threads = std::max(0, request_.threads - 1);
    settings.ask_oracle_after = scenario_.planner.flood_after_cycles;
    if (switches_.improvement) settings.improvement_share = scenario_.planner.improvement_share;
    // Called on this thread: an exception ends the search.
    settings.progress = [this](const graph::FindPathProgress& progress) {
      request_.cancellation.ThrowIfCancelled();
      if (request_.progress) request_.progress({"exploring", progress, 0});
    };
    return settings;
  }

  std::vector<graph::Point> GoalPoints() const {
    std::vector<graph::Point> goals;
    for (const GroundedStance& goal : goals_) goals.push_back(PointOf(goal));
    return goals;
  }

  /// The explorer that answers fastest comes first.
  std::vector<graph::ExplorerFactory> Explorers() const {
    const RouteSpace space{&model_, &gaits_, &searched_};
    std::vector<graph::ExplorerFactory> explorers;
    // Routes to shorten may hold planned steps.
    if (switches_.shortcuts) explorers.push_back(ShortcutExploration(AllSpace(), goals_));
    if (switches_.lattice) explorers.push_back(LatticeExploration(space, start_, goals_));
    if (switches_.random) explorers.push_back(graph::RandomExploration());
    // An empty list would select the paper's explorer. Shortcuts take no part in the search for a
    // first route.
    if (explorers.empty()) explorers.push_back(ShortcutExploration(AllSpace(), goals_));
    return explorers;
  }

  void Record(const graph::PathResult& path, PlanResult* result) {
    for (const auto& [name, count] : path.counters) result->plan.statistics[name] += count;
    result->plan.statistics["cycles"] = path.statistics.cycles;
    result->plan.statistics["vertices"] = path.statistics.vertices;
    result->plan.statistics["edges"] = path.statistics.edges;
    result->plan.goal = std::max(path.goal, 0);
    ExploredGraph& explored = result->plan.explored;
    explored = {};
    for (const graph::Point& point : path.graph.vertices) {
      explored.vertices.push_back(ExploredVertex(point));
    }
    for (const graph::GraphSnapshot::Edge& edge : path.graph.edges) {
      explored.edges.push_back({edge.from, edge.to, PlanActionOf(edge.action)});
    }
    result->status = StatusOf(path.status);
    if (path.status == graph::PathStatus::kFound) {
      result->plan.search = ReportOf(path);
      return;
    }
    SayNo(result->status, Explain(*result), result);
    result->plan.no->passage = floods_.passage();
    if (result->status != PlanStatus::kTimeLimit && floods_.has_barrier()) {
      result->plan.no->barrier = floods_.barrier();
    }
  }

  /// Edges of a gait begin and end in motion. A route of them begins and ends at rest.
  SearchReport ReportOf(const graph::PathResult& path) const {
    SearchReport report{path.found_by, path.first_duration, path.duration, path.lower_bound};
    const Route route = RouteAlong(model_, all_manoeuvres_, path.path);
    if (route.empty()) return report;
    const double rest_time = RestTime(route.front()) + RestTime(route.back());
    report.first_duration += rest_time;
    report.duration += rest_time;
    return report;
  }

  /// Of a leg's gait, s. Transitions and manoeuvres include theirs.
  double RestTime(const RouteLeg& leg) const {
    const bool is_way = leg.manoeuvre == nullptr && leg.transition < 0;
    return is_way ? model_.gaits[leg.gait]->motion->RestTime() : 0;
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

  std::string Explain(const PlanResult& result) {
    const std::string why =
        result.status == PlanStatus::kTimeLimit
            ? fmt::format("no route that can be executed was found within {:.1f} s.",
                          request_.time_limit) +
                  ExplainClosest(result.plan.explored, scenario_.goals)
        : floods_.has_barrier() ? ExplainBarrier(result.status, floods_.barrier())
                                : ExplainEffort(scenario_.planner.turns_after_floods) +
                                      ExplainClosest(result.plan.explored, scenario_.goals);
    return why + ExplainPassage(floods_.has_barrier(), floods_.passage()) + refusals_.Explain() +
           ExplainSearch(result.plan.statistics) + ExplainManoeuvres(all_manoeuvres_, failures_);
  }

  /// Turns a confirmed path into a verified plan. On failure it forbids the legs at fault.
  /// @throws Cancelled at the time limit.
  bool Realise(const graph::PathResult& path, PlanResult* result) {
    const Stopwatch motion_clock;
    Route route = RouteAlong(model_, all_manoeuvres_, path.path);
    if (route.empty()) route = {Pause(start_)};
    const bool moved = Generate(route, &result->plan);
    result->plan.timings.motion_s += motion_clock.Seconds();
    if (moved) {
      NameVertices(path, &result->plan);
      AddSchedule(&result->plan);
    }
    return moved && IsVerified(route, result);
  }

  /// PlanRequest::improved. Routes are changed at random, and now and then another is explored.
  void Improve(const graph::PathResult& path, PlanResult* best) {
    best->least_duration =
        LeastDuration({model_, world_, manoeuvres_, steps_.get(), scenario_.planner}, start_,
                      goals_, Until(deadline_));
    request_.improved(*best);
    is_improving_ = true;
    RouteImprovement improvement(AllSpace(), RouteAlong(model_, all_manoeuvres_, path.path),
                                 request_.seed,
                                 [this](std::uint64_t round) { return ExploreElsewhere(round); });
    try {
      while (best->plan.duration() > best->least_duration && !deadline_.Passed()) {
        const std::optional<Route> route = improvement.Next(Until(deadline_));
        if (!route) break;
        PlanResult quicker = *best;
        quicker.plan.timings.motion_s = quicker.plan.timings.verification_s = 0;
        if (!RealiseQuicker(*route, best->plan.duration(), &quicker)) continue;
        improvement.Accept(*route);
        *best = std::move(quicker);
        request_.improved(*best);
      }
    } catch (const Cancelled&) {
      request_.cancellation.ThrowIfCancelled();  // otherwise time is up
    }
  }

  /// Whether the route leads to a verified plan shorter than `duration` (s).
  bool RealiseQuicker(const Route& route, double duration, PlanResult* result) {
    const Stopwatch motion_clock;
    if (!Generate(route, &result->plan)) return false;
    result->plan.timings.motion_s = motion_clock.Seconds();
    if (!(result->plan.duration() < duration - kLeastGain)) return false;
    AddSchedule(&result->plan);
    if (!IsVerified(route, result)) return false;
    result->plan.search->duration = ExpectedDuration(model_, route);
    return true;
  }

  /// The route that random exploration alone finds in a short time; empty if none.
  Route ExploreElsewhere(std::uint64_t round) {
    graph::FindPathSettings settings = SearchSettings(round);
    settings.time_limit = std::min(settings.time_limit, kElsewhere);
    settings.improvement_share = 0;
    settings.explorers = {graph::RandomExploration()};
    std::vector<std::shared_ptr<const graph::Action>> actions(gaits_.begin(), gaits_.end());
    actions.insert(actions.end(), searched_.begin(), searched_.end());
    const graph::PathResult path =
        graph::FindPath(PointOf(start_), GoalPoints(), actions, *space_, settings);
    if (path.status != graph::PathStatus::kFound) return {};
    return RouteAlong(model_, all_manoeuvres_, path.path);
  }

  /// Of motion and verification.
  CancellationToken UntilTheEnd() const {
    return Until(is_improving_ ? deadline_ : last_deadline_);
  }

  /// Motion of other programs may be malformed. It gets no schedule, and the verifier rejects it.
  void AddSchedule(actions::Plan* plan) const {
    ViolationLog log;
    if (CheckStructure(*plan, robot_, &log)) {
      plan->schedule = ScheduleOfMotion(robot_, plan->segments);
    }
  }

  static void DropMotion(actions::Plan* plan) {
    plan->segments.clear();
    plan->schedule.reset();
  }

  /// A pause is not an edge of the graph.
  static void NameVertices(const graph::PathResult& path, actions::Plan* plan) {
    for (size_t i = 0; i < path.path.size(); ++i) {
      plan->segments[i].vertices = {path.path[i].from, path.path[i].to};
    }
  }

  /// What is verified is what will be written.
  void RoundToFile(actions::Plan* plan) const {
    if (request_.plan_version == 2) {
      *plan = RefinedPlan(*plan, robot_);
    } else {
      RoundToPlanDigits(plan);
    }
  }

  bool Generate(const Route& route, actions::Plan* plan) {
    try {
      plan->segments =
          GenerateMotion(model_, scenario_.environment, route, request_.threads, UntilTheEnd(),
                         [this](double fraction) { Report("generating motion", fraction); });
      RoundToFile(plan);
      return true;
    } catch (const LegError& error) {
      const RouteLeg& leg = route[static_cast<size_t>(error.leg())];
      refusals_.ByMotion(LegWords(model_, leg), error.what());
      Forbid(leg, error.what());
      plan->statistics["routes refuted by motion generation"]++;
      return false;
    }
  }

  bool IsVerified(const Route& route, PlanResult* result) {
    VerifierSettings settings;
    settings.threads = request_.threads;
    settings.cancellation = UntilTheEnd();
    if (request_.memory) settings.store = &request_.memory->verdicts();
    settings.progress = [this](double fraction) { Report("verifying", fraction); };
    result->verification = Verify(result->plan, robot_, scenario_, settings);
    result->plan.timings.verification_s += result->verification.seconds;
    if (!result->verification.accepted()) {
      std::vector<std::string> legs;
      for (const RouteLeg& leg : route) legs.push_back(LegWords(model_, leg));
      refusals_.ByVerification(result->verification, legs);
    }
    if (result->verification.cancelled) throw Cancelled();
    if (result->verification.accepted()) {
      result->explanation = refusals_.Explain() + ExplainManoeuvres(all_manoeuvres_, failures_);
      if (!result->explanation.empty()) result->explanation.erase(0, 1);
      return true;
    }
    bool somebody_is_at_fault = false;
    for (const Violation& violation : result->verification.violations) {
      if (violation.segment < 0) continue;
      somebody_is_at_fault = true;
      Forbid(route[static_cast<size_t>(violation.segment)],
             "its motion does not verify: " + Describe(violation), !DependsOnPlace(violation.kind));
    }
    if (!somebody_is_at_fault) {
      for (const RouteLeg& leg : route) {
        if (leg.manoeuvre != nullptr) {
          Forbid(leg,
                 "its motion does not verify: " + Describe(result->verification.violations.front()),
                 false);
        }
      }
    }
    result->plan.statistics["routes refuted by verification"]++;
    DropMotion(&result->plan);
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

  void Forbid(const RouteLeg& leg, const std::string& reason, bool everywhere = false) {
    const graph::Edge edge = LegEdge(model_, leg);
    if (leg.manoeuvre != nullptr) return leg.manoeuvre->Forbid(edge, reason, everywhere);
    if (leg.transition < 0) return gaits_[static_cast<size_t>(leg.gait)]->Forbid(edge);
    for (const auto& action : gaits_) action->Forbid(edge);
  }

  /// From any thread.
  void Report(const std::string& stage, double fraction) const {
    if (!request_.progress) return;
    const std::lock_guard lock(progress_mutex_);
    request_.progress({stage, {}, fraction});
  }

  const models::RobotModel& robot_;
  const models::Scenario& scenario_;
  const PlanRequest& request_;
  PlannerSwitches switches_;
  Deadline deadline_;  ///< of the search
  /// Motion and verification of a route found in time may take the time limit again (at least
  /// kLeastToFinish).
  Deadline last_deadline_;
  models::GroundMap ground_;
  World world_;
  std::vector<ManoeuvreFactory> factories_;
  std::shared_ptr<const LocomotionModel> shared_model_;
  const LocomotionModel& model_;
  std::shared_ptr<PelvisPoseSpace> space_;
  std::vector<std::shared_ptr<QuasiStaticAction>> gaits_;  ///< by gait
  std::vector<std::shared_ptr<Manoeuvre>> manoeuvres_;
  std::vector<std::shared_ptr<SearchedManoeuvre>> searched_;        ///< the same, with verdicts
  std::shared_ptr<PlannedSteps> steps_;                             ///< null: none can be planned
  std::vector<std::shared_ptr<SearchedManoeuvre>> all_manoeuvres_;  ///< searched, then steps
  bool ends_at_oracle_ = false;    ///< the search under way ends where the floods find no route
  bool needs_steps_ = false;       ///< the floods found no route
  bool steps_gave_up_ = false;     ///< steps alone lead nowhere
  bool steps_are_called_ = false;  ///< explorers of steps take part
  std::optional<graph::RouteOracleAnswer> oracle_answer_;
  FloodOracle floods_;
  FailedJobs failures_;
  RouteRefusals refusals_;
  GroundedStance start_;
  std::vector<GroundedStance> goals_;
  double preparation_s_ = 0;
  bool is_improving_ = false;  ///< a plan is found; a quicker one is looked for
  mutable std::mutex progress_mutex_;
};

/// The request with the manoeuvres that need nothing of the robot's file, unless their name is
/// taken.
PlanRequest WithStepOver(const models::RobotModel& robot, PlanRequest request) {
  std::vector<std::string> taken = FurtherNames(request.gaits, request.manoeuvres);
  for (const models::Gait& gait : robot.gaits) taken.push_back(gait.name);
  for (const models::Jump& jump : robot.jumps) taken.push_back(jump.name);
  if (std::find(taken.begin(), taken.end(), kStepOver) == taken.end()) {
    request.manoeuvres.push_back(StepOverFactory());
  }
  return request;
}

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
  RequireNewNames(robot, scenario, request.gaits, request.manoeuvres);
  const PlanRequest full = WithStepOver(robot, request);
  models::Scenario asked = scenario;
  if (!full.actions.empty()) asked.actions = full.actions;
  models::CheckScenarioAgainstRobot(asked, robot, FurtherNames(full.gaits, full.manoeuvres));
  try {
    return TraversalPlanner(robot, asked, full).Plan();
  } catch (const Cancelled&) {
    request.cancellation.ThrowIfCancelled();
    PlanResult result;
    FillHeader(robot, scenario, request, &result.plan);
    SayNo(PlanStatus::kTimeLimit, "time ran out while the robot's swept volumes were computed.",
          &result);
    return result;
  }
}

}  // namespace possibility::actions
