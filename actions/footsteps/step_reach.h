#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "actions/footholds/footstep.h"
#include "actions/wholebody/limb_reach.h"
#include "actions/wholebody/nominal_stance.h"
#include "models/robot/robot_model.h"

namespace possibility::actions {

/// How high the root can be while one of two limbs bears alone and the other one reaches a place.
/// Immutable.
class StepReach {
 public:
  /// `stance`: of a gait that FootstepSearch knows; must outlive this.
  StepReach(const models::RobotModel& robot, const NominalStance& stance);

  /// m above the ground of the limb that bears at `other`; none if the place is out of reach.
  std::optional<double> HighestRoot(int limb, const Foothold& place, const Foothold& other) const;
  /// All through a step.
  std::optional<double> HighestRoot(const Footstep& step, const Foothold& other) const;

 private:
  Eigen::Vector2d RootOver(int limb) const;

  const NominalStance& stance_;
  std::vector<std::optional<LimbReach>> reaches_;
  std::array<Eigen::Vector2d, 2> root_over_;  ///< of the stance: the root over a limb that bears
};

}  // namespace possibility::actions
