#pragma once

#include <optional>
#include <vector>

#include "actions/conditions/quasi_static_action.h"
#include "actions/motion/nominal_stance.h"
#include "actions/motion/planar_pose.h"
#include "actions/motion/swing_path.h"
#include "models/robot/robot_model.h"
#include "models/shapes/upright_boxes.h"
#include "models/world/collision.h"

namespace possibility::actions {

/// Where a limb bears: the stance that it stands in, and the height of its ground.
struct Foothold {
  PlanarPose stance;
  double z = 0;  ///< m
};

/// Where single limbs of a gait may bear, and how they get there. Const functions may run in
/// several threads.
class FootholdGround {
 public:
  /// All arguments must outlive this. `margin`: m, of bearing points from the edge of their ground.
  FootholdGround(const models::RobotModel& robot, const NominalStance& stance, const World& world,
                 double margin);

  /// The limb on ground of a level. Where the ground ends under the limb, or its link would hit
  /// something, it is moved ahead or back, by kMostShift at most. None if that does not help.
  std::optional<Foothold> Place(int limb, const PlanarPose& stance, int level) const;

  /// Least lift (SwingPath) with which the limb's link swings from one place to the other without a
  /// hit. None if `most` (m) is not enough.
  std::optional<double> LiftBetween(int limb, const Foothold& from, const Foothold& to,
                                    double clearance, double most) const;

  static constexpr double kMostShift = 0.06;  ///< m

 private:
  bool Holds(int limb, int level, const PlanarPose& stance) const;
  bool IsFree(int limb, const PlanarPose& stance, double z) const;
  bool SwingIsFree(int limb, const Foothold& from, const Foothold& to, double clearance,
                   double lift) const;

  const NominalStance& stance_;
  const World& world_;
  double margin_;
  models::CollisionChecker checker_;
  std::vector<models::UprightBoxes> feet_;  ///< by limb: box about its link, in the stance frame
};

}  // namespace possibility::actions
