#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "dynamics/ode/ode_integrator.h"
#include "dynamics/rollout/robot_rollout.h"
#include "dynamics/rollout/rollout_dynamics.h"
#include "dynamics/rollout/rollout_stance.h"

namespace possibility::dynamics {

/// An event that may end a stance.
struct RolloutGuard {
  enum class Kind { kTouchdown, kTipping, kUnjamming, kSlip, kCalm, kRest };
  Kind kind = Kind::kTouchdown;
  int contact = -1;  ///< for kTouchdown, kUnjamming
  int patch = -1;    ///< for kTipping, kSlip
  int edge = -1;     ///< for kTipping
};

/// The guards of one stance. Share ownership of the stance; the robot must outlive them.
class RolloutGuards {
 public:
  RolloutGuards(std::shared_ptr<const RolloutStance> stance, const RobotRolloutSettings& settings,
                RolloutDynamics* robot);

  const RolloutStance& stance() const { return *stance_; }
  int size() const { return static_cast<int>(guards_.size()); }
  const RolloutGuard& operator[](int index) const { return guards_[index]; }

  OdeGuard Watched(int index) const;    ///< how the integrator watches it
  std::string NameOf(int index) const;  ///< for messages
  /// For kTipping: the contacts that leave.
  std::vector<int> Tipping(const RolloutGuard& guard) const;
  /// For kTipping or kSlip: a contact that represents the patch.
  const RolloutContact& PatchContact(const RolloutGuard& guard) const;
  /// `values`: size(). Those that are far from zero may be of the state, very near, at which the
  /// robot was accelerated last.
  void Evaluate(double t, const Eigen::Ref<const Eigen::VectorXd>& state,
                Eigen::Ref<Eigen::VectorXd> values) const;
  /// The same of one guard.
  double EvaluateOne(double t, const Eigen::Ref<const Eigen::VectorXd>& state, int index) const;

 private:
  /// Whether no guard can have another sign at `state` because forces or gaps are not the same
  /// there as at the current state, that of the robot's last acceleration.
  bool ForcesServe(double t, const Eigen::Ref<const Eigen::VectorXd>& state) const;
  bool GapsServe(double t, const Eigen::Ref<const Eigen::VectorXd>& state) const;
  bool HasOnlyGaps() const;
  double Value(double t, const Eigen::Ref<const Eigen::VectorXd>& state,
               const Eigen::Matrix3Xd& forces, const RolloutGuard& guard) const;
  /// Whether friction jams a point of the patch. Such a point may pull.
  bool IsJammed(int patch) const;

  std::shared_ptr<const RolloutStance> stance_;
  RobotRolloutSettings settings_;
  RolloutDynamics* robot_;
  std::vector<RolloutGuard> guards_;
};

}  // namespace possibility::dynamics
