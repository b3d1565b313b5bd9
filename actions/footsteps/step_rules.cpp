#include "actions/footsteps/step_rules.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "actions/wholebody/support_polygon.h"

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

/// The part of the body that is tested while limbs step: above this share of the root's height.
constexpr double kTrunkFrom = 0.5;

/// Steps of the family, in shares of its limits.
constexpr double kAhead[] = {1, 0.88, 0.76, 0.64, 0.5, 0.36, 0.2, 0, -0.25, -0.5};
constexpr double kAside[] = {0, 0.35, 0.7, 1};
constexpr double kTurning[] = {0, 0.5, -0.5, 1, -1};

std::vector<Vector2d> PatchAt(const NominalStance& stance, int limb, const PlanarPose& at) {
  const Eigen::Isometry2d X = at.Transform();
  std::vector<Vector2d> points;
  for (const Vector2d& p : stance.bearing_points[limb]) points.push_back(X * p);
  return points;
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
      displacements_({DisplacementsOf(0), DisplacementsOf(1)}) {}

double StepRules::SideOf(int limb) const {
  return stance_.patch_centres[limb].y() > stance_.patch_centres[1 - limb].y() ? 1 : -1;
}

std::vector<PlanarPose> StepRules::DisplacementsOf(int limb) const {
  std::vector<PlanarPose> result;
  const double side = SideOf(limb);
  const std::vector<Vector2d> other = PatchAt(stance_, 1 - limb, {});
  for (const double turn : kTurning) {
    for (const double ahead : kAhead) {
      for (const double aside : kAside) {
        if (std::abs(ahead) + 0.6 * aside + 0.6 * std::abs(turn) > 1.3) continue;
        const PlanarPose displacement{ahead * limits_.forward, side * aside * limits_.lateral,
                                      turn * limits_.turn};
        if (GapBetween(PatchAt(stance_, limb, displacement), other) < StepGround::kPatchGap)
          continue;
        result.push_back(displacement);
      }
    }
  }
  return result;
}

bool StepRules::IsWithin(int limb, const PlanarPose& displacement) const {
  const double side = SideOf(limb);
  return std::abs(displacement.x) <= limits_.forward + kFamilyRounding &&
         side * displacement.y >= -0.1 * limits_.lateral &&
         side * displacement.y <= limits_.lateral + kFamilyRounding &&
         std::abs(WrapAngle(displacement.yaw)) <= limits_.turn + kFamilyRounding;
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

std::optional<PlanarPose> StepRules::PlaceAbout(int limb, const PlanarPose& other,
                                                int number) const {
  const std::optional<PlanarPose> displacement = Displacement(limb, other.yaw, number);
  if (!displacement) return std::nullopt;
  return other * *displacement;
}

std::vector<StepRules::Place> StepRules::PlacesAbout(int limb, const PlanarPose& other) const {
  const Eigen::Isometry2d X = other.Transform();
  std::vector<Place> places;
  for (int number = 0; number < NumPlaces(limb); ++number) {
    const std::optional<PlanarPose> displacement = Displacement(limb, other.yaw, number);
    if (!displacement) continue;
    const Vector2d at = X * displacement->position();
    places.push_back({number, {at.x(), at.y(), other.yaw + displacement->yaw}, displacement->x});
  }
  return places;
}

std::optional<double> StepRules::Squat(int limb, const Foothold& place,
                                       const Foothold& other) const {
  const std::optional<double> highest = reach_.HighestRoot(limb, place, other);
  if (!highest || *highest < limits_.lowest_root) return std::nullopt;
  return std::max(0.0, stance_.gait->posture.root_height - kEasySquat - *highest);
}

bool StepRules::KeepsOff(int limb, const Foothold& place, const Foothold& other) const {
  return GapBetween(PatchAt(stance_, limb, place.stance),
                    PatchAt(stance_, 1 - limb, other.stance)) >= StepGround::kPatchGap;
}

bool StepRules::PassesOther(int limb, const Foothold& from, const Foothold& to,
                            const Foothold& other) const {
  const std::vector<Vector2d> bearing = PatchAt(stance_, 1 - limb, other.stance);
  for (int i = 1; i < kPassingSamples; ++i) {
    const PlanarPose at =
        Interpolate(from.stance, to.stance, static_cast<double>(i) / kPassingSamples);
    if (GapBetween(PatchAt(stance_, limb, at), bearing) < StepGround::kPatchGap) return false;
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

std::optional<Footstep> StepRules::StepBetween(int limb, const Foothold& from, const Foothold& to,
                                               const Foothold& other) const {
  if (!Squat(limb, from, other) || !Squat(limb, to, other)) return std::nullopt;
  if (!KeepsOff(limb, to, other) || !PassesOther(limb, from, to, other)) return std::nullopt;
  const auto lift = LiftBetween(limb, from, to);
  if (!lift) return std::nullopt;
  return Footstep{limb, from, to, *lift};
}

double StepRules::Cost(int limb, const Foothold& from, const Foothold& to, const Foothold& other,
                       double squat) const {
  return Cost(limb, from, to, (other.stance.Inverse() * to.stance).x, other, squat);
}

double StepRules::Cost(int limb, const Foothold& from, const Foothold& to, double ahead,
                       const Foothold& other, double squat) const {
  const bool is_level = to.IsLevel() && other.IsLevel() && to.z == other.z;
  return ExpectedDuration({limb, from, to, 0}) + kSecondsPerSquat * squat +
         StrideTime(ahead, is_level);
}

double StepRules::StrideTime(double ahead, bool is_level) const {
  const double easy = (is_level ? 1 : kEasyStride) * limits_.forward;
  return kSecondsPerStride * std::max(0.0, std::abs(ahead) - easy) +
         kSecondsPerMetreBeyond * std::max(0.0, std::abs(ahead) - limits_.forward);
}

}  // namespace possibility::actions
