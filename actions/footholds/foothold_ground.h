#pragma once

#include <optional>
#include <vector>

#include "actions/conditions/quasi_static_action.h"
#include "actions/motion/swing_path.h"
#include "actions/wholebody/nominal_stance.h"
#include "actions/wholebody/planar_pose.h"
#include "models/robot/robot_model.h"
#include "models/shapes/upright_boxes.h"
#include "models/world/collision.h"

namespace possibility::actions {

/// Where a limb bears: the stance that it stands in, seen from above, and its ground.
struct Foothold {
  PlanarPose stance;
  double z = 0;                                       ///< m, of the ground under the patch's centre
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< of the ground, unit
  double offset = 0;                                  ///< of a slope (models::GroundPlane), m
  double friction = models::kRobotsFriction;          ///< of the ground (models::GroundPlane)

  bool IsLevel() const { return normal == Eigen::Vector3d::UnitZ(); }
};

bool AreOnOneSlope(const Foothold& a, const Foothold& b);

/// The stance frame S as the limb's patch carries it, in the world: S itself on level ground;
/// otherwise tilted with the ground, about the patch's centre.
Eigen::Isometry3d FrameOf(const NominalStance& stance, int limb, const Foothold& place);

/// Pose of the limb's patch there (models::ContactPatch::Frame).
Eigen::Isometry3d PatchPoseOf(const NominalStance& stance, int limb, const Foothold& place);

/// Planes of the ground on which friction holds a foot.
std::vector<int> GentlePlanes(const models::RobotModel& robot, const models::GroundMap& ground);

/// Where single limbs of a gait may bear, and how they get there. Const functions may run in
/// several threads.
class FootholdGround {
 public:
  /// All arguments must outlive this. `margin`: m, of bearing points from the edge of their ground.
  FootholdGround(const models::RobotModel& robot, const NominalStance& stance, const World& world,
                 double margin);

  /// The limb on ground of a plane, which is one of planes(). Where the ground ends under the limb,
  /// it is moved to where it does not, and where its link would hit something, ahead or back; by
  /// kMostShift at most. None if that does not help.
  std::optional<Foothold> Place(int limb, const PlanarPose& stance, int plane) const;

  const std::vector<int>& planes() const { return planes_; }  ///< GentlePlanes
  /// There, were it ground.
  Foothold On(int limb, const PlanarPose& stance, int plane) const;

  /// Least lift (SwingPath) with which the limb's link swings from one place to the other without a
  /// hit. None if both no lift and `most` (m) lead to one.
  std::optional<double> LiftBetween(int limb, const Foothold& from, const Foothold& to,
                                    double clearance, double most) const;

  static constexpr double kMostShift = 0.06;  ///< m

 private:
  bool Holds(int limb, int plane, const Foothold& place) const;
  std::optional<PlanarPose> Settled(int limb, const PlanarPose& stance, int plane) const;
  Eigen::Vector2d ClearanceGradient(int plane, const Eigen::Vector2d& p) const;
  /// Whether the box about the limb's link is free, in a stance frame.
  bool IsFree(int limb, const Eigen::Isometry3d& X_WS) const;
  bool SwingIsFree(int limb, const Foothold& from, const Foothold& to, double clearance,
                   double lift) const;

  const NominalStance& stance_;
  const World& world_;
  double margin_;
  std::vector<int> planes_;
  models::CollisionChecker checker_;
  std::vector<models::UprightBoxes> feet_;  ///< by limb: boxes about its link, in the stance frame
};

}  // namespace possibility::actions
