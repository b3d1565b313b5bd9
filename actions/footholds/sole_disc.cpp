#include "actions/footholds/sole_disc.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "models/shapes/signed_distance.h"

namespace possibility::actions {
namespace {

using Eigen::Vector2d;

constexpr double kThickness = 1e-3;         // m
constexpr double kDistanceRounding = 1e-4;  // m: distances are too small by less

/// Radius of the greatest disc about the centres of all patches that the bearing points surround.
double RadiusOf(const NominalStance& stance) {
  double radius = std::numeric_limits<double>::infinity();
  for (std::size_t limb = 0; limb < stance.bearing_points.size(); ++limb) {
    const Vector2d centre = stance.patch_centres[limb].head<2>();
    const std::vector<Vector2d>& points = stance.bearing_points[limb];
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vector2d from = points[i] - centre;
      const Vector2d along = points[(i + 1) % points.size()] - points[i];
      const double length = along.norm();
      // With fewer than three points, or not in order, there may be none.
      const double away = length > 0 ? (along.x() * from.y() - along.y() * from.x()) / -length : 0;
      radius = std::min(radius, std::max(0.0, away));
    }
  }
  return std::max(0.0, radius - kDistanceRounding);
}

}  // namespace

SoleDisc::SoleDisc(const NominalStance& stance)
    : radius_(RadiusOf(stance)),
      disc_(models::Shape::Cylinder(std::max(radius_, kThickness), kThickness)) {}

bool SoleDisc::Hits(const models::PreparedShape& solid, const Eigen::Isometry3d& X_WC,
                    const Vector2d& p, double z) const {
  const Eigen::Isometry3d X_WD(Eigen::Translation3d(p.x(), p.y(), z + kAboveSole));
  if (solid.core_is_box()) {
    const Eigen::Vector3d away = (X_WC.inverse() * X_WD.translation()).cwiseAbs();
    const double distance = (away - solid.half_extents()).cwiseMax(0).norm() - solid.radius();
    if (distance <= 0) return true;
    if (distance > std::hypot(std::max(radius_, kThickness), kThickness)) return false;
  }
  return models::SignedDistance(disc_, X_WD, solid, X_WC, 0) <= 0;
}

}  // namespace possibility::actions
