#pragma once

#include <string>
#include <vector>

#include "actions/conditions/locomotion_model.h"
#include "actions/gait/foothold_plan.h"
#include "actions/spatial/spatial_solver.h"
#include "actions/wholebody/planar_pose.h"
#include "collocation/robot/contact_sequence.h"
#include "models/robot/contact_schedule.h"
#include "models/robot/robot_model.h"

namespace possibility::actions {

struct StepOverSettings {
  double height = 0.2;       ///< m, of the highest obstacle
  double thickness = 0.1;    ///< m, of the thickest
  double gap = 0.05;         ///< m, from the obstacle to the feet beside it
  double clearance = 0.028;  ///< m, of feet and shanks from it at the nodes, less than the gap
  double widening = 0.03;    ///< m: by how much each foot stands further out next to the obstacle
};

/// A step over an obstacle across the way, on two feet: two steps up to it, each foot over it, and
/// one step on. It begins and ends as far from the obstacle as walking needs. In the frame of the
/// first stance.
class StepOverProblem {
 public:
  /// `gait`: of `robot`, on two feet. Both must outlive it.
  /// @throws InputError if the gait has another number of limbs.
  StepOverProblem(const models::RobotModel& robot, const LocomotionModel::GaitEntry& gait,
                  const StepOverSettings& settings = {});

  const Beam& beam() const { return beam_; }
  const models::ContactSchedule& schedule() const { return schedule_; }
  PlanarPose displacement() const { return {length_, 0, 0}; }  ///< of the last stance
  const Eigen::VectorXd& from() const { return gait_.stance.q; }
  const Eigen::VectorXd& to() const { return to_; }
  const models::RobotModel& robot() const { return robot_; }
  const models::Gait& limbs() const { return *gait_.stance.gait; }
  SpatialSolverSettings solver() const;

  /// Hash of what solutions depend on.
  std::string Identity() const;

 private:
  std::vector<Step> Steps() const;
  /// Planes between the legs while one of them is over the obstacle, as they lie at rest: each leg
  /// stays on its own side.
  std::vector<collocation::Separation> LegsApart() const;

  const models::RobotModel& robot_;
  const LocomotionModel::GaitEntry& gait_;
  StepOverSettings settings_;
  Beam beam_;
  double length_ = 0;  ///< m
  models::ContactSchedule schedule_;
  Eigen::VectorXd to_;
};

}  // namespace possibility::actions
