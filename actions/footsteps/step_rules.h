#pragma once

#include <array>
#include <optional>
#include <vector>

#include "actions/conditions/locomotion_model.h"
#include "actions/footholds/foothold_ground.h"
#include "actions/footholds/footstep.h"
#include "actions/footholds/step_ground.h"
#include "actions/footsteps/step_reach.h"
#include "models/shapes/upright_boxes.h"
#include "models/world/collision.h"

namespace possibility::actions {

/// What single steps of a gait with two limbs may be: the family that a search chooses from, the
/// tests of a step against ground, obstacles and the robot itself, and its cost.
class StepRules {
 public:
  /// A low root needs torque. Steps that need one lower than a little below the nominal posture
  /// count as slower, s/m.
  static constexpr double kSecondsPerSquat = 60;

  /// References must outlive this.
  StepRules(const LocomotionModel& model, int gait, const World& world, const StepGround& known,
            const FootstepLimits& limits);

  const NominalStance& stance() const { return stance_; }
  const FootstepLimits& limits() const { return limits_; }
  const FootholdGround& ground() const { return ground_; }

  /// Displacements of a limb's stance in the other's that leave a gap between the patches.
  const std::vector<PlanarPose>& displacements(int limb) const { return displacements_[limb]; }
  /// Whether a displacement in the other limb's stance is one of the family.
  bool IsWithin(int limb, const PlanarPose& displacement) const;
  /// Number of places of the family about the other limb: displacements at headings square to
  /// walls, and displacements.
  int NumPlaces(int limb) const;
  /// One of these; none if it does not exist about `other`.
  std::optional<PlanarPose> PlaceAbout(int limb, const PlanarPose& other, int number) const;
  struct Place {
    int number = 0;
    PlanarPose stance;
    double ahead = 0;  ///< m, of the other limb
  };
  /// All that exist about `other`: one sine and cosine for all of them.
  std::vector<Place> PlacesAbout(int limb, const PlanarPose& other) const;
  /// StepGround
  const std::vector<double>& headings() const { return headings_; }

  /// How much lower than easy the root has to be for a limb to reach a place while the other one
  /// bears, m; at least 0. None if that is too low.
  std::optional<double> Squat(int limb, const Foothold& place, const Foothold& other) const;
  /// Whether a limb's patch keeps off the other one's.
  bool KeepsOff(int limb, const Foothold& place, const Foothold& other) const;
  /// Also on its way, seen from above: where it does not, the legs hit each other, however high it
  /// is lifted.
  bool PassesOther(int limb, const Foothold& from, const Foothold& to, const Foothold& other) const;
  /// Whether the upper part of the body is free between two places, on ground at z (m).
  bool TrunkIsFree(const PlanarPose& middle, double z) const;
  /// The least lift of a swing without a hit, m; none if there is none.
  std::optional<double> LiftBetween(int limb, const Foothold& from, const Foothold& to) const {
    return ground_.LiftBetween(limb, from, to, limits_.clearance, limits_.lift);
  }
  /// FootstepSearch::StepBetween.
  std::optional<Footstep> StepBetween(int limb, const Foothold& from, const Foothold& to,
                                      const Foothold& other) const;

  /// Cost of a step of `limb`, s. `squat`: m, the greater one before and after it.
  double Cost(int limb, const Foothold& from, const Foothold& to, const Foothold& other,
              double squat) const;
  /// `ahead`: m, of `to`, as the other limb sees it.
  double Cost(int limb, const Foothold& from, const Foothold& to, double ahead,
              const Foothold& other, double squat) const;
  /// What a long stride takes beyond a short one, s. `ahead`: m, of the other limb.
  double StrideTime(double ahead, bool is_level) const;

 private:
  std::vector<PlanarPose> DisplacementsOf(int limb) const;
  /// Of place `number` about another limb with heading `yaw`; none if there is no such place.
  std::optional<PlanarPose> Displacement(int limb, double yaw, int number) const;
  /// 1 if the limb is on the left of the other one, else -1.
  double SideOf(int limb) const;

  const NominalStance& stance_;
  FootstepLimits limits_;
  const World& world_;
  FootholdGround ground_;
  models::CollisionChecker checker_;
  models::UprightBoxes trunk_;
  StepReach reach_;
  const std::vector<double>& headings_;
  std::array<std::vector<PlanarPose>, 2> displacements_;
};

}  // namespace possibility::actions
