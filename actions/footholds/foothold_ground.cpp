#include "actions/footholds/foothold_ground.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "actions/wholebody/limb_tilt.h"
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
/// Of places that are moved to where ground is: how often, how much farther than needed, and what
/// gradients are taken over, m.
constexpr int kMostMoves = 8;
constexpr double kBeyondMargin = 1e-5;
constexpr double kProbe = 1e-4;
constexpr int kSwingSamples = 12;

/// The link of a limb that does not hold its orientation turns about its contact by so much while
/// the rest of the robot moves on, rad.
constexpr double kFreeTurn = 0.3;
constexpr int kParts = 4;  ///< of its shapes: a box about all of a slanting shank is much too large

/// Of the friction coefficient, for slopes: the rest is for motion.
constexpr double kUsableFriction = 0.85;

bool IsUpright(const Eigen::Isometry3d& X) { return X.linear().col(2) == Vector3d::UnitZ(); }

/// A box about shapes of the limb's link in the nominal posture, made larger by what is kept free
/// on its sides and smaller by what is not tested below.
Eigen::AlignedBox3d Padded(Eigen::AlignedBox3d box) {
  box.min() -= Vector3d(kSide, kSide, 0);
  box.max() += Vector3d(kSide, kSide, 0);
  box.min().z() = std::max(box.min().z(), kGap);
  return box;
}

/// Around the shapes of a link that holds its orientation.
std::vector<Eigen::AlignedBox3d> BoxesOfHeldLink(const models::RobotModel& robot,
                                                 const NominalStance& stance, int limb,
                                                 const Eigen::Isometry3d& X_SL) {
  const int link = robot.contacts[stance.gait->limbs[limb].contact].link;
  Eigen::AlignedBox3d box;
  for (const models::PosedShape& posed : robot.links[link].shapes) {
    box.extend(posed.shape.Bounds(X_SL * posed.X_PS));
  }
  for (const Vector2d& p : stance.bearing_points[limb]) box.extend(Vector3d(p.x(), p.y(), kGap));
  box.min().z() = kGap;
  return {Padded(box)};
}

/// Parts of a box along its longest side.
std::vector<Eigen::AlignedBox3d> PartsOf(const Eigen::AlignedBox3d& box) {
  Eigen::Index axis = 0;
  const double part = box.sizes().maxCoeff(&axis) / kParts;
  std::vector<Eigen::AlignedBox3d> parts;
  for (int i = 0; i < kParts; ++i) {
    parts.push_back(box);
    parts.back().min()[axis] = box.min()[axis] + i * part;
    parts.back().max()[axis] = box.min()[axis] + (i + 1) * part;
  }
  return parts;
}

/// Around the parts of the shapes of a link that turns about its contact while the robot moves on.
std::vector<Eigen::AlignedBox3d> BoxesOfFreeLink(const models::RobotModel& robot,
                                                 const NominalStance& stance, int limb,
                                                 const Eigen::Isometry3d& X_SL) {
  std::vector<Eigen::Isometry3d> poses = {X_SL};
  const Eigen::Translation3d from_centre(-stance.patch_centres[limb]);
  for (const Vector3d& axis : {Vector3d(Vector3d::UnitX()), Vector3d(Vector3d::UnitY())}) {
    for (const double angle : {-kFreeTurn, kFreeTurn}) {
      const Eigen::Isometry3d turned = Eigen::AngleAxisd(angle, axis) * (from_centre * X_SL);
      poses.push_back(Eigen::Translation3d(stance.patch_centres[limb]) * turned);
    }
  }
  std::vector<Eigen::AlignedBox3d> boxes;
  for (const models::PosedShape& posed :
       robot.links[robot.contacts[stance.gait->limbs[limb].contact].link].shapes) {
    for (const Eigen::AlignedBox3d& part :
         PartsOf(posed.shape.Bounds(Eigen::Isometry3d::Identity()))) {
      Eigen::AlignedBox3d box;
      for (const Eigen::Isometry3d& X : poses) {
        for (int corner = 0; corner < 8; ++corner) {
          box.extend(X * posed.X_PS *
                     part.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner)));
        }
      }
      box = Padded(box);
      if (box.min().z() < box.max().z()) boxes.push_back(box);
    }
  }
  return boxes;
}

