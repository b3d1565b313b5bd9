#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "actions/jump/jump_problem.h"
#include "actions/plan/plan.h"
#include "actions/sagittal/stance_motion.h"
#include "collocation/transcription/transcription.h"

namespace possibility::actions {

/// How closely a jump of the whole robot follows the sagittal one.
struct JumpMotionReport {
  double landing_correction = 0;  ///< rad: greatest joint correction that brings feet and hands to
                                  ///< their places in spite of the robot's asymmetry
  double impact_friction = 0;     ///< greatest fraction of the friction coefficient used by impacts
  double energy_lost = 0;         ///< J, in all impacts
};

/// Turns a sagittal jump into motion of the whole robot, whose halves are never exact mirror
/// images. Holds soles and pegs exactly in place, computes flight with the momentum of the whole
/// robot and impacts with its mass matrix. Everything is relative to the launch stance's frame.
class JumpMotion {
 public:
  /// All arguments must outlive this object.
  JumpMotion(const models::RobotModel& robot, const SagittalModel& model,
             const NominalStance& launch, const NominalStance& landing);

  /// The first phase of every jump, which turns joints; none if they need not turn.
  /// @throws MotionError as Realise.
  std::optional<Phase> Prepare() const;
  /// From rest in the launch stance to rest in the landing stance; times start at 0.
  /// `preparation`: of Prepare.
  /// @throws MotionError naming what the whole robot cannot do.
  std::vector<Phase> Realise(const JumpProblem& problem, const collocation::Trajectory& trajectory,
                             const std::optional<Phase>& preparation,
                             JumpMotionReport* report = nullptr);

 private:
  Phase RollOverToes(const collocation::PhaseTrajectory& plan, const Knot& from) const;
  Phase Fly(const collocation::PhaseTrajectory& rise, const collocation::PhaseTrajectory& descent,
            const Knot& from, const Support& feet, JumpMotionReport* report);
  void RequireLimits(const Phase& flight, double max_base_speed) const;
  /// The impact of `support` at a touchdown: velocities after it and impulses in the cones.
  Knot AfterImpact(const Knot& touchdown, const Support& support, Eigen::Matrix3Xd* impulses,
                   JumpMotionReport* report) const;

  StanceMotion stance_;
  std::shared_ptr<const dynamics::MultibodyModel> spatial_;
};

}  // namespace possibility::actions
