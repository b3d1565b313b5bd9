#pragma once

#include <memory>
#include <string>
#include <vector>

#include "actions/motion/motion_builder.h"
#include "actions/motion/nominal_stance.h"
#include "actions/plan/plan.h"
#include "actions/sagittal/sagittal_model.h"
#include "collocation/transcription/transcription.h"

namespace possibility::actions {

/// What bears, and where it stays.
struct Support {
  std::vector<int> contacts;  ///< whole patches
  std::vector<std::string> names;
  std::vector<dynamics::ContactPoint> points;
  std::vector<LimbTask> limbs;
};

/// A sagittal plan turned into motion of the whole robot while it stands on something: soles and
/// pegs stay exactly where they are, the root and all other joints move as planned, and whatever
/// the robot's asymmetry has added before dies out. Everything is relative to the launch stance's
/// frame. One per thread.
class StanceMotion {
 public:
  /// All must outlive it.
  StanceMotion(const models::RobotModel& robot, const SagittalModel& model,
               const NominalStance& launch, const NominalStance& landing);

  const models::RobotModel& robot() const { return robot_; }
  const SagittalModel& model() const { return model_; }
  const MotionSettings& settings() const { return settings_; }

  Support LaunchFeet() const;  ///< the patches of the launch, where that stance has them
  Support Toes() const;        ///< their foremost points; bears no limb task
  /// The launch's patches where the landing stance has them, its frame at `task`.
  Support LandingFeet(double distance, double height) const;
  Support LandingAll(double distance, double height) const;  ///< hands too

  /// At rest, from the launch stance to SagittalModel::ready().
  Phase Prepare() const;
  /// Root and free joints begin as `from` has them, approach the plan, and end with the joints and
  /// their rates beside it by what is given; the limbs of the support stay where they are.
  /// @throws MotionError naming the limit that the whole robot would break.
  Phase Follow(const collocation::PhaseTrajectory& plan, const Knot& from, const Support& support,
               const Eigen::VectorXd& end_offset, const Eigen::VectorXd& end_rate) const;
  /// The same, ending as planned.
  Phase Follow(const collocation::PhaseTrajectory& plan, const Knot& from,
               const Support& support) const;
  /// The same, ending with the limbs of `arriving` at their places and at no speed.
  Phase FollowUntilPlaced(const collocation::PhaseTrajectory& plan, const Knot& from,
                          const Support& support, const Support& arriving);

  /// q and v of the plan at share s of its duration.
  Knot PlannedKnot(const collocation::PhaseTrajectory& plan, double s) const;
  /// All joints at time t of a plan.
  Signal<Eigen::VectorXd> Joints(const collocation::PhaseTrajectory& plan, double t) const;
  /// The limbs of a support at their places and at no speed, all else as in `knot`.
  /// @throws MotionError if that is out of reach.
  WholeBodyState StateAt(const Knot& knot, const Support& support);

 private:
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
