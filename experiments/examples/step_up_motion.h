#pragma once

#include <vector>

#include "actions/conditions/locomotion_model.h"
#include "actions/gait/quasi_static_gait.h"
#include "actions/plan/plan.h"
#include "common/cancellation_token.h"

namespace possibility::actions {

/// Posture of the robot at one point of the step.
struct StepPosture {
  /// Height of the root minus that of the nominal stance on the ground of the bearing foot, m.
  double lift = 0;
  double lean = 0;   ///< rad, pitch of the root minus the nominal one, forward positive
  double ahead = 0;  ///< m, forward shift of the centre of mass from its nominal place
};

/// Lengths and postures for DRC-HUBO1, found in 800 random trials. They work within 0.85 of
/// its torque limits and 0.95 of its friction for all tested rises up to 0.15 m.
struct StepUpSettings {
  double approach = 0.24;   ///< m, walked before the step: the stance keeps farther from the edge
  double step = 0.26;       ///< m, ahead, of each foot
  double clearance = 0.03;  ///< m, of the foot above the higher ground
  double shift_time = 1.2;  ///< s
  double lift_time = 0.8;   ///< s, from ground to above the edge; lowering takes half of it
  double carry_time = 0.8;  ///< s, over the edge
  double time_scale = 1.4;  ///< factor of all times, including those of the strides
  StepPosture first_foot_up{0.114, -0.138, 0.054};  ///< bearing on the lower foot
  /// Bearing on the upper foot, the other one still on the lower ground.
  StepPosture second_foot_leaves{-0.041, 0.236, 0.014};
  StepPosture second_foot_up{0.004, 0.177, -0.003};  ///< bearing on the upper foot
};

/// Two strides to an edge, then a step up with one foot after the other. Quasi-static, from rest in
/// a nominal stance of a gait to rest in a higher one.
class StepUpMotion {
 public:
  /// `gait` must belong to `robot`. Both must outlive this.
  StepUpMotion(const models::RobotModel& robot, const LocomotionModel::GaitEntry& gait,
               const StepUpSettings& settings = {});

  /// Horizontal distance from the lower to the higher stance, m.
  double distance() const { return settings_.approach + settings_.step; }
  /// Duration of a step from `from`, s.
  double ExpectedDuration(const PlanarPose& from) const;

  /// Motion from `from` on ground of height `z` to distance() ahead on ground that is `rise` (m,
  /// > 0) higher. `cancellation` is asked before every phase.
  /// @throws MotionError naming the limit that the robot would break; Cancelled.
  std::vector<Phase> Generate(const PlanarPose& from, double z, double rise,
                              const CancellationToken& cancellation) const;

 private:
  struct State;
  std::vector<MotionPhase> Phases(const PlanarPose& from, double z, double rise) const;
  WholeBodyTask TaskOf(const State& state) const;
  std::vector<int> ContactsBut(int limb) const;
  Eigen::Vector2d Over(int limb, const State& state, double ahead) const;
  void Shift(const State& target, State* state, std::vector<MotionPhase>* phases) const;
  void Swing(int limb, double rise, const State& target, State* state,
             std::vector<MotionPhase>* phases) const;
  void MoveFoot(int limb, const Eigen::Vector3d& p_WF, const State& target, double duration,
                State* state, std::vector<MotionPhase>* phases) const;

  const models::RobotModel* robot_;
  const LocomotionModel::GaitEntry* gait_;
  QuasiStaticGait walking_;
  StepUpSettings settings_;
};

}  // namespace possibility::actions
