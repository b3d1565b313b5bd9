#include "actions/footsteps/step_rules.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "actions/wholebody/support_polygon.h"
#include "dynamics/tree/tree_kinematics.h"

namespace possibility::actions {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kFamilyRounding = 1e-6;  // m and rad
constexpr int kPassingSamples = 8;

/// Roots lower than this below the nominal posture cost time, m.
constexpr double kEasySquat = 0.02;
/// On ground that is not level, longer strides than this share of the family's cost torque and
/// joint speed, s/m.
constexpr double kEasyStride = 0.6;
constexpr double kSecondsPerStride = 4;
/// A step that is moved to where ground is may become longer than the family's; that is dear, s/m.
constexpr double kSecondsPerMetreBeyond = 30;

/// What is close to the ground, of limbs that must keep off each other: share of the root's height.
constexpr double kNearGround = 0.2;

/// Of more than two limbs, s/m and s/rad: without it the search tries all the ways in which limbs
/// may be somewhat aside of each other.
constexpr double kSecondsPerMetreAside = 6;
constexpr double kSecondsPerRadian = 3;

/// The part of the body that is tested while limbs step: above this share of the root's height.
constexpr double kTrunkFrom = 0.5;

/// Steps of the family, in shares of its limits. One of two limbs stays on its side and turns back
/// by turning round; of more limbs each goes to all sides.
constexpr double kAhead[] = {1, 0.88, 0.76, 0.64, 0.5, 0.36, 0.2, 0, -0.25, -0.5};
constexpr double kAside[] = {0, 0.35, 0.7, 1};
constexpr double kAheadOfMany[] = {1, 0.75, 0.5, 0.25, 0, -0.25, -0.5, -1};
constexpr double kAsideOfMany[] = {0, 0.5, -0.5, 1, -1};
constexpr double kTurning[] = {0, 0.5, -0.5, 1, -1};

std::span<const double> SharesAhead(double side) {
  if (side == 0) return kAheadOfMany;
  return kAhead;
}

std::span<const double> SharesAside(double side) {
  if (side == 0) return kAsideOfMany;
  return kAside;
}

double GapBetween(const std::vector<Vector2d>& a, const std::vector<Vector2d>& b) {
  const SupportPolygon one(a), other(b);
  double gap = std::numeric_limits<double>::infinity();
  for (const Vector2d& p : one.vertices()) gap = std::min(gap, -other.Margin(p));
  for (const Vector2d& p : other.vertices()) gap = std::min(gap, -one.Margin(p));
  return gap;
}

/// The parts of boxes above a height, grown on their sides.
std::vector<Eigen::AlignedBox3d> Above(const std::vector<Eigen::AlignedBox3d>& boxes, double height,
                                       double margin) {
  std::vector<Eigen::AlignedBox3d> above;
  for (Eigen::AlignedBox3d box : boxes) {
    box.min() -= Vector3d(margin, margin, 0);
    box.max() += Vector3d(margin, margin, 0);
    box.min().z() = std::max(box.min().z(), height);
    if (box.min().z() < box.max().z()) above.push_back(box);
  }
  return above;
}

/// By limb: corners of a box about the shapes of its links that reach down to the ground, or nearly
/// so.
std::vector<std::vector<Vector2d>> OutlinesNearGround(const models::RobotModel& robot,
                                                      const NominalStance& stance) {
  dynamics::TreeKinematics kinematics(robot);
  kinematics.SetPosition(stance.q);
  const double near = kNearGround * stance.gait->posture.root_height;
  std::vector<std::vector<Vector2d>> outlines;
  for (std::size_t limb = 0; limb < stance.gait->limbs.size(); ++limb) {
    Eigen::AlignedBox2d around;
    for (const Vector2d& p : stance.bearing_points[limb]) around.extend(p);
    for (const int joint : stance.gait->limbs[limb].joints) {
      for (const models::PosedShape& posed : robot.links[joint + 1].shapes) {
        const auto box = posed.shape.Bounds(kinematics.X_WL()[joint + 1] * posed.X_PS);
        if (box.min().z() > near) continue;
        around.extend(Vector2d(box.min().head<2>())).extend(Vector2d(box.max().head<2>()));
      }
    }
    outlines.push_back({around.min(),
                        {around.max().x(), around.min().y()},
                        around.max(),
                        {around.min().x(), around.max().y()}});
  }
  return outlines;
}

}  // namespace

