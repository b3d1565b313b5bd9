#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "dynamics/rollout/robot_rollout.h"

namespace possibility::dynamics {

struct ElasticLandingSettings {
  Eigen::VectorXd stiffness;  ///< num_joints, N m/rad or N/m
  Eigen::VectorXd damping;    ///< num_joints, N m s/rad or N s/m
  double time_limit = 3;      ///< s
  double rest_energy = 0.05;  ///< J, kinetic
  double rest_time = 0.1;     ///< s
  /// rest_energy, rest_time and hybrid.end_at_zeno (true here) of these settings are ignored.
  RobotRolloutSettings rollout;
};

struct ElasticLandingOutcome {
  bool is_at_rest = false;
  std::string reason;  ///< one line: how the landing ended
  double time = 0;     ///< s, until rest or until the end
  RobotRollout rollout;
};

/// Gains of equal frequency for every joint: `frequency` (rad/s) and `damping_ratio` hold for a
/// joint that moves alone, with the base fixed, at q.
struct ElasticGains {
  Eigen::VectorXd stiffness;
  Eigen::VectorXd damping;
};
ElasticGains GainsOfFrequency(const std::shared_ptr<const MultibodyModel>& model,
                              const Eigen::Ref<const Eigen::VectorXd>& q, double frequency,
                              double damping_ratio);

/// Simulates a landing from the state at touchdown. Points that touch the ground hit it
/// inelastically. Then every joint is a spring and damper about `posture` (num_joints), with
/// gravity compensation as if all `contacts` carried the robot (once one does), within the effort
/// limits. Ends when the robot is at rest or the time is over.
/// @throws what RobotSimulator throws.
ElasticLandingOutcome LandElastically(const std::shared_ptr<const MultibodyModel>& model,
                                      const std::vector<RolloutContact>& contacts,
                                      const Eigen::Ref<const Eigen::VectorXd>& q,
                                      const Eigen::Ref<const Eigen::VectorXd>& v,
                                      const Eigen::Ref<const Eigen::VectorXd>& posture,
                                      const ElasticLandingSettings& settings);

}  // namespace possibility::dynamics
