#include "actions/crossing/step_over_problem.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "actions/spatial/separating_planes.h"
#include "actions/wholebody/limb_bend.h"
#include "models/input/file_contents.h"
#include "models/input/input_error.h"

namespace possibility::actions {
namespace {

/// Solutions of another version of this problem are stale.
constexpr const char* kVersion = "step over 1";

constexpr StepTiming kTiming{
    .swing = 0.6, .swing_length = 0.4, .double_support = 0.12, .start = 0.5};
/// Of the volumes that the gait sweeps, from the obstacle, m: C_S wants 2 cm in their directions.
constexpr double kRoom = 0.025;
constexpr double kAnyDistance = 1e9;     // m
constexpr double kLegClearance = 0.012;  // m, of the legs from each other
constexpr double kSlowness = 1.3;        // of the swings over the obstacle

/// To the millimetre, so that the identity does not depend on rounding.
double RoundedUp(double length) { return std::ceil(length * 1000 - 1e-6) / 1000; }

/// How far ahead (1) or behind (-1) the volumes of straight strides and turns reach below `height`,
/// m. The robot walks to the obstacle and away from it in these.
double ReachOf(const GaitVolumes& volumes, double height, int direction) {
  double reach = 0;
  for (const StrideClass strides : {StrideClass::kStraight, StrideClass::kTurn}) {
    for (const Eigen::AlignedBox3d& box : volumes.sweep(strides)) {
      if (box.min().z() >= height) continue;
      reach = std::max(reach, direction > 0 ? box.max().x() : -box.min().x());
    }
  }
  return reach;
}

/// How far ahead or behind a stance's origin its feet reach, m.
double FeetReach(const NominalStance& stance, int direction) {
  double reach = 0;
  for (const auto& points : stance.bearing_points) {
    for (const Eigen::Vector2d& p : points) reach = std::max(reach, direction * p.x());
  }
  return reach;
}

/// The two links at the knee, or those beyond them, or all; none without a knee.
std::vector<int> LinksFromKnee(const models::RobotModel& robot, const models::GaitLimb& limb,
                               bool with_knee, bool with_foot) {
  std::vector<int> links;
  const std::optional<LimbBend> knee = BendOf(robot, limb);
  if (!knee) return links;
  for (std::size_t i = knee->joint - 1; i < limb.joints.size(); ++i) {
    const bool is_foot = i > knee->joint;
    if (is_foot ? with_foot : with_knee) links.push_back(limb.joints[i] + 1);
  }
  return links;
}

/// Whether a foot swings from one side of the beam to the other in interval `k`.
bool LeadsOver(const models::ContactSchedule& schedule, int k, const Beam& beam) {
  for (std::size_t contact = 0; contact < schedule.contacts.size(); ++contact) {
    const int c = static_cast<int>(contact);
    if (schedule.intervals[k].bearing[contact]) continue;
    const double from = schedule.Before(k, c).translation().x();
    const double to = schedule.After(k, c).translation().x();
    if ((from < beam.begin) != (to < beam.begin)) return true;
  }
  return false;
}

}  // namespace

StepOverProblem::StepOverProblem(const models::RobotModel& robot,
                                 const LocomotionModel::GaitEntry& gait,
                                 const StepOverSettings& settings)
    : robot_(robot), gait_(gait), settings_(settings) {
  const NominalStance& stance = gait_.stance;
  if (stance.patch_centres.size() != 2) {
    throw InputError(
        fmt::format("{}: '{}' bears on {} contacts, expected two feet to step over "
                    "an obstacle with",
                    robot.file.string(), stance.gait->name, stance.patch_centres.size()));
  }
  beam_.begin = RoundedUp(ReachOf(gait_.volumes, settings_.height, 1) + kRoom);
  beam_.end = beam_.begin + settings_.thickness;
  beam_.height = settings_.height;
  length_ = RoundedUp(beam_.end + ReachOf(gait_.volumes, settings_.height, -1) + kRoom);
  schedule_ = ScheduleOf(robot_, stance, SwingGroups(stance), {}, Steps(), kTiming);
  to_ = stance.q;
  to_[4] += length_;
}

std::vector<Step> StepOverProblem::Steps() const {
  const NominalStance& stance = gait_.stance;
  const auto feet = SwingGroups(stance);
  const double before = beam_.begin - settings_.gap - FeetReach(stance, 1);
  const double behind = beam_.end + settings_.gap + FeetReach(stance, -1);
  const auto outwards = [&](int group) {
    return std::copysign(settings_.widening, stance.patch_centres[feet[group].front()].y());
  };
  return {{0, {before / 2, outwards(0), 0}, 1},
          {1, {before, outwards(1), 0}, 1},
          {0, {behind, outwards(0), 0}, kSlowness},
          {1, displacement(), kSlowness},
          {0, displacement(), 1}};
}

std::vector<collocation::Separation> StepOverProblem::LegsApart() const {
  const models::GaitLimb& first = limbs().limbs[0];
  const models::GaitLimb& second = limbs().limbs[1];
  std::vector<collocation::Separation> apart;
  for (std::size_t k = 0; k < schedule_.intervals.size(); ++k) {
    if (!LeadsOver(schedule_, static_cast<int>(k), beam_)) continue;
    const auto add = [&](int link, int other) {
      const auto planes = SeparatingPlanes(robot_, from(), link, other, kAnyDistance, kLegClearance,
                                           static_cast<int>(k));
      apart.insert(apart.end(), planes.begin(), planes.end());
    };
    for (const int link : LinksFromKnee(robot_, first, true, true)) {
      for (const int other : LinksFromKnee(robot_, second, true, false)) add(link, other);
    }
    for (const int link : LinksFromKnee(robot_, first, true, false)) {
      for (const int other : LinksFromKnee(robot_, second, false, true)) add(link, other);
    }
  }
  return apart;
}

SpatialSolverSettings StepOverProblem::solver() const {
  SpatialSolverSettings settings;
  settings.interval = 0.06;
  settings.problem.beam = beam_;
  settings.problem.beam_clearance = settings_.clearance;
  settings.problem.tilt = 0.3;
  settings.problem.posture_weight = 1;
  settings.problem.sequence.separations = LegsApart();
  settings.problem.sequence.clearance = 0.04;
  // The feet turn quickly beside the obstacle: forces change more between the knots than in a walk.
  settings.motion.knot_spacing = 0.005;
  settings.motion.friction_margin = 0.9;
  // Joints outside the legs stay as they are.
  for (int j = 0; j < robot_.num_joints(); ++j) settings.problem.locked[j] = from()[7 + j];
  for (const models::GaitLimb& limb : limbs().limbs) {
    for (const int joint : limb.joints) settings.problem.locked.erase(joint);
  }
  return settings;
}

std::string StepOverProblem::Identity() const {
  return models::HashOfParts(
      {robot_.content_hash, kVersion, limbs().name,
       fmt::format("{:.3f} {:.3f} {:.3f} {:.3f} {:.3f} {:.3f} {:.3f}", beam_.begin, beam_.end,
                   beam_.height, length_, settings_.gap, settings_.clearance, settings_.widening)});
}

}  // namespace possibility::actions
