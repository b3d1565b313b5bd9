#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "actions/conditions/reachable_region.h"
#include "actions/gait/gait_motion.h"
#include "actions/gait/swept_volume.h"
#include "actions/plan/plan.h"
#include "actions/wholebody/nominal_stance.h"
#include "models/robot/robot_model.h"

namespace possibility::actions {

/// The part of a robot's locomotion that does not depend on the scene: nominal stance and swept
/// volumes of each gait, and the transitions between gaits. Immutable, safe to share between
/// threads.
struct LocomotionModel {
  struct GaitEntry {
    models::Gait gait;  ///< of the robot's file or a GaitFactory; stance.gait points here
    NominalStance stance;
    std::unique_ptr<GaitMotion> motion;
    GaitVolumes volumes;
    std::vector<ReachableRegion> regions;  ///< by limb
  };
  struct TransitionEntry {
    int from = 0;  ///< indices into gaits
    int to = 0;
    PlanarPose displacement;    ///< second gait's stance frame in the first gait's
    std::vector<Phase> phases;  ///< in the first gait's stance frame; backwards: Reversed()
    std::vector<Eigen::AlignedBox3d> sweep;  ///< in the first gait's stance frame

    double rest_time = 0;  ///< s: of both gaits, before and after the transition

    double ExpectedDuration() const { return rest_time + phases.back().knots.back().t; }  ///< s
  };

  const models::RobotModel* robot = nullptr;
  std::vector<std::unique_ptr<GaitEntry>> gaits;
  std::vector<TransitionEntry> transitions;

  /// Index of the gait called `name`, or -1.
  int GaitIndex(const std::string& name) const;
};

/// Solves the stances, the transitions and the swept volumes of the gaits named in `actions`: those
/// of the robot's file and of `further`. Jumps in `actions` add nothing. Gaits of one stance get a
/// transition that stands still. `robot` must outlive the result. `library`: folder of solved
/// transitions and fitted paces, empty for none. The result does not depend on `threads`,
/// all of which ask `cancellation`.
/// @throws InputError if an action does not exist, if a factory names no gait of the robot, is
/// empty or makes nothing, or a gait's bounds allow a stride that the robot
/// cannot execute (every extreme stride is generated and checked here); Cancelled.
LocomotionModel BuildLocomotionModel(const models::RobotModel& robot,
                                     const std::vector<std::string>& actions,
                                     const CancellationToken& cancellation = {},
                                     const std::filesystem::path& library = {},
                                     const std::vector<GaitFactory>& further = {}, int threads = 1);

/// Upper bound, over all joint positions, of the distance from the root's origin to a point of
/// `patch`, m.
double ChainLength(const models::RobotModel& robot, const models::ContactPatch& patch);

/// Upper bound of the distance from the root's origin to any bearing point of the gait, m.
double BearingReach(const models::RobotModel& robot, const models::Gait& gait);

/// The robot standing in a gait's nominal posture on a ground level.
struct GroundedStance {
  int gait = 0;
  PlanarPose pose;
  double z = 0;  ///< m, height of the ground
};

/// The stance with root pose `X_WR`; none unless that pose is nominal for `gait` (to 1e-6 in tilt).
std::optional<GroundedStance> AsStance(const LocomotionModel& model, int gait,
                                       const Eigen::Isometry3d& X_WR);

}  // namespace possibility::actions
