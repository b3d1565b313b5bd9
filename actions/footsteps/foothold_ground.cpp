#include "actions/footsteps/foothold_ground.h"

#include <algorithm>
#include <cmath>

#include "dynamics/tree/tree_kinematics.h"

namespace possibility::actions {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Boxes about feet begin this far above their ground, m.
constexpr double kGap = 0.002;
/// Between a foot that swings and what it swings over, m; beside a foot that bears.
constexpr double kSide = 0.012;
constexpr double kShift = 0.015;  // m, between places that are tried
constexpr double kLift = 0.03;    // m, between lifts that are tried
constexpr int kSwingSamples = 12;

/// Around the shapes of the limb's link, in the nominal posture.
Eigen::AlignedBox3d FootBox(const models::RobotModel& robot, const NominalStance& stance,
                            int limb) {
  dynamics::TreeKinematics kinematics(robot);
  kinematics.SetPosition(stance.q);
  const int link = robot.contacts[stance.gait->limbs[limb].contact].link;
  Eigen::AlignedBox3d box;
  for (const models::PosedShape& posed : robot.links[link].shapes) {
    box.extend(posed.shape.Bounds(kinematics.X_WL()[link] * posed.X_PS));
  }
  for (const Vector2d& p : stance.bearing_points[limb]) box.extend(Vector3d(p.x(), p.y(), kGap));
  box.min().z() = kGap;
  return {box.min() - Vector3d(kSide, kSide, 0), box.max() + Vector3d(kSide, kSide, 0)};
}

}  // namespace

FootholdGround::FootholdGround(const models::RobotModel& robot, const NominalStance& stance,
                               const World& world, double margin)
    : stance_(stance), world_(world), margin_(margin), checker_(*world.environment) {
  for (int limb = 0; limb < static_cast<int>(stance.gait->limbs.size()); ++limb) {
    feet_.emplace_back(std::vector<Eigen::AlignedBox3d>{FootBox(robot, stance, limb)});
  }
}

bool FootholdGround::Holds(int limb, int level, const PlanarPose& stance) const {
  const std::vector<Vector2d>& points = stance_.bearing_points[limb];
  return std::all_of(points.begin(), points.end(), [&](const Vector2d& p) {
    return world_.ground->Clearance(level, stance * p) >= margin_;
  });
}

bool FootholdGround::IsFree(int limb, const PlanarPose& stance, double z) const {
  return checker_.AreFree(feet_[limb], stance.At(z));
}

std::optional<Foothold> FootholdGround::Place(int limb, const PlanarPose& stance, int level) const {
  const double z = world_.ground->levels()[level];
  if (!world_.ground->IsNear(level, stance * Vector2d(stance_.patch_centres[limb].head<2>()),
                             kMostShift)) {
    return std::nullopt;
  }
  for (double shift = 0; shift <= kMostShift; shift += kShift) {
    for (const double ahead : {shift, -shift}) {
      const PlanarPose there = stance * PlanarPose{ahead, 0, 0};
      if (Holds(limb, level, there) && IsFree(limb, there, z)) return Foothold{there, z};
      if (shift == 0) break;
    }
  }
  return std::nullopt;
}

bool FootholdGround::SwingIsFree(int limb, const Foothold& from, const Foothold& to,
                                 double clearance, double lift) const {
  const SwingPath path{
      {from.stance.x, from.stance.y, from.z}, {to.stance.x, to.stance.y, to.z}, clearance, lift, 1};
  for (int i = 1; i < kSwingSamples; ++i) {
    const double t = static_cast<double>(i) / kSwingSamples;
    const Vector3d p = path.At(t).value;
    const double yaw =
        from.stance.yaw + path.Progress(t).value * WrapAngle(to.stance.yaw - from.stance.yaw);
    if (!IsFree(limb, {p.x(), p.y(), yaw}, p.z() - kGap)) return false;
  }
  return true;
}

std::optional<double> FootholdGround::LiftBetween(int limb, const Foothold& from,
                                                  const Foothold& to, double clearance,
                                                  double most) const {
  for (double lift = 0; lift <= most; lift += kLift) {
    if (SwingIsFree(limb, from, to, clearance, lift)) return lift;
  }
  return std::nullopt;
}

}  // namespace possibility::actions
