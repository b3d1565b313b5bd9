#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "actions/conditions/exploration_pose.h"
#include "actions/conditions/locomotion_model.h"
#include "actions/conditions/quasi_static_action.h"
#include "actions/conditions/searched_manoeuvre.h"
#include "actions/flood/flood_oracle.h"
#include "actions/footsteps/planned_steps.h"
#include "actions/planner/planner.h"
#include "actions/route/route.h"
#include "actions/route/route_space.h"
#include "common/cancellation_token.h"
#include "common/deadline.h"
#include "models/world/ground_map.h"

namespace possibility::actions {

/// The actions of one request in its world, and the searches for routes through them.
class RouteSearch {
 public:
  /// Prepares the robot's actions. The references must outlive this.
  /// @throws InputError if an action, the start or a goal is impossible; Cancelled.
  RouteSearch(const models::RobotModel& robot, const models::Scenario& scenario,
              const PlanRequest& request);

  /// First through C_S and manoeuvres. Where the floods find no route there, or cannot tell,
  /// contacts are planned as well: beside manoeuvres in the same search, otherwise in a search of
  /// their own. If that leads nowhere either, the search goes on as long as the floods leave it
  /// open and its effort lasts. At last contacts are planned again, with twice the effort.
  /// `attempt` changes the seed.
  graph::PathResult Find(std::uint64_t attempt);
  /// The route that random exploration alone finds in a short time; empty if none.
  Route FindElsewhere(std::uint64_t round);

  /// Cancels at the deadline, or when the request does.
  CancellationToken Until(const Deadline& deadline) const;
  const Deadline& deadline() const { return deadline_; }  ///< of the search
  double preparation_s() const { return preparation_s_; }

  const LocomotionModel& model() const { return model_; }
  const World& world() const { return world_; }
  const std::vector<std::shared_ptr<QuasiStaticAction>>& gaits() const { return gaits_; }
  const std::vector<std::shared_ptr<Manoeuvre>>& manoeuvres() const { return manoeuvres_; }
  /// With verdicts; planned steps come last.
  const std::vector<std::shared_ptr<SearchedManoeuvre>>& all_manoeuvres() const {
    return all_manoeuvres_;
  }
  const std::vector<std::shared_ptr<PlannedSteps>>& steps() const { return steps_; }
  FloodOracle& floods() { return floods_; }
  const GroundedStance& start() const { return start_; }
  const std::vector<GroundedStance>& goals() const { return goals_; }

  std::vector<std::shared_ptr<const graph::Action>> Actions() const;
  RouteSpace Space() const { return {&model_, &gaits_, &all_manoeuvres_}; }
  /// The name under which a plan has the motion of an action.
  std::string PlanActionOf(int action) const;

 private:
  /// The factories of the robot's file come first.
  std::vector<ManoeuvreFactory> AllFactories() const;
  const std::vector<std::string>& ActionNames() const;
  bool IsInUse(const ManoeuvreFactory& factory) const;
  std::vector<std::string> GaitNames() const;
  /// Gaits of the request are functions, which cannot be compared with those of another request.
  std::shared_ptr<const LocomotionModel> MakeModel() const;
  void PrepareManoeuvres();
  /// Of the start's gait, and of a gait on two soles, if there are such gaits in use.
  void PrepareSteps(const PlanningContext& context, const std::string& where);
  const PlannedSteps* AddSteps(const PlanningContext& context, int gait, const std::string& where);
  /// The start's gait, if it stands on two soles, or the first one that does; -1: none.
  int GaitOnTwoSoles() const;
  /// Stances of the start's gait.
  std::vector<GroundedStance> GoalsOfSteps() const;
  /// Whether steps alone may lead from the start to a goal.
  bool StepsMayDo() const { return direct_steps_ && !GoalsOfSteps().empty(); }
  bool StepsMayHelp() const { return StepsMayDo() || (joined_steps_ && IsMixed()); }
  int ActionOf(const PlannedSteps& steps) const;
  /// Whether there is anything else that steps can be joined with.
  bool IsMixed() const { return gaits_.size() > 1 || !searched_.empty(); }
  graph::RouteOracleAnswer AskFloods();
  /// The way that the floods consider open shows random exploration where to go.
  void GuideExploration();
  graph::PathResult FindOnce(std::uint64_t attempt);
  graph::PathResult ExploreSteps(std::uint64_t attempt);
  /// Whether planned steps may be worth another search with more effort.
  bool MayAskAgain();
  void AddStepExplorers(graph::FindPathSettings* settings);
  /// Empty: none.
  std::filesystem::path TransitionLibrary() const;
  graph::Point PointOf(const GroundedStance& stance) const;
  graph::PathResult Explore(std::uint64_t attempt);
  /// What searches have in common.
  graph::FindPathSettings SearchSettings(std::uint64_t attempt) const;
  std::vector<graph::Point> GoalPoints() const;
  /// The explorer that answers fastest comes first.
  std::vector<graph::ExplorerFactory> Explorers() const;

  const models::RobotModel& robot_;
  const models::Scenario& scenario_;
  const PlanRequest& request_;
  PlannerSwitches switches_;
  Deadline deadline_;
  models::GroundMap ground_;
  World world_;
  std::vector<ManoeuvreFactory> factories_;
  std::shared_ptr<const LocomotionModel> shared_model_;
  const LocomotionModel& model_;
  std::shared_ptr<PelvisPoseSpace> space_;
  std::vector<std::shared_ptr<QuasiStaticAction>> gaits_;  ///< by gait
  std::vector<std::shared_ptr<Manoeuvre>> manoeuvres_;
  std::vector<std::shared_ptr<SearchedManoeuvre>> searched_;  ///< the same, with verdicts
  std::vector<std::shared_ptr<PlannedSteps>> steps_;
  const PlannedSteps* direct_steps_ = nullptr;  ///< of the start's gait; null: cannot be planned
  const PlannedSteps* joined_steps_ = nullptr;  ///< joined with other actions; null: none
  std::vector<std::shared_ptr<SearchedManoeuvre>> all_manoeuvres_;  ///< searched, then steps
  bool ends_at_oracle_ = false;    ///< the search under way ends where the floods find no route
  bool needs_steps_ = false;       ///< the floods found no route
  bool steps_gave_up_ = false;     ///< steps alone lead nowhere
  bool steps_are_called_ = false;  ///< explorers of steps take part
  std::optional<graph::RouteOracleAnswer> oracle_answer_;
  FloodOracle floods_;
  GroundedStance start_;
  std::vector<GroundedStance> goals_;
  double preparation_s_ = 0;
};

}  // namespace possibility::actions
