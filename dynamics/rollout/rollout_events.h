#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "dynamics/rollout/robot_rollout.h"
#include "dynamics/rollout/rollout_dynamics.h"
#include "dynamics/rollout/rollout_stance.h"

namespace possibility::dynamics {

/// Who bears after points have come down or left: an impact, then the forces. Adds the events to a
/// rollout and ends it where the settings ask for an end at slip. Robot and rollout have to outlive
/// it.
class RolloutEvents {
 public:
  RolloutEvents(RolloutDynamics* robot, const RobotRolloutSettings& settings, RobotRollout* rollout)
      : robot_(robot), settings_(settings), rollout_(rollout) {}

  /// The stance at the start, by what touches the ground there. `state`: nq + nv, that set in the
  /// robot; its velocity becomes that after the impact.
  RolloutStance Start(double time, Eigen::VectorXd* state);
  /// The stance after the touchdown of `touched`; `leaving` no longer bear. Indices of contacts, in
  /// any order, maybe repeated in `leaving`.
  RolloutStance Pass(double time, const RolloutStance& stance, std::vector<int> touched,
                     std::vector<int> leaving, Eigen::VectorXd* state);
  /// Keeps the first end and its reason.
  void EndWith(RobotRolloutEnd end, std::string reason);

 private:
  RolloutStance PassContactEvent(double time, const std::vector<int>& held,
                                 const std::vector<int>& touched, const std::vector<int>& leaving,
                                 Eigen::VectorXd* state);
  std::vector<int> PassImpact(const std::vector<int>& touching, RobotContactEvent* event,
                              Eigen::VectorXd* state);
  void RecordFriction(const std::vector<int>& bearing, const Impact& impact,
                      RobotContactEvent* event);
  void SelectHeld(const std::vector<int>& touching, const Eigen::VectorXd& state,
                  RobotContactEvent* event);
  RolloutStance MakeStance(const std::vector<int>& held, const std::vector<int>& jammed);
  void CheckSlip(double time, const Eigen::VectorXd& state, const RolloutStance& stance);
  bool IsCalm(const Eigen::VectorXd& state);

  RolloutDynamics* robot_;
  RobotRolloutSettings settings_;
  RobotRollout* rollout_;
};

}  // namespace possibility::dynamics
