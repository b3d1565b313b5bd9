#include "actions/flood/launch_box.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <vector>

namespace possibility::actions {
namespace {

using Eigen::Vector2d;

bool GroundIsNear(const models::GroundMap& ground, const Vector2d& p, double z, double distance) {
  const std::vector<double>& levels = ground.levels();
  for (std::size_t level = 0; level < levels.size(); ++level) {
    if (std::abs(levels[level] - z) > 1e-6) continue;
    if (ground.IsNear(static_cast<int>(level), p, distance)) return true;
  }
  return false;
}

/// Sufficient: true only if GroundIsNear is true for every point within `displaced` of p.
bool GroundIsNearAllAround(const models::GroundMap& ground, const Vector2d& p, double z,
                           double distance, double displaced) {
  constexpr double kGroundError = 1e-5;  // m, more than the error of a Clearance
  const double needed = displaced - distance + kGroundError;
  const std::vector<double>& levels = ground.levels();
  for (std::size_t i = 0; i < levels.size(); ++i) {
    if (std::abs(levels[i] - z) > 1e-6) continue;
    const int level = static_cast<int>(i);
    if (needed > 0 && ground.OneFaceHolds(level, p, p, needed)) return true;
    if (ground.Clearance(level, p) >= needed) return true;
  }
  return false;
}

bool LaunchMayStand(const LocomotionModel& model, const models::GroundMap& ground,
                    const LaunchBox& box) {
  return GroundMayHold(model, ground, box.launch.gait, box.middle, box.launch.z,
                       box.half_place.norm(), box.half_heading);
}

bool LandingMayStand(const LocomotionModel& model, const models::GroundMap& ground,
                     const LaunchBox& box) {
  const double swing = box.displacement.position().norm() * box.half_heading;
  const double place = box.half_place.norm() + swing + box.half_displacement.norm();
  return GroundMayHold(model, ground, box.landing.gait, box.middle * box.displacement,
                       box.landing.z, place, box.half_heading + box.half_turn);
}

/// A dimension along which a box can be halved.
struct Dimension {
  double width = 0;  ///< m, its effect on a landing
  double* middle = nullptr;
  double* half = nullptr;
};

Dimension Widest(LaunchBox* box) {
  constexpr double kLever = 0.3;  // m, rough distance of bearing points from their stance
  const double reach = box->displacement.position().norm() + kLever;
  const Dimension dimensions[] = {
      {box->half_place.x(), &box->middle.x, &box->half_place.x()},
      {box->half_place.y(), &box->middle.y, &box->half_place.y()},
      {box->half_heading * reach, &box->middle.yaw, &box->half_heading},
      {box->half_displacement.x(), &box->displacement.x, &box->half_displacement.x()},
      {box->half_displacement.y(), &box->displacement.y, &box->half_displacement.y()},
      {box->half_turn * kLever, &box->displacement.yaw, &box->half_turn}};
  return *std::max_element(
      std::begin(dimensions), std::end(dimensions),
      [](const Dimension& a, const Dimension& b) { return a.width < b.width; });
}

/// The lower (-1) or upper (1) half of a box.
LaunchBox Half(LaunchBox box, int side) {
  const Dimension widest = Widest(&box);
  *widest.half /= 2;
  *widest.middle += side * *widest.half;
  return box;
}

}  // namespace

bool GroundMayHold(const LocomotionModel& model, const models::GroundMap& ground, int gait,
                   const PlanarPose& pose, double z, double place, double turn) {
  const Eigen::Isometry2d X_WS = pose.Transform();
  for (const std::vector<Vector2d>& points : model.gaits[gait]->stance.bearing_points) {
    for (const Vector2d& p_S : points) {
      if (!GroundIsNear(ground, X_WS * p_S, z, place + p_S.norm() * turn)) return false;
    }
  }
  return true;
}

bool GroundMayHoldAllAround(const LocomotionModel& model, const models::GroundMap& ground, int gait,
                            const PlanarPose& pose, double z, double place, double turn,
                            double displaced) {
  const Eigen::Isometry2d X_WS = pose.Transform();
  for (const std::vector<Vector2d>& points : model.gaits[gait]->stance.bearing_points) {
    for (const Vector2d& p_S : points) {
      const double distance = place + p_S.norm() * turn;
      if (!GroundIsNearAllAround(ground, X_WS * p_S, z, distance, displaced)) return false;
    }
  }
  return true;
}

bool MayLand(const LocomotionModel& model, const models::GroundMap& ground, const LaunchBox& box,
             int halvings) {
  if (!LaunchMayStand(model, ground, box) || !LandingMayStand(model, ground, box)) return false;
  if (halvings == 0) return true;
  return MayLand(model, ground, Half(box, -1), halvings - 1) ||
         MayLand(model, ground, Half(box, 1), halvings - 1);
}

}  // namespace possibility::actions