StepRules::StepRules(const LocomotionModel& model, int gait, const World& world,
                     const StepGround& known, const FootstepLimits& limits)
    : stance_(model.gaits[gait]->stance),
      limits_(limits),
      world_(world),
      ground_(*model.robot, stance_, world, limits.margin),
      checker_(*world.environment),
      trunk_(Above(model.gaits[gait]->volumes.standing,
                   kTrunkFrom * stance_.gait->posture.root_height, limits.trunk_margin)),
      reach_(*model.robot, stance_),
      headings_(known.headings),
      outlines_(stance_.bearing_points) {
  if (outlines_.size() > 2) outlines_ = OutlinesNearGround(*model.robot, stance_);
  for (int limb = 0; limb < static_cast<int>(stance_.gait->limbs.size()); ++limb) {
    displacements_.push_back(DisplacementsOf(limb));
  }
}

double StepRules::SideOf(int limb) const {
  if (stance_.gait->limbs.size() != 2) return 0;
  return stance_.patch_centres[limb].y() > stance_.patch_centres[1 - limb].y() ? 1 : -1;
}

std::vector<Vector2d> StepRules::OutlineAt(int limb, const PlanarPose& at) const {
  const Eigen::Isometry2d X = at.Transform();
  std::vector<Vector2d> points;
  points.reserve(outlines_[limb].size());
  for (const Vector2d& p : outlines_[limb]) points.push_back(X * p);
  return points;
}

double StepRules::GapToOthers(int limb, const PlanarPose& at,
                              const std::vector<Foothold>& feet) const {
  const std::vector<Vector2d> outline = OutlineAt(limb, at);
  double gap = std::numeric_limits<double>::infinity();
  for (int other = 0; other < static_cast<int>(stance_.gait->limbs.size()); ++other) {
    if (other == limb) continue;
    const PlanarPose there = feet.empty() ? PlanarPose() : feet[other].stance;
    gap = std::min(gap, GapBetween(outline, OutlineAt(other, there)));
  }
  return gap;
}

std::vector<PlanarPose> StepRules::DisplacementsOf(int limb) const {
  std::vector<PlanarPose> result;
  const double side = SideOf(limb);
  for (const double turn : kTurning) {
    for (const double ahead : SharesAhead(side)) {
      for (const double aside : SharesAside(side)) {
        if (std::abs(ahead) + 0.6 * std::abs(aside) + 0.6 * std::abs(turn) > 1.3) continue;
        const double outwards = side == 0 ? 1 : side;
        const PlanarPose displacement{ahead * limits_.forward, outwards * aside * limits_.lateral,
                                      turn * limits_.turn};
        if (GapToOthers(limb, displacement, {}) < StepGround::kPatchGap) continue;
        result.push_back(displacement);
      }
    }
  }
  return result;
}

bool StepRules::IsWithin(int limb, const PlanarPose& displacement) const {
  const double side = SideOf(limb);
  const double aside = side == 0 ? std::abs(displacement.y) : side * displacement.y;
  return std::abs(displacement.x) <= limits_.forward + kFamilyRounding &&
         aside >= -0.1 * limits_.lateral && aside <= limits_.lateral + kFamilyRounding &&
         std::abs(WrapAngle(displacement.yaw)) <= limits_.turn + kFamilyRounding;
}

double StepRules::Extent() const {
  double extent = 0;
  for (const Vector3d& centre : stance_.patch_centres) {
    extent = std::max(extent, centre.head<2>().norm());
  }
  return extent;
}

int StepRules::NumPlaces(int limb) const {
  return static_cast<int>((headings_.size() + 1) * displacements_[limb].size());
}

std::optional<PlanarPose> StepRules::Displacement(int limb, double yaw, int number) const {
  const int each = static_cast<int>(displacements_[limb].size());
  const int heading = number / each;
  PlanarPose displacement = displacements_[limb][number % each];
  if (heading == static_cast<int>(headings_.size())) return displacement;
  if (displacement.yaw != 0) return std::nullopt;
  displacement.yaw = WrapAngle(4 * (headings_[heading] - yaw)) / 4;
  if (std::abs(displacement.yaw) > limits_.turn || std::abs(displacement.yaw) < 1e-6) {
    return std::nullopt;
  }
  return displacement;
}

