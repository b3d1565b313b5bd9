#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "actions/plan/plan.h"
#include "actions/sagittal/sagittal_model.h"
#include "actions/wholebody/motion_builder.h"
#include "actions/wholebody/nominal_stance.h"
#include "collocation/transcription/transcription.h"

namespace possibility::actions {

/// Bearing contacts and their places.
struct Support {
  std::vector<int> contacts;  ///< whole patches
  std::vector<std::string> names;
  std::vector<dynamics::ContactPoint> points;
  std::vector<LimbTask> limbs;
  std::vector<int> coming_down;  ///< contacts that take up their load gradually
};

/// Turns a sagittal plan into motion of the whole robot in stance: soles and pegs stay exactly in
/// place, the root and all other joints move as planned, and earlier deviations due to the robot's
/// asymmetry decay. Everything is relative to the launch stance's frame. One per thread.
class StanceMotion {
 public:
  /// All arguments must outlive this object.
  StanceMotion(const models::RobotModel& robot, const SagittalModel& model,
               const NominalStance& launch, const NominalStance& landing);

  const models::RobotModel& robot() const { return robot_; }
  const SagittalModel& model() const { return model_; }
  const MotionSettings& settings() const { return settings_; }

  Support LaunchFeet() const;  ///< the launch's patches at their places in that stance
  Support Toes() const;        ///< their foremost points; bears no limb task
  /// The launch's patches at their places in the landing stance, whose frame is at `distance`,
  /// `height`.
  Support LandingFeet(double distance, double height) const;
  /// Including hands, which have just come down.
  Support LandingAll(double distance, double height) const;

  /// Whether a joint of the launch stance is not as in SagittalModel::ready().
  bool NeedsPreparation() const;
  /// At rest, from the launch stance to SagittalModel::ready().
  Phase Prepare() const;
  /// A motion from the launch stance at rest. `follow` makes its first phase from a knot. The
  /// joints that are not as in SagittalModel::ready() turn while the robot follows the plan; if it
  /// cannot, or if it would hit itself or the ground, they turn in a phase before.
  std::vector<Phase> Begin(const std::function<Phase(const Knot& from)>& follow) const;
  /// Root and free joints begin as in `from` and approach the plan; at the end the joints and their
  /// rates differ from the plan by `end_offset` and `end_rate`. The limbs of the support stay in
  /// place.
  /// @throws MotionError naming the limit that the whole robot would exceed.
  Phase Follow(const collocation::PhaseTrajectory& plan, const Knot& from, const Support& support,
               const Eigen::VectorXd& end_offset, const Eigen::VectorXd& end_rate) const;
  /// The same, ending as planned.
  Phase Follow(const collocation::PhaseTrajectory& plan, const Knot& from,
               const Support& support) const;
  /// The same, ending with the limbs of `arriving` at their places and at zero speed.
  Phase FollowUntilPlaced(const collocation::PhaseTrajectory& plan, const Knot& from,
                          const Support& support, const Support& arriving);

  /// q and v of the plan at fraction s of its duration.
  Knot PlannedKnot(const collocation::PhaseTrajectory& plan, double s) const;
  /// All joints at time t of a plan.
  Signal<Eigen::VectorXd> Joints(const collocation::PhaseTrajectory& plan, double t) const;
  /// The limbs of a support at their places and at zero speed, everything else as in `knot`.
  /// @throws MotionError if that is out of reach.
  WholeBodyState StateAt(const Knot& knot, const Support& support);

 private:
  /// Time in which joints turn by `offset` within a share of their speed limits, s.
  double TurningTime(const Eigen::VectorXd& offset, double speed_share) const;
  Eigen::VectorXd ReadyJoints() const;
  /// Whether the motion on the launch's ground hits anything.
  bool Hits(const Phase& phase) const;
  Support SupportOf(const NominalStance& stance, const std::vector<int>& contacts, double x,
                    double z) const;

  const models::RobotModel& robot_;
  const SagittalModel& model_;
  const NominalStance& launch_;
  const NominalStance& landing_;
  std::vector<int> feet_;  ///< patches of the launch
  std::vector<int> all_;   ///< patches of the landing
  MotionSettings settings_;
  WholeBodySolver solver_;
};

}  // namespace possibility::actions
