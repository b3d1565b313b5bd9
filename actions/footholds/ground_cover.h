#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "actions/footholds/sole_disc.h"
#include "actions/wholebody/nominal_stance.h"
#include "models/shapes/bounds_tree.h"
#include "models/shapes/prepared_shape.h"
#include "models/world/environment.h"

namespace possibility::actions {

/// Where solids stand on horizontal ground, so that no foot does: the floor under a pallet is
/// ground, but covered. It claims less than there is (SoleDisc). Immutable once built.
class GroundCover {
 public:
  GroundCover(const NominalStance& stance, const models::Environment& environment);

  /// Whether no sole bears with its centre in a square on horizontal ground at z. `half`: half the
  /// square's side; m.
  bool Covers(const Eigen::Vector2d& centre, double half, double z) const;
  /// Whether nothing stands on ground at z within `distance` of p; m.
  bool IsBare(const Eigen::Vector2d& p, double distance, double z) const;

 private:
  struct Solid {
    models::PreparedShape shape;
    Eigen::Isometry3d X_WC;  ///< of the shape's core
  };

  SoleDisc disc_;
  std::vector<Solid> solids_;
  models::BoundsTree tree_;
};

}  // namespace possibility::actions