std::optional<PlanarPose> StepRules::PlaceAbout(int limb, const PlanarPose& rest,
                                                int number) const {
  const std::optional<PlanarPose> displacement = Displacement(limb, rest.yaw, number);
  if (!displacement) return std::nullopt;
  return rest * *displacement;
}

std::vector<StepRules::Place> StepRules::PlacesAbout(int limb, const PlanarPose& rest) const {
  const Eigen::Isometry2d X = rest.Transform();
  std::vector<Place> places;
  for (int number = 0; number < NumPlaces(limb); ++number) {
    const std::optional<PlanarPose> displacement = Displacement(limb, rest.yaw, number);
    if (!displacement) continue;
    const Vector2d at = X * displacement->position();
    places.push_back({number, {at.x(), at.y(), rest.yaw + displacement->yaw}, *displacement});
  }
  return places;
}

std::optional<double> StepRules::Squat(const std::vector<Foothold>& feet, int limb) const {
  const std::optional<double> highest = reach_.HighestRoot(feet, limb);
  if (!highest || *highest < limits_.lowest_root) return std::nullopt;
  return std::max(0.0, stance_.gait->posture.root_height - kEasySquat - *highest);
}

bool StepRules::KeepsOff(const std::vector<Foothold>& feet, int limb) const {
  return GapToOthers(limb, feet[limb].stance, feet) >= StepGround::kPatchGap;
}

bool StepRules::PassesOthers(const std::vector<Foothold>& feet, int limb,
                             const Foothold& from) const {
  for (int i = 1; i < kPassingSamples; ++i) {
    const PlanarPose at =
        Interpolate(from.stance, feet[limb].stance, static_cast<double>(i) / kPassingSamples);
    if (GapToOthers(limb, at, feet) < StepGround::kPatchGap) return false;
  }
  return true;
}

bool StepRules::TrunkIsFree(const PlanarPose& middle, double z) const {
  const Vector2d root = middle * Vector2d(stance_.X_SR.translation().head<2>());
  if (!world_.environment->bounds.isEmpty() && !world_.environment->bounds.contains(root)) {
    return false;
  }
  return checker_.AreFree(trunk_, middle.At(z));
}

std::optional<Footstep> StepRules::StepBetween(const std::vector<Foothold>& feet, int limb,
                                               const Foothold& to) const {
  const Foothold& from = feet[limb];
  std::vector<Foothold> after = feet;
  after[limb] = to;
  if (!Squat(feet, limb) || !Squat(after, limb)) return std::nullopt;
  if (!KeepsOff(after, limb) || !PassesOthers(after, limb, from)) return std::nullopt;
  const auto lift = LiftBetween(limb, from, to);
  if (!lift) return std::nullopt;
  return Footstep{limb, from, to, *lift};
}

double StepRules::Cost(int limb, const Foothold& from, const Foothold& to, const Foothold& rest,
                       double squat) const {
  return Cost(limb, from, to, rest.stance.Inverse() * to.stance, rest, squat);
}

double StepRules::Cost(int limb, const Foothold& from, const Foothold& to,
                       const PlanarPose& displacement, const Foothold& rest, double squat) const {
  const bool is_level = to.IsLevel() && rest.IsLevel() && to.z == rest.z;
  return ExpectedDuration({limb, from, to, 0}) + kSecondsPerSquat * squat +
         StrideTime(displacement.x, is_level) + UntidinessTime(displacement);
}

double StepRules::UntidinessTime(const PlanarPose& displacement) const {
  if (NumLimbs() == 2) return 0;
  return kSecondsPerMetreAside * std::abs(displacement.y) +
         kSecondsPerRadian * std::abs(WrapAngle(displacement.yaw));
}

double StepRules::StrideTime(double ahead, bool is_level) const {
  const double easy = (is_level ? 1 : kEasyStride) * limits_.forward;
  return kSecondsPerStride * std::max(0.0, std::abs(ahead) - easy) +
         kSecondsPerMetreBeyond * std::max(0.0, std::abs(ahead) - limits_.forward);
}

}  // namespace possibility::actions