std::vector<Eigen::AlignedBox3d> FootBoxes(const models::RobotModel& robot,
                                           const NominalStance& stance, int limb) {
  dynamics::TreeKinematics kinematics(robot);
  kinematics.SetPosition(stance.q);
  const models::GaitLimb& moving = stance.gait->limbs[limb];
  const Eigen::Isometry3d X_SL = kinematics.X_WL()[robot.contacts[moving.contact].link];
  return moving.hold_orientation ? BoxesOfHeldLink(robot, stance, limb, X_SL)
                                 : BoxesOfFreeLink(robot, stance, limb, X_SL);
}

}  // namespace

bool AreOnOneSlope(const Foothold& a, const Foothold& b) {
  return !a.IsLevel() && a.normal == b.normal && a.offset == b.offset;
}

Eigen::Isometry3d FrameOf(const NominalStance& stance, int limb, const Foothold& place) {
  if (place.IsLevel()) return place.stance.At(place.z);
  const Vector3d& centre = stance.patch_centres[limb];
  const Vector2d from_above = place.stance * Vector2d(centre.head<2>());
  Eigen::Isometry3d X_WS = Eigen::Isometry3d::Identity();
  X_WS.linear() = StandingOn(place.normal, place.stance.yaw);
  X_WS.translation() = Vector3d(from_above.x(), from_above.y(), place.z) -
                       X_WS.linear() * Vector3d(centre.x(), centre.y(), 0);
  return X_WS;
}

Eigen::Isometry3d PatchPoseOf(const NominalStance& stance, int limb, const Foothold& place) {
  return FrameOf(stance, limb, place) * Eigen::Translation3d(stance.patch_centres[limb]) *
         Eigen::AngleAxisd(stance.patch_headings[limb], Vector3d::UnitZ());
}

std::vector<int> GentlePlanes(const models::RobotModel& robot, const models::GroundMap& ground) {
  std::vector<int> gentle;
  for (int plane = 0; plane < static_cast<int>(ground.planes().size()); ++plane) {
    const Vector3d& normal = ground.planes()[plane].normal;
    const double steepest =
        kUsableFriction * std::min(robot.friction, ground.planes()[plane].friction);
    if (normal.head<2>().norm() <= steepest * normal.z()) gentle.push_back(plane);
  }
  return gentle;
}

FootholdGround::FootholdGround(const models::RobotModel& robot, const NominalStance& stance,
                               const World& world, double margin)
    : stance_(stance),
      world_(world),
      margin_(margin),
      planes_(GentlePlanes(robot, *world.ground)),
      checker_(*world.environment) {
  for (int limb = 0; limb < static_cast<int>(stance.gait->limbs.size()); ++limb) {
    feet_.emplace_back(FootBoxes(robot, stance, limb));
  }
}

Foothold FootholdGround::On(int limb, const PlanarPose& stance, int plane) const {
  const models::GroundPlane& ground = world_.ground->planes()[plane];
  const Vector2d centre = stance * Vector2d(stance_.patch_centres[limb].head<2>());
  return {stance, ground.HeightAt(centre), ground.normal, ground.offset, ground.friction};
}

bool FootholdGround::Holds(int limb, int plane, const Foothold& place) const {
  const std::vector<Vector2d>& points = stance_.bearing_points[limb];
  if (place.IsLevel()) {
    const Eigen::Isometry2d X = place.stance.Transform();
    return std::all_of(points.begin(), points.end(), [&](const Vector2d& p) {
      return world_.ground->Clearance(plane, X * p) >= margin_;
    });
  }
  const Eigen::Isometry3d X_WS = FrameOf(stance_, limb, place);
  return std::all_of(points.begin(), points.end(), [&](const Vector2d& p) {
    const Vector3d there = X_WS * Vector3d(p.x(), p.y(), 0);
    return world_.ground->Clearance(plane, there.head<2>()) >= margin_;
  });
}

bool FootholdGround::IsFree(int limb, const Eigen::Isometry3d& X_WS) const {
  const models::UprightBoxes& foot = feet_[limb];
  if (IsUpright(X_WS)) return checker_.AreFree(foot, X_WS);
  for (std::size_t i = 0; i < foot.shapes().size(); ++i) {
    if (!checker_.IsFree(foot.shapes()[i], X_WS * foot.X_SB()[i], 0)) return false;
  }
  return true;
}

