#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "dynamics/rollout/robot_rollout.h"
#include "dynamics/rollout/rollout_dynamics.h"
#include "dynamics/rollout/rollout_stance.h"

namespace possibility::dynamics {

/// Determines which contacts bear after points have come down or left: first an impact, then the
/// forces. Adds the events to a rollout, and ends it at slip if the settings ask for that. Robot
/// and rollout must outlive this.
class RolloutEvents {
 public:
  RolloutEvents(RolloutDynamics* robot, const RobotRolloutSettings& settings, RobotRollout* rollout)
      : robot_(robot), settings_(settings), rollout_(rollout) {}

  /// The stance at the start, from the contacts that touch the ground there. `state`: nq + nv, the
  /// robot's current state; its velocity becomes that after the impact.
  RolloutStance Start(double time, Eigen::VectorXd* state);
  /// The stance after the touchdown of `touched`, when `leaving` no longer bear. Indices of
  /// contacts in any order; `leaving` may have repetitions.
  RolloutStance Pass(double time, const RolloutStance& stance, std::vector<int> touched,
                     std::vector<int> leaving, Eigen::VectorXd* state);
  /// Only the first end and its reason are kept.
  void EndWith(RobotRolloutEnd end, std::string reason);

 private:
  RolloutStance PassContactEvent(double time, const std::vector<int>& held,
                                 const std::vector<int>& touched, const std::vector<int>& leaving,
                                 Eigen::VectorXd* state);
  std::vector<int> PassImpact(const std::vector<int>& touching, RobotContactEvent* event,
                              Eigen::VectorXd* state);
  void RecordFriction(const std::vector<int>& bearing, const Impact& impact,
                      RobotContactEvent* event);
  /// Returns the contacts that jam but may still sink, ascending; they are not held.
  std::vector<int> SelectHeld(std::vector<int> touching, const Eigen::VectorXd& state,
                              RobotContactEvent* event);
  /// Whether a contact that jams is not yet as deep as RobotRolloutSettings::jam_depth.
  bool MaySink(int contact);
  RolloutStance MakeStance(const std::vector<int>& held, const std::vector<int>& jammed,
                           const std::vector<int>& sinking, const Eigen::VectorXd& state);
  void CheckSlip(double time, const Eigen::VectorXd& state, const RolloutStance& stance);
  bool IsCalm(const Eigen::VectorXd& state);

  RolloutDynamics* robot_;
  RobotRolloutSettings settings_;
  RobotRollout* rollout_;
};

}  // namespace possibility::dynamics
