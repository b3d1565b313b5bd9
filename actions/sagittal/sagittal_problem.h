#pragma once

#include <optional>
#include <string>
#include <vector>

#include "actions/sagittal/sagittal_model.h"
#include "collocation/problem/optimal_control_problem.h"
#include "collocation/robot/robot_phase.h"
#include "collocation/robot/step_clearance.h"

namespace possibility::actions {

/// Shares of a flat sole's load at its two ends.
struct SoleShares {
  double heel = 0;
  double toe = 0;
};

/// Limits and safety margins of a dynamic action in the sagittal plane.
struct SagittalSettings {
  /// Keeps a reserve of every limit for the whole robot's asymmetry and for feedback.
  collocation::RobotLimits limits = {.friction_fraction = 0.65,
                                     .speed_fraction = 0.9,
                                     .torque_fraction = 0.9,
                                     .max_base_speed = 8,
                                     .joint_margin = 0.03};
  double least_point_load = 0.07;  ///< of the weight, on every contact point
  double body_clearance = 0.02;    ///< m, guards above the ground in every phase
  double hand_clearance = 0.03;    ///< m, hands above the ground they leave
  double hand_approach = 0.01;     ///< m, hands above the ground they are about to touch
  /// Heel and toe each bear at least this fraction of the sole's load while the sole is flat.
  double sole_margin = 0.1;
  double max_hand_tilt = 0.35;  ///< rad, of a bearing hand from its orientation in the stance
  /// Largest arm length while the hand bears, as a fraction of the stretched arm's: a straight arm
  /// could not follow the body to either side.
  double arm_reach = 0.96;
};

/// From the end of the launch ground to the beginning of the landing ground, along x in the launch
/// stance's frame, m, if both grounds are no longer than the contacts need. Empty (upper < lower)
/// if the robot lands short of its launch contacts.
collocation::Bounds GapBetween(const SagittalModel& model, double distance);

/// An optimal-control problem of a robot that moves from SagittalModel's launch stance to its
/// landing stance, whose frame is at `distance` and `height` (m) in the launch stance's frame.
/// Derived classes add the phases; this class holds what they share. Minimises joint accelerations
/// and contact forces.
class SagittalProblem {
 public:
  SagittalProblem(const SagittalProblem&) = delete;
  SagittalProblem& operator=(const SagittalProblem&) = delete;

  const collocation::OptimalControlProblem& problem() const { return problem_; }
  const collocation::RobotPhase& phase(int index) const { return phases_[index]; }

 protected:
  SagittalProblem(const std::string& name, const SagittalModel& model, double distance,
                  double height, const SagittalSettings& settings);
  ~SagittalProblem() = default;

  std::vector<dynamics::ContactPoint> Feet() const;          ///< heel and toe
  std::vector<dynamics::ContactPoint> FeetAndHands() const;  ///< heel, toe, hands
  /// `most_torque`: share of the torques; the settings may allow less.
  void AddPhase(const std::string& name, const std::vector<dynamics::ContactPoint>& points,
                collocation::Bounds duration, double most_torque = 1);

  /// The phase begins at rest in SagittalModel::ready().
  void StartAtRest(int phase);
  /// The phase's points do not move: zero velocity and acceleration at the knots. Zero velocities
  /// at all nodes instead would determine the accelerations of each interval from those at its
  /// start, and an error there would persist through all later intervals. `held`: for x and z of
  /// each point.
  void HoldPoints(int phase, const std::vector<collocation::Bounds>& held, collocation::At at);
  /// Heel and toe, the phase's first two points, do not move, and each bears at least its share.
  void HoldSoles(int phase, collocation::At at, const SoleShares& least);
  /// With the shares of SagittalSettings::sole_margin.
  void HoldSoles(int phase, collocation::At at);
  /// Heel, toe and hands do not move; arms are never straight.
  void HoldFeetAndHands(int phase, collocation::At at);
  /// The points begin the phase with zero acceleration. Velocities at the nodes leave the
  /// acceleration at the first node free, and an error there recurs with alternating sign at every
  /// later node.
  void StartHeld(int phase, const std::vector<collocation::Bounds>& held);
  static std::vector<collocation::Bounds> HeldHands(std::size_t hands);
  /// The accelerations at the end of one phase and at the start of the next are the same, so that
  /// no torque steps there.
  void ContinueAccelerations(int from, int to);
  static std::vector<collocation::Bounds> HeldSoles() { return HeldSolesAnd(0); }
  static std::vector<collocation::Bounds> HeldSolesAnd(std::size_t hands);
  /// The points from `first_point` on begin the phase at their places in the landing stance.
  void StartPlaced(int phase, int first_point);
  /// The phase ends at rest in the landing stance.
  void EndAtRest(int phase);
  /// Planar joints that neither the root nor the contacts of the landing stance determine.
  std::vector<int> FreeJointsAtRest() const;
  /// Keeps points at least `clearance` above the ground.
  void KeepAbove(int phase, const std::string& name,
                 const std::vector<dynamics::ContactPoint>& points, double clearance,
                 collocation::At at);
  void KeepAbove(int phase, const std::string& name,
                 const std::vector<dynamics::ContactPoint>& points,
                 const std::vector<double>& clearances, collocation::At at);
  /// Keeps the guards above the ground by their radii plus settings.body_clearance.
  void KeepBodyAbove(int phase, collocation::At at);
  /// Keeps hands and the rounded ends of their pegs above the ground. A peg that is tilted at
  /// touchdown enters the ground slightly with its round end.
  void KeepHandsAbove(int phase, double clearance, collocation::At at);
  /// Avoids self-collision: joints within their free ranges, feet away from the trunk.
  void StayWithinRanges(int phase, collocation::At at);
  void KeepUpright(int phase, const dynamics::ContactPoint& hand, collocation::At at,
                   const std::string& name);
  void KeepBent(int phase, const std::string& name, const SagittalModel::Limb& limb, double reach,
                collocation::At at);
  void AddCosts();
  /// Durations from multiples of the robot's unit of time (NaturalUnits).
  collocation::Bounds Times(const collocation::Bounds& multiples) const;
  /// Initial guess: a straight line between two fractions of the way from stance to stance.
  /// `duration` in the robot's unit of time.
  void GuessLine(int phase, double duration, double from, double to);

  const SagittalModel& model_;
  double distance_;
  double height_;
  /// The ground; none if it is level.
  std::optional<collocation::SmoothStep> step_;
  SagittalSettings settings_;
  collocation::OptimalControlProblem problem_;
  std::vector<collocation::RobotPhase> phases_;
};

}  // namespace possibility::actions
