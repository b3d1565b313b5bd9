#pragma once

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

/// What single steps of a gait may be: the family that a search chooses from, the tests of a step
/// against ground, obstacles and the robot itself, and its cost. `feet`: where all limbs are; the
/// one that swings stands for one of the ends of its swing. `rest`: RestOf them.
class StepRules {
 public:
  /// A low root needs torque. Steps that need one lower than a little below the nominal posture
  /// count as slower, s/m.
  static constexpr double kSecondsPerSquat = 60;

  /// References must outlive this.
  StepRules(const LocomotionModel& model, int gait, const World& world, const StepGround& known,
            const FootstepLimits& limits);

  const NominalStance& stance() const { return stance_; }
  double Extent() const;  ///< m, from the stance's origin to its farthest limb
  int NumLimbs() const { return static_cast<int>(displacements_.size()); }
  const FootstepLimits& limits() const { return limits_; }
  void SetLowestRoot(double root) { limits_.lowest_root = root; }  ///< m, of the limits
  const FootholdGround& ground() const { return ground_; }

  /// Displacements of a limb's stance in the others' that leave a gap between the patches.
  const std::vector<PlanarPose>& displacements(int limb) const { return displacements_[limb]; }
  /// Whether a displacement in the others' stance is one of the family.
  bool IsWithin(int limb, const PlanarPose& displacement) const;
  /// Number of places of the family about the other limbs: displacements at headings square to
  /// walls, and displacements.
  int NumPlaces(int limb) const;
  /// One of these; none if it does not exist about `rest`.
  std::optional<PlanarPose> PlaceAbout(int limb, const PlanarPose& rest, int number) const;
  struct Place {
    int number = 0;
    PlanarPose stance;
    PlanarPose displacement;  ///< of the other limbs
  };
  /// All that exist about `rest`: one sine and cosine for all of them.
  std::vector<Place> PlacesAbout(int limb, const PlanarPose& rest) const;
  /// StepGround
  const std::vector<double>& headings() const { return headings_; }

  /// How much lower than easy the root has to be for a limb to reach its place while the others
  /// bear, m; at least 0. None if that is too low, or the others cannot balance the robot.
  std::optional<double> Squat(const std::vector<Foothold>& feet, int limb) const;
  /// Whether a limb keeps off the others, seen from above: of two soles their patches, of more
  /// limbs all that is close to the ground.
  bool KeepsOff(const std::vector<Foothold>& feet, int limb) const;
  /// Also on its way to its place, seen from above: where it does not, the legs hit each other,
  /// however high it is lifted.
  bool PassesOthers(const std::vector<Foothold>& feet, int limb, const Foothold& from) const;
  /// Whether the upper part of the body is free between two places, on ground at z (m).
  bool TrunkIsFree(const PlanarPose& middle, double z) const;
  /// The least lift of a swing without a hit, m; none if there is none.
  std::optional<double> LiftBetween(int limb, const Foothold& from, const Foothold& to) const {
    return ground_.LiftBetween(limb, from, to, limits_.clearance, limits_.lift);
  }
  /// FootstepSearch::StepBetween.
  std::optional<Footstep> StepBetween(const std::vector<Foothold>& feet, int limb,
                                      const Foothold& to) const;

  /// Cost of a step of `limb`, s. `squat`: m, the greater one before and after it.
  double Cost(int limb, const Foothold& from, const Foothold& to, const Foothold& rest,
              double squat) const;
  /// `displacement`: `to`, as the other limbs see it.
  double Cost(int limb, const Foothold& from, const Foothold& to, const PlanarPose& displacement,
              const Foothold& rest, double squat) const;
  /// What a long stride takes beyond a short one, s. `ahead`: m, of the other limbs.
  double StrideTime(double ahead, bool is_level) const;

 private:
  std::vector<PlanarPose> DisplacementsOf(int limb) const;
  /// Of more than two limbs: what a place costs that is aside or turned, s.
  double UntidinessTime(const PlanarPose& displacement) const;
  /// Of place `number` about limbs with heading `yaw`; none if there is no such place.
  std::optional<PlanarPose> Displacement(int limb, double yaw, int number) const;
  std::vector<Eigen::Vector2d> OutlineAt(int limb, const PlanarPose& at) const;
  /// m, between a limb's outline at a place and the nearest one of the others; at `feet`, or in the
  /// nominal stance if that is empty.
  double GapToOthers(int limb, const PlanarPose& at, const std::vector<Foothold>& feet) const;
  /// Of two limbs: 1 if the limb is on the left of the other one, else -1. Of more: 0.
  double SideOf(int limb) const;

  const NominalStance& stance_;
  FootstepLimits limits_;
  const World& world_;
  FootholdGround ground_;
  models::CollisionChecker checker_;
  models::UprightBoxes trunk_;
  StepReach reach_;
  const std::vector<double>& headings_;
  /// By limb, in the stance frame: of what must keep off the other limbs.
  std::vector<std::vector<Eigen::Vector2d>> outlines_;
  std::vector<std::vector<PlanarPose>> displacements_;  ///< by limb
};

}  // namespace possibility::actions
