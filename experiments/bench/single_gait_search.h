#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "actions/conditions/exploration_pose.h"
#include "actions/conditions/locomotion_model.h"
#include "actions/conditions/quasi_static_action.h"
#include "actions/planner/planner_switches.h"
#include "actions/wholebody/planar_pose.h"
#include "graph/search/find_path.h"
#include "models/robot/robot_model.h"
#include "models/world/ground_map.h"
#include "models/world/scenario.h"

namespace possibility::experiments {

struct FoundPath {
  bool found = false;
  double seconds = 0;                  ///< until the path was confirmed or the search gave up
  std::vector<std::string> explorers;  ///< explorers of its edges
  std::vector<actions::PlanarPose> poses;
};

/// Query for a way from a scenario's start to its first goal in one gait, for any planner in the
/// plane. Heights, actions and the other goals are ignored.
class SingleGaitSearch {
 public:
  /// `robot` must outlive this object.
  /// @throws InputError if the gait does not exist or cannot stand at start or goal.
  SingleGaitSearch(const models::RobotModel& robot, const std::string& gait,
                   models::Scenario scenario);
  SingleGaitSearch(const SingleGaitSearch&) = delete;
  SingleGaitSearch& operator=(const SingleGaitSearch&) = delete;

  const models::Scenario& scenario() const { return scenario_; }
  const actions::PlanarPose& start() const { return start_; }
  const actions::PlanarPose& goal() const { return goal_; }

  /// Sufficient conditions on a stance and on the straight way between two: C_S of the gait's
  /// action. Safe to call from any number of threads.
  bool IsValid(const actions::PlanarPose& pose) const;
  bool IsValid(const actions::PlanarPose& from, const actions::PlanarPose& to) const;

  /// The possibility graph's answer, with the search of a planner preset.
  FoundPath Find(actions::PlannerPreset preset, std::uint64_t seed, double time_limit) const;

 private:
  graph::Point PointAt(const actions::PlanarPose& pose) const;
  actions::PlanarPose PoseAt(const graph::Point& point) const;

  actions::LocomotionModel model_;
  models::Scenario scenario_;
  models::GroundMap ground_;
  actions::World world_;
  std::shared_ptr<actions::PelvisPoseSpace> space_;
  std::vector<std::shared_ptr<actions::QuasiStaticAction>> gaits_;  ///< one
  actions::PlanarPose start_;
  actions::PlanarPose goal_;
};

/// Horizontal length, m.
double LengthOf(const std::vector<actions::PlanarPose>& path);

}  // namespace possibility::experiments
