#pragma once

#include <optional>
#include <string>
#include <vector>

#include "actions/sagittal/sagittal_model.h"
#include "collocation/problem/optimal_control_problem.h"
#include "collocation/robot/sagittal_phase.h"
#include "collocation/robot/step_clearance.h"

namespace possibility::actions {

/// What a dynamic action in the sagittal plane may use, and how far it stays from what must not
/// happen.
struct SagittalSettings {
  /// What is left to the whole robot's asymmetry and to feedback: some of everything.
  collocation::SagittalLimits limits = {.friction_fraction = 0.65,
                                        .speed_fraction = 0.9,
                                        .torque_fraction = 0.9,
                                        .max_base_speed = 8,
                                        .min_normal_force = 30,
                                        .joint_margin = 0.03};
  double body_clearance = 0.02;  ///< m, what is around the guards above the ground in every phase
  double hand_clearance = 0.03;  ///< m, hands above the ground they leave
  double hand_approach = 0.01;   ///< m, hands above the ground they are about to touch
  /// Heel and toe each bear at least this fraction of what the sole bears, while it is flat.
  double sole_margin = 0.1;
  double max_hand_tilt = 0.35;  ///< rad, of a bearing hand from how the stance has it
  /// Of a stretched arm's length, while a hand bears: a straight arm could not follow the body to
  /// either side.
  double arm_reach = 0.96;
};

/// From where the launch ground ends to where the landing ground begins, along x in the frame of
/// the launch stance, m, if both are no longer than the contacts need. Empty (upper < lower) if the
/// robot lands before where it stood.
collocation::Bounds GapBetween(const SagittalModel& model, double distance);

/// An optimal-control problem of a robot that moves from SagittalModel's launch stance to its
/// landing stance, whose frame is at `distance` and `height` (m) in the frame of the launch.
/// Derived classes say in which phases; this class has what they share. Minimises joint
/// accelerations and contact forces.
class SagittalProblem {
 public:
  SagittalProblem(const SagittalProblem&) = delete;
  SagittalProblem& operator=(const SagittalProblem&) = delete;

  const collocation::OptimalControlProblem& problem() const { return problem_; }
  const collocation::SagittalPhase& phase(int index) const { return phases_[index]; }

 protected:
  SagittalProblem(const std::string& name, const SagittalModel& model, double distance,
                  double height, const SagittalSettings& settings);
  ~SagittalProblem() = default;

  std::vector<dynamics::ContactPoint> Feet() const;          ///< heel and toe
  std::vector<dynamics::ContactPoint> FeetAndHands() const;  ///< heel, toe, hands
  void AddPhase(const std::string& name, const std::vector<dynamics::ContactPoint>& points,
                collocation::Bounds duration);

  /// The phase begins at rest in SagittalModel::ready().
  void StartAtRest(int phase);
  /// The phase's points do not move: no velocities and no accelerations at the knots. With
  /// velocities at all nodes instead, two of them would determine the accelerations of the interval
  /// by those at its start, and what is wrong there would stay wrong in every interval after it.
  /// `held`: of x and z of each point.
  void HoldPoints(int phase, const std::vector<collocation::Bounds>& held, collocation::At at);
  /// Heel and toe, the phase's first two points, do not move, and both bear.
  void HoldSoles(int phase, collocation::At at);
  /// Heel, toe and hands do not move; arms are never straight.
  void HoldFeetAndHands(int phase, collocation::At at);
  /// The points of the phase begin it without acceleration. Velocities at the nodes leave the
  /// acceleration at the first one free, and an error there comes back with alternating sign at
  /// every node after it.
  void StartHeld(int phase, const std::vector<collocation::Bounds>& held);
  static std::vector<collocation::Bounds> HeldSoles() { return HeldSolesAnd(0); }
  static std::vector<collocation::Bounds> HeldSolesAnd(std::size_t hands);
  /// The points from `first_point` on begin the phase where the landing stance has them.
  void StartPlaced(int phase, int first_point);
  /// The phase ends at rest in the landing stance.
  void EndAtRest(int phase);
  /// Points at least `clearance` above the ground.
  void KeepAbove(int phase, const std::string& name,
                 const std::vector<dynamics::ContactPoint>& points, double clearance,
                 collocation::At at);
  void KeepAbove(int phase, const std::string& name,
                 const std::vector<dynamics::ContactPoint>& points,
                 const std::vector<double>& clearances, collocation::At at);
  /// The guards, by their radii and settings.body_clearance.
  void KeepBodyAbove(int phase, collocation::At at);
  /// Hands and the rounded ends of their pegs; a peg that leans when it is set down goes into the
  /// ground with its round end by a little.
  void KeepHandsAbove(int phase, double clearance, collocation::At at);
  /// Joints where the robot does not run into itself, feet away from the trunk.
  void StayWithinRanges(int phase, collocation::At at);
  void KeepUpright(int phase, const dynamics::ContactPoint& hand, collocation::At at,
                   const std::string& name);
  void KeepBent(int phase, const std::string& name, const SagittalModel::Limb& limb, double reach,
                collocation::At at);
  void AddCosts();
  /// A straight line between shares of the way from stance to stance.
  void GuessLine(int phase, double duration, double from, double to);

  const SagittalModel& model_;
  double distance_;
  double height_;
  /// The ground, if it is not level.
  std::optional<collocation::SmoothStep> step_;
  SagittalSettings settings_;
  collocation::OptimalControlProblem problem_;
  std::vector<collocation::SagittalPhase> phases_;
};

}  // namespace possibility::actions
