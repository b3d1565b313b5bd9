#pragma once

#include <Eigen/Geometry>

#include "actions/wholebody/nominal_stance.h"
#include "models/shapes/prepared_shape.h"

namespace possibility::actions {

/// The greatest thin disc about the centre of every sole of a stance, a little above its ground:
/// part of a foot, however it is turned. It stands for feet where a proof must claim too little
/// rather than too much.
class SoleDisc {
 public:
  explicit SoleDisc(const NominalStance& stance);

  double radius() const { return radius_; }  ///< m
  /// Whether the disc hits a solid when the sole's centre is at `p` on ground at z (m).
  bool Hits(const models::PreparedShape& solid, const Eigen::Isometry3d& X_WC,
            const Eigen::Vector2d& p, double z) const;

  /// m, of the disc's middle above the ground: within the foot.
  static constexpr double kAboveSole = 5e-3;

 private:
  double radius_;
  models::PreparedShape disc_;
};

}  // namespace possibility::actions
