#pragma once

#include <Eigen/Core>
#include <memory>
#include <set>
#include <vector>

#include "actions/plan/interpolation.h"
#include "actions/plan/plan.h"
#include "actions/rollout/perturbation.h"
#include "actions/rollout/rollout_drift.h"
#include "actions/rollout/rollout_gains.h"
#include "actions/rollout/step_feedback.h"
#include "dynamics/rollout/joint_control.h"
#include "dynamics/rollout/robot_rollout.h"
#include "dynamics/tree/multibody_model.h"
#include "models/robot/robot_model.h"
#include "models/world/ground_map.h"

namespace possibility::actions {

/// A plan's points bear within 1 mm of their ground.
inline constexpr double kTouching = 1.1e-3;  // m

/// A segment as a simulation follows it: the simulated robot, the ground, the motion, and the
/// control that follows it by joint torques alone. The ground has the planes on which the plan
/// bears. If the perturbation tilts the ground, the robot and its plan are tilted with it.
/// Coordinates are relative to the segment's beginning: far from the origin, the integrator's
/// relative tolerance would be too coarse for the motion. Segment, robot and ground must outlive
/// it; it must outlive its contacts and its control.
class RolloutReference {
 public:
  RolloutReference(const Segment& segment, const models::RobotModel& robot,
                   const models::GroundMap& ground, const Perturbation& perturbation,
                   const RolloutGains& gains);
  RolloutReference(const RolloutReference&) = delete;
  RolloutReference& operator=(const RolloutReference&) = delete;

  const Segment& segment() const { return segment_; }
  const std::shared_ptr<const dynamics::MultibodyModel>& model() const { return model_; }
  double start() const { return segment_.phases.front().knots.front().t; }  ///< s
  double end() const { return segment_.phases.back().knots.back().t; }      ///< s
  bool ends_at_rest() const;
  Eigen::Vector3d normal() const { return tilt_.col(2); }  ///< of the plan's horizontal planes

  /// At a time, clamped to the segment. Independent joints only; nq and nv of the model.
  Eigen::VectorXd Configuration(double t) const;
  Eigen::VectorXd Velocity(double t) const;

  /// Every contact point of the robot with every ground plane used. The extent of planes matters
  /// only if there are several.
  std::vector<dynamics::RolloutContact> Contacts() const;
  /// `steps`: feedback that moves the feet; must outlive the control. May be null.
  dynamics::JointControl Control(const StepFeedback* steps = nullptr) const;
  /// Departure of the root from its planned orientation.
  RootTilt Tilt(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& v) const;
  /// At a time, clamped to the segment; of all joints, nq of the tree.
  Eigen::VectorXd TreeConfiguration(double t) const;
  /// Empty without a push.
  dynamics::RootPush Push() const;

  /// Adds the state at time `t` to the worst deviations, and sets fell_at.
  void Compare(double t, const Eigen::VectorXd& q, RolloutDrift* drift) const;
  /// Deviations of the last state, once settled.
  void CompareEnd(const Eigen::VectorXd& q, const Eigen::VectorXd& v, RolloutDrift* drift) const;
  /// How far the root is from falling, at most 1, at q; below 0: fallen.
  double Uprightness(double t, const Eigen::Ref<const Eigen::VectorXd>& q) const;

 private:
  /// The knots of a segment as one function of time.
  class Track {
   public:
    explicit Track(const Segment& segment);
    /// At the meeting of two phases: the later one's.
    const KnotInterpolant& Around(double t) const;
    Knot At(double t) const { return Around(t).At(t); }

   private:
    std::vector<double> starts_;
    std::vector<KnotInterpolant> intervals_;
  };

  bool IsTilted() const;
  Eigen::VectorXd Configuration(const Knot& knot) const;
  Eigen::VectorXd Velocity(const Knot& knot) const;

  const Segment& segment_;
  const models::GroundMap& ground_;
  Perturbation perturbation_;
  Eigen::VectorXd stiffness_;                              ///< joints of the tree
  double damping_time_ = 0;                                ///< s
  Eigen::Vector3d origin_;                                 ///< m
  Eigen::Matrix3d tilt_;                                   ///< of the perturbation
  std::shared_ptr<const dynamics::MultibodyModel> model_;  ///< perturbed
  Track track_;
  std::set<int> planes_;  ///< of the ground, on which the segment bears
};

}  // namespace possibility::actions
