#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "actions/plan/plan.h"
#include "actions/wholebody/whole_body_task.h"
#include "common/cancellation_token.h"
#include "dynamics/contact/contact_forces.h"
#include "models/robot/robot_model.h"

namespace possibility::actions {

/// A part of a motion with one set of contacts, as tasks over time.
struct MotionPhase {
  double duration = 0;                          ///< s
  std::vector<int> contacts;                    ///< bearing patches
  std::vector<Eigen::Vector3d> normals;         ///< of their ground, unit; empty: level ground
  std::vector<double> friction;                 ///< of their ground; empty: the robot's own
  std::vector<int> coming_down;                 ///< of these, those that did not bear before
  std::function<WholeBodyTask(double t)> task;  ///< t in [0, duration]
};

struct MotionSettings {
  double knot_spacing = 0.1;  ///< s, at most
  /// Per phase. Between knots forces are interpolated linearly but the motion's accelerations are
  /// not; the difference uses up part of the margins below.
  int minimum_intervals = 12;
  double speed_margin = 0.95;     ///< usable fraction of each joint's speed limit
  double friction_margin = 0.85;  ///< fraction of the friction coefficient
  double normal_reserve = 0.01;   ///< of the weight, least load of every bearing point
  double torque_margin = 0.95;    ///< fraction of each joint's effort limit
  /// Whether forces and torques are tested between knots, too, against the whole of the limits
  /// (ForceFaultBetween). Where they fail, knots are added, up to a fourth of their distance.
  bool tests_between_knots = false;
};

/// The number of equal intervals between knots of a phase: the least of which none lasts longer
/// than `spacing`, s, but at least `least`.
int NumIntervals(double duration, double spacing, int least);

/// The robot with a motor at every joint. What coupled joints need together is checked apart.
std::shared_ptr<const dynamics::MultibodyModel> UncoupledModel(models::RobotModel robot);

/// @throws MotionError naming the joint that leaves its position limits, or is faster than
/// `speed_margin` of its speed limit, at time `t`.
void RequireJointLimits(const models::RobotModel& robot, const Eigen::VectorXd& q,
                        const Eigen::VectorXd& v, double speed_margin, double t);

/// Turns task-level motion into knots with joint motion, torques and contact forces that satisfy
/// inverse dynamics, limits and friction cones. A patch takes up its load over the phase in which
/// it comes down, and gives it up over the phase before it lifts, as far as balance allows. One
/// instance per thread.
class MotionBuilder {
 public:
  explicit MotionBuilder(const models::RobotModel& robot, const MotionSettings& settings = {});

  /// `guess`: q near the start (nq). Times start at 0. Asks `cancellation` before every
  /// phase.
  /// @throws MotionError naming the limit that the motion would exceed and the time; Cancelled.
  std::vector<Phase> Build(const std::vector<MotionPhase>& phases, const Eigen::VectorXd& guess,
                           const CancellationToken& cancellation = {});

 private:
  struct Bearing;

  /// `before`, `after`: the phases next to it, null at the ends.
  Phase BuildPhase(const MotionPhase& phase, const MotionPhase* before, const MotionPhase* after,
                   double start, Eigen::VectorXd* guess);
  Knot MakeKnot(const MotionPhase& phase, const Bearing& bearing, double t, Eigen::VectorXd* guess);
  /// Appends a knot, and `halvings` times those between it and the last one that are needed.
  void Append(const MotionPhase& phase, const Bearing& bearing, double start, Knot knot,
              int halvings, std::vector<Knot>* knots);
  void CheckCoupledTorques(const Eigen::VectorXd& torques, const Eigen::VectorXd& v,
                           double t) const;

  const models::RobotModel* robot_;
  MotionSettings settings_;
  WholeBodySolver solver_;
  dynamics::MultibodyDynamics dynamics_;  // every joint with a motor of its own
};

/// The same motion backwards in time. The same forces realise it, quasi-static or not, and the same
/// torques but for the joints' friction.
std::vector<Phase> Reversed(const models::RobotModel& robot, const std::vector<Phase>& phases);

}  // namespace possibility::actions
