#include "actions/planner/route_search.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "actions/jump/long_jump.h"
#include "actions/planner/planner_memory.h"
#include "actions/planner/planner_switches.h"
#include "actions/planner/request_checks.h"
#include "actions/route/footstep_explorer.h"
#include "actions/route/island_explorer.h"
#include "actions/route/lattice_explorer.h"
#include "actions/route/shortcut_explorer.h"
#include "actions/route/step_shortcut_explorer.h"
#include "graph/search/random_explorer.h"
#include "models/input/input_error.h"

namespace possibility::actions {
namespace {

/// Time for one random exploration of another route, s.
constexpr double kElsewhere = 2;

PlannerSwitches SwitchesOf(const PlanRequest& request) {
  const PlannerSwitches switches = SwitchesOf(request.preset);
  return request.explorers.empty() ? switches
                                   : WithExplorers(switches, request.explorers, "explorers");
}

/// A search's result, with what the one before it took added to its account.
graph::PathResult After(const graph::PathResult& before, graph::PathResult result) {
  result.seconds += before.seconds;
  result.first_path_seconds += before.seconds;
  result.confirmations.insert(result.confirmations.begin(), before.confirmations.begin(),
                              before.confirmations.end());
  for (const auto& [name, count] : before.counters) result.counters[name] += count;
  return result;
}

}  // namespace

RouteSearch::RouteSearch(const models::RobotModel& robot, const models::Scenario& scenario,
                         const PlanRequest& request)
    : robot_(robot),
      scenario_(scenario),
      request_(request),
      switches_(SwitchesOf(request)),
      deadline_(request.time_limit),
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

CancellationToken RouteSearch::Until(const Deadline& deadline) const {
  return CancellationToken([deadline, cancellation = request_.cancellation] {
    return !deadline.Passed() && cancellation.Proceed();
  });
}

std::vector<ManoeuvreFactory> RouteSearch::AllFactories() const {
  std::vector<ManoeuvreFactory> factories =
      JumpFactories(robot_, switches_.skip_jumps.value_or(scenario_.planner.skip_jumps));
  factories.insert(factories.end(), request_.manoeuvres.begin(), request_.manoeuvres.end());
  return factories;
}

const std::vector<std::string>& RouteSearch::ActionNames() const {
  return request_.actions.empty() ? scenario_.actions : request_.actions;
}

bool RouteSearch::IsInUse(const ManoeuvreFactory& factory) const {
  const std::vector<std::string>& names = ActionNames();
  return std::find(names.begin(), names.end(), factory.name) != names.end();
}

std::vector<std::string> RouteSearch::GaitNames() const {
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

std::shared_ptr<const LocomotionModel> RouteSearch::MakeModel() const {
  const CancellationToken cancellation = Until(deadline_);
  if (request_.memory && request_.gaits.empty()) {
    return request_.memory->ModelOf(robot_, GaitNames(), cancellation, TransitionLibrary(),
                                    request_.threads);
  }
  return std::make_shared<const LocomotionModel>(BuildLocomotionModel(
      robot_, GaitNames(), cancellation, TransitionLibrary(), request_.gaits, request_.threads));
}

void RouteSearch::PrepareManoeuvres() {
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

std::vector<std::shared_ptr<const graph::Action>> RouteSearch::Actions() const {
  std::vector<std::shared_ptr<const graph::Action>> all(gaits_.begin(), gaits_.end());
  all.insert(all.end(), all_manoeuvres_.begin(), all_manoeuvres_.end());
  return all;
}

std::string RouteSearch::PlanActionOf(int action) const {
  const std::size_t index = static_cast<std::size_t>(action);
  return index < gaits_.size() ? gaits_[index]->name()
                               : all_manoeuvres_[index - gaits_.size()]->plan_action();
}

int RouteSearch::GaitOnTwoSoles() const {
  const auto stands = [this](int gait) {
    return StandsOnTwoSoles(*model_.gaits[gait]->stance.gait);
  };
  const int start = model_.GaitIndex(scenario_.start.action);
  if (start >= 0 && stands(start)) return start;
  for (int gait = 0; gait < static_cast<int>(model_.gaits.size()); ++gait) {
    if (stands(gait)) return gait;
  }
  return -1;
}

/// Steps of more limbs are joined with nothing else where two soles may take them: without a proof
/// that there are none (FootholdFlood) every search for them takes its whole effort.
void RouteSearch::PrepareSteps(const PlanningContext& context, const std::string& where) {
  all_manoeuvres_ = searched_;
  if (!switches_.footsteps || !switches_.floods) return;
  const int start = model_.GaitIndex(scenario_.start.action);
  const int on_two_soles = GaitOnTwoSoles();
  if (start >= 0 && FootstepSearch::Knows(model_.gaits[start]->gait)) {
    direct_steps_ = AddSteps(context, start, where);
  }
  joined_steps_ = direct_steps_;
  if (on_two_soles >= 0 && on_two_soles != start) {
    joined_steps_ = AddSteps(context, on_two_soles, where);
  }
}

const PlannedSteps* RouteSearch::AddSteps(const PlanningContext& context, int gait,
                                          const std::string& where) {
  steps_.push_back(std::make_shared<PlannedSteps>(context, gait));
  all_manoeuvres_.push_back(std::make_shared<SearchedManoeuvre>(steps_.back(), where));
  return steps_.back().get();
}

int RouteSearch::ActionOf(const PlannedSteps& steps) const {
  std::size_t action = gaits_.size() + searched_.size();
  for (const auto& each : steps_) {
    if (each.get() == &steps) break;
    ++action;
  }
  return static_cast<int>(action);
}

std::vector<GroundedStance> RouteSearch::GoalsOfSteps() const {
  std::vector<GroundedStance> goals;
  for (const GroundedStance& goal : goals_) {
    if (goal.gait == start_.gait) goals.push_back(goal);
  }
  return goals;
}

graph::PathResult RouteSearch::Find(std::uint64_t attempt) {
  graph::PathResult path = FindOnce(attempt);
  while (path.status == graph::PathStatus::kExhausted && MayAskAgain()) {
    path = After(path, ExploreSteps(attempt));
    if (path.status != graph::PathStatus::kFound) {
      path.status =
          deadline_.Passed() ? graph::PathStatus::kTimeLimit : graph::PathStatus::kExhausted;
    }
  }
  return path;
}

bool RouteSearch::MayAskAgain() {
  if (deadline_.Passed()) return false;
  bool may = false;
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    std::vector<graph::Edge> edges;
    if (!steps_[i]->AskAgain(&edges)) continue;
    for (const graph::Edge& edge : edges) all_manoeuvres_[searched_.size() + i]->Forget(edge);
    may = true;
  }
  return may;
}

graph::PathResult RouteSearch::FindOnce(std::uint64_t attempt) {
  const bool nobody_else_explores = !switches_.straight && !switches_.lattice && !switches_.random;
  if (StepsMayHelp() && nobody_else_explores) {
    AskFloods();
    needs_steps_ = *oracle_answer_ != graph::RouteOracleAnswer::kProvenInfeasible;
  }
  graph::PathResult path;
  if (!needs_steps_) {
    ends_at_oracle_ = StepsMayHelp();
    path = Explore(attempt);
    ends_at_oracle_ = false;
    if (path.status == graph::PathStatus::kFound || !needs_steps_) return path;
  }
  path = After(path, ExploreSteps(attempt));
  if (path.status == graph::PathStatus::kFound) return path;
  const bool is_open = *oracle_answer_ == graph::RouteOracleAnswer::kUnknown;
  if (is_open && !deadline_.Passed()) return After(path, Explore(attempt));
  // Contact planning has answered only if time did not end it.
  const bool is_undecided = is_open || deadline_.Passed();
  path.status = is_undecided ? graph::PathStatus::kTimeLimit : graph::PathStatus::kExhausted;
  return path;
}

graph::RouteOracleAnswer RouteSearch::AskFloods() {
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

void RouteSearch::GuideExploration() {
  std::vector<graph::Point> samples;
  for (const GroundedStance& stance : floods_.way()) {
    samples.push_back(ToPoint(stance.pose.At(stance.z + 1)));
  }
  space_->Guide(std::move(samples), scenario_.planner.flood_resolution);
}

graph::PathResult RouteSearch::ExploreSteps(std::uint64_t attempt) {
  graph::FindPathSettings settings = SearchSettings(attempt);
  if (switches_.shortcuts) settings.explorers = {ShortcutExploration(Space(), goals_)};
  AddStepExplorers(&settings);
  steps_are_called_ = true;
  return graph::FindPath(PointOf(start_), GoalPoints(), Actions(), *space_, settings);
}

void RouteSearch::AddStepExplorers(graph::FindPathSettings* settings) {
  steps_gave_up_ = !StepsMayDo();
  if (StepsMayDo()) {
    settings->explorers.push_back(
        FootstepExploration(Space(), *direct_steps_, ActionOf(*direct_steps_), start_,
                            GoalsOfSteps(), &steps_are_called_, &steps_gave_up_));
  }
  if (!joined_steps_ || !IsMixed()) return;
  const int action = ActionOf(*joined_steps_);
  settings->explorers.push_back(
      StepShortcutExploration(Space(), *joined_steps_, action, &steps_are_called_));
  settings->explorers.push_back(IslandExploration({&model_, &gaits_, &searched_}, *joined_steps_,
                                                  action, start_, goals_, &steps_are_called_,
                                                  &steps_gave_up_));
}

std::filesystem::path RouteSearch::TransitionLibrary() const {
  return switches_.solved_motions ? request_.library : std::filesystem::path();
}

graph::Point RouteSearch::PointOf(const GroundedStance& stance) const {
  return ToPoint(model_.gaits[stance.gait]->stance.RootPose(stance.pose, stance.z));
}

graph::PathResult RouteSearch::Explore(std::uint64_t attempt) {
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
    actions = Actions();
    // Random exploration knows no steps.
    for (const auto& steps : steps_) settings.skip_growth[steps->name()] = 1;
  }
  return graph::FindPath(PointOf(start_), GoalPoints(), actions, *space_, settings);
}

graph::FindPathSettings RouteSearch::SearchSettings(std::uint64_t attempt) const {
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

std::vector<graph::Point> RouteSearch::GoalPoints() const {
  std::vector<graph::Point> goals;
  for (const GroundedStance& goal : goals_) goals.push_back(PointOf(goal));
  return goals;
}

std::vector<graph::ExplorerFactory> RouteSearch::Explorers() const {
  const RouteSpace space{&model_, &gaits_, &searched_};
  std::vector<graph::ExplorerFactory> explorers;
  // Routes to shorten may hold planned steps.
  if (switches_.shortcuts) explorers.push_back(ShortcutExploration(Space(), goals_));
  if (switches_.lattice) explorers.push_back(LatticeExploration(space, start_, goals_));
  if (switches_.random) explorers.push_back(graph::RandomExploration());
  // An empty list would select the paper's explorer. Shortcuts take no part in the search for a
  // first route.
  if (explorers.empty()) explorers.push_back(ShortcutExploration(Space(), goals_));
  return explorers;
}

Route RouteSearch::FindElsewhere(std::uint64_t round) {
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

}  // namespace possibility::actions
