#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "actions/conditions/locomotion_model.h"
#include "actions/conditions/quasi_static_action.h"
#include "actions/flood/route_flood.h"
#include "actions/plan/plan.h"
#include "common/cancellation_token.h"
#include "models/world/collision.h"

namespace possibility::actions {

/// Measures the room on a way and the room that each gait and manoeuvre needs. For messages only:
/// nothing here decides what is possible.
class PassageGauge {
 public:
  /// All arguments must outlive this object.
  PassageGauge(const LocomotionModel& model, const World& world,
               const std::vector<FloodManoeuvre>& manoeuvres);

  /// The place of a way with the most missing room, or the smallest margin, for the action that
  /// fits best there; none if the way is wide and high everywhere. Asks
  /// `cancellation` at every place; once cancelled, skips the rest.
  std::optional<NarrowPassage> Narrowest(const std::vector<GroundedStance>& way,
                                         const CancellationToken& cancellation) const;

 private:
  /// A place on the way and the height of its ground.
  struct Place {
    Eigen::Vector2d p;
    double z;
  };
  /// How a gait fits into a place.
  struct Fit {
    PassageNeed need = {};
    double missing = 0;                                 ///< m; negative: margin
    Eigen::Vector2d across = Eigen::Vector2d::UnitX();  ///< for a width: unit vector
    Eigen::AlignedBox3d gauged = {};  ///< for a width: the slab of height measured
  };
  struct Slab {
    Eigen::AlignedBox3d box;
    double room = 0;  ///< m, to both sides
  };

  std::vector<Place> Along(const std::vector<GroundedStance>& way) const;
  bool IsWide(const Place& place) const;
  bool HasGround(const Eigen::Vector2d& p, double z) const;
  std::optional<NarrowPassage> GapAt(const Place& place) const;
  std::optional<NarrowPassage> PassageAt(const Place& place) const;
  std::optional<Fit> FitOf(int gait, const Place& place) const;
  std::optional<Fit> WidthFor(int gait, const Place& place, double clear_height) const;
  double ClearHeight(const Place& place, double at_most) const;
  double RoomTowards(const Place& place, const Eigen::Vector2d& direction, double low,
                     double high) const;
  double Reach(const FloodManoeuvre& manoeuvre) const;
  void NameSides(const Fit& fit, const Place& place, NarrowPassage* passage) const;

  const LocomotionModel& model_;
  const World& world_;
  const std::vector<FloodManoeuvre>& manoeuvres_;
  models::CollisionChecker checker_;
};

}  // namespace possibility::actions
