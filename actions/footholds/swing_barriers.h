#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "actions/footholds/footstep.h"
#include "actions/footholds/sole_disc.h"
#include "actions/wholebody/nominal_stance.h"
#include "models/shapes/prepared_shape.h"

namespace possibility::actions {

/// Where obstacles stand that are too high for every swing of a family: no patch's centre passes
/// there, seen from above. Of a patch it knows the greatest disc about its centre alone, so it
/// claims less than there is. Immutable once built.
class SwingBarriers {
 public:
  /// `planes`: of the ground, those that a foot may bear on. `limits`: the family. `reach`: m,
  /// between the centres of both patches (FootholdFlood::ReachOf).
  SwingBarriers(const NominalStance& stance, const World& world, const std::vector<int>& planes,
                const FootstepLimits& limits, double reach);

  bool empty() const { return barriers_.empty(); }
  /// Seen from above: nothing outside is barrier.
  Eigen::AlignedBox2d Bounds() const;
  /// Whether all of a square is barrier. `half`: half its side, m.
  bool Fill(const Eigen::Vector2d& centre, double half) const;

 private:
  struct Barrier {
    models::PreparedShape shape;
    Eigen::Isometry3d X_WC;      ///< of the shape's core
    Eigen::AlignedBox2d bounds;  ///< grown by the disc's radius
    double low = 0, high = 0;    ///< m, of all swings nearby
  };

  /// Whether a disc about this point hits the barrier wherever a swing may be.
  bool Stops(const Barrier& barrier, const Eigen::Vector2d& p) const;

  SoleDisc disc_;
  std::vector<Barrier> barriers_;
};

}  // namespace possibility::actions
