#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "actions/footholds/footstep.h"
#include "actions/wholebody/limb_reach.h"
#include "actions/wholebody/nominal_stance.h"
#include "models/robot/robot_model.h"

namespace possibility::actions {

/// How high the root can be while a limb swings and the others bear. Immutable.
class StepReach {
 public:
  /// `stance`: of a gait whose steps can be searched; must outlive this.
  StepReach(const models::RobotModel& robot, const NominalStance& stance);

  /// While the limb is at its place of `feet` but does not bear, m above the ground of the others
  /// (RestOf). None if a place is out of reach, or several limbs that bear cannot balance the
  /// robot.
  std::optional<double> HighestRoot(const std::vector<Foothold>& feet, int limb) const;

 private:
  Eigen::Vector2d RootOver(int limb) const;
  std::optional<double> HighestOverOne(const std::vector<Foothold>& feet, int limb) const;
  std::optional<double> HighestOverMany(const std::vector<Foothold>& feet, int limb) const;
  std::optional<double> HighestOver(const PlanarPose& root, int limb, const Foothold& place) const;

  const NominalStance& stance_;
  std::vector<std::optional<LimbReach>> reaches_;
  /// Of the stance: the root over a limb that bears alone. Of two limbs.
  std::vector<Eigen::Vector2d> root_over_;
};

}  // namespace possibility::actions