/// Moves a place until all bearing points hold: towards where the worst of them has more ground
/// about it.
std::optional<PlanarPose> FootholdGround::Settled(int limb, const PlanarPose& stance,
                                                  int plane) const {
  PlanarPose at = stance;
  for (int move = 0; move <= kMostMoves; ++move) {
    const Eigen::Isometry3d X_WS = FrameOf(stance_, limb, On(limb, at, plane));
    double least = std::numeric_limits<double>::infinity();
    Vector2d worst = Vector2d::Zero();
    for (const Vector2d& p : stance_.bearing_points[limb]) {
      const Vector2d there = (X_WS * Vector3d(p.x(), p.y(), 0)).head<2>();
      const double clearance = world_.ground->Clearance(plane, there);
      if (clearance >= least) continue;
      least = clearance;
      worst = there;
    }
    if (least >= margin_) return at;
    if (margin_ - least > kMostShift) return std::nullopt;
    const Vector2d uphill = ClearanceGradient(plane, worst);
    at.x += (margin_ - least + kBeyondMargin) * uphill.x();
    at.y += (margin_ - least + kBeyondMargin) * uphill.y();
    if ((at.position() - stance.position()).norm() > kMostShift) return std::nullopt;
  }
  return std::nullopt;
}

/// Of the distance to the ground's edge, seen from above.
Vector2d FootholdGround::ClearanceGradient(int plane, const Vector2d& p) const {
  const auto along = [&](const Vector2d& axis) {
    return (world_.ground->Clearance(plane, p + kProbe * axis) -
            world_.ground->Clearance(plane, p - kProbe * axis)) /
           (2 * kProbe);
  };
  return {along(Vector2d::UnitX()), along(Vector2d::UnitY())};
}

std::optional<Foothold> FootholdGround::Place(int limb, const PlanarPose& stance, int plane) const {
  if (!world_.ground->IsNear(plane, stance * Vector2d(stance_.patch_centres[limb].head<2>()),
                             kMostShift)) {
    return std::nullopt;
  }
  const std::optional<PlanarPose> settled = Settled(limb, stance, plane);
  if (!settled) return std::nullopt;
  for (double shift = 0; shift <= kMostShift; shift += kShift) {
    for (const double ahead : {shift, -shift}) {
      const Foothold there = On(limb, *settled * PlanarPose{ahead, 0, 0}, plane);
      if ((there.stance.position() - stance.position()).norm() > kMostShift + kBeyondMargin)
        continue;
      if ((shift == 0 || Holds(limb, plane, there)) &&
          IsFree(limb, FrameOf(stance_, limb, there))) {
        return there;
      }
      if (shift == 0) break;
    }
  }
  return std::nullopt;
}

bool FootholdGround::SwingIsFree(int limb, const Foothold& from, const Foothold& to,
                                 double clearance, double lift) const {
  const Eigen::Isometry3d X_from = FrameOf(stance_, limb, from);
  const Eigen::Isometry3d X_to = FrameOf(stance_, limb, to);
  const Vector3d centre = stance_.patch_centres[limb];
  const SwingPath path{
      X_from * centre, X_to * centre, clearance, lift, 1, BearOnOneSlope(X_from, X_to)};
  const TurnAngles before = AnglesOf(X_from.linear());
  const TurnAngles after = AnglesOf(X_to.linear());
  for (int i = 1; i < kSwingSamples; ++i) {
    const double t = static_cast<double>(i) / kSwingSamples;
    const double s = path.Progress(t).value;
    Eigen::Isometry3d X_WS = Eigen::Isometry3d::Identity();
    X_WS.linear() = RotationOf({before.yaw + s * WrapAngle(after.yaw - before.yaw),
                                before.pitch + s * (after.pitch - before.pitch),
                                before.roll + s * (after.roll - before.roll)});
    X_WS.translation() = path.At(t).value - X_WS.linear() * centre - kGap * X_WS.linear().col(2);
    if (!IsFree(limb, X_WS)) return false;
  }
  return true;
}

std::optional<double> FootholdGround::LiftBetween(int limb, const Foothold& from,
                                                  const Foothold& to, double clearance,
                                                  double most) const {
  if (SwingIsFree(limb, from, to, clearance, 0)) return 0;
  // Most swings that hit something cannot pass above it either.
  if (!SwingIsFree(limb, from, to, clearance, most)) return std::nullopt;
  for (double lift = kLift; lift < most; lift += kLift) {
    if (SwingIsFree(limb, from, to, clearance, lift)) return lift;
  }
  return most;
}

}  // namespace possibility::actions
