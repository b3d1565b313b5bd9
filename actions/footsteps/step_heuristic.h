#pragma once

#include <optional>
#include <vector>

#include "actions/conditions/quasi_static_action.h"
#include "actions/footholds/foothold_field.h"
#include "actions/footholds/pose_field.h"
#include "actions/footholds/step_ground.h"
#include "actions/footsteps/step_rules.h"
#include "common/cancellation_token.h"

namespace possibility::actions {

/// Where steps lead: goals, and how long it takes from each of them on.
struct StepGoals {
  std::vector<GroundedStance> stances;
  std::vector<double> times;  ///< s; empty: all 0

  double TimeFrom(int goal) const { return times.empty() ? 0 : times[goal]; }
};

/// Expected time of steps from a place to the goals: the greater one of a field of footholds and a
/// field of poses. Of gaits on other than two soles: of the field of poses alone, which then knows
/// only where the trunk is free above some ground.
class StepHeuristic {
 public:
  /// `starts`: where the search begins. `is_relaxed`: rules out less, for a search that found
  /// nothing. References must outlive this.
  StepHeuristic(const StepRules& rules, const StepGround& known, const World& world,
                const StepGoals& goals, const std::vector<GroundedStance>& starts, bool is_relaxed);
  StepHeuristic(const StepHeuristic&) = delete;
  StepHeuristic& operator=(const StepHeuristic&) = delete;

  /// From a pose between both limbs on a layer (index into FootholdGround::planes()), s; infinite
  /// if there is no way.
  double At(int layer, const PlanarPose& pose, const CancellationToken& cancellation = {}) {
    return poses_->At(layer, pose, cancellation);
  }
  /// Whether no other goal seems quicker by way of this one.
  bool IsBest(int goal);

  /// Of the plane that a limb is on; -1 if there is none.
  int LayerUnder(int limb, const Foothold& place) const;

 private:
  FootholdField::StepTimes TimesOfSteps() const;
  void AddStep(int limb, const PlanarPose& displacement, double rise,
               const FootholdField::StepTimes& steps, std::vector<double>* times) const;
  PoseField::Paces PacesOfPoses() const;
  PoseField PosesField(const std::vector<GroundedStance>& starts);
  bool MayStandAt(int layer, const PlanarPose& pose);

  const StepRules& rules_;
  const StepGround& known_;
  const World& world_;
  const StepGoals& goals_;
  bool is_relaxed_;
  std::optional<FootholdField> footholds_;  ///< of gaits on two soles
  std::optional<PoseField> poses_;
};

}  // namespace possibility::actions
