#include "actions/swept_volume.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "models/collision.h"
#include "models/input_error.h"

namespace possibility::actions {
namespace {

using Eigen::AlignedBox3d;

/// Knots of sampled motions are closer than those of plans, s.
constexpr double kSamplingInterval = 0.04;

/// Merging two slabs may add at most this fraction to their volume.
constexpr double kMergeSlack = 0.03;

/// Displacements at the corners, edge midpoints and face centres of the octahedron of allowed
/// strides, and none at all.
std::vector<PlanarPose> ExtremeDisplacements(const models::GaitParameters& parameters) {
  std::vector<PlanarPose> displacements;
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) {
      for (int turn = -1; turn <= 1; ++turn) {
        const int axes = std::abs(x) + std::abs(y) + std::abs(turn);
        const double share = axes == 0 ? 0 : 1.0 / axes;
        displacements.push_back({share * x * parameters.forward, share * y * parameters.lateral,
                                 share * turn * parameters.turn});
      }
    }
  }
  return displacements;
}

/// Builds the motion (which checks limits, torques and friction), checks self-collision at every
/// knot and hands each knot's link poses to `visit`.
template <typename Visitor>
void SampleMotion(const models::RobotModel& robot, const std::vector<MotionPhase>& phases,
                  const Eigen::VectorXd& guess, const std::function<bool()>& keep_going,
                  const Visitor& visit) {
  MotionSettings settings;
  settings.knot_spacing = kSamplingInterval;
  const std::vector<Phase> motion = MotionBuilder(robot, settings).Build(phases, guess, keep_going);
  const models::Environment nothing;
  models::CollisionChecker checker(robot, nothing);
  dynamics::TreeKinematics kinematics(robot);
  for (const Phase& phase : motion) {
    for (const Knot& knot : phase.knots) {
      kinematics.SetPosition(knot.q);
      const std::vector<models::Proximity> close = checker.SelfProximities(kinematics.X_WL(), 0);
      if (!close.empty()) {
        throw MotionError(fmt::format(
            "{} collides with {} by {:.4f} m at {:.2f} s", robot.links[close.front().link].name,
            robot.links[close.front().other].name, -close.front().distance, knot.t));
      }
      visit(kinematics.X_WL());
    }
  }
}

}  // namespace

void SweptVolume::Add(const models::RobotModel& robot, const std::vector<Eigen::Isometry3d>& X_WL,
                      const PlanarPose& frame) {
  const Eigen::Isometry3d X_FW = frame.At(0).inverse();
  for (int link = 0; link < robot.num_links(); ++link) {
    for (const models::PosedShape& posed : robot.links[link].shapes) {
      const AlignedBox3d bounds = posed.shape.Bounds(X_FW * X_WL[link] * posed.X_PS);
      const int first = std::max(0, static_cast<int>(std::floor(bounds.min().z() / kSlabHeight)));
      const int last = static_cast<int>(std::floor(bounds.max().z() / kSlabHeight));
      if (last >= static_cast<int>(slabs_.size())) slabs_.resize(last + 1);
      for (int slab = first; slab <= last; ++slab) {
        AlignedBox3d part = bounds;
        part.min().z() = std::max(part.min().z(), slab * kSlabHeight);
        part.max().z() = std::min(part.max().z(), (slab + 1) * kSlabHeight);
        slabs_[slab].extend(part);
      }
    }
  }
}

std::vector<AlignedBox3d> SweptVolume::Boxes() const {
  std::vector<AlignedBox3d> boxes;
  for (const AlignedBox3d& slab : slabs_) {
    if (slab.isEmpty()) continue;
    AlignedBox3d grown = slab;
    grown.min().array() -= kSamplingMargin;
    grown.max().array() += kSamplingMargin;
    grown.min().z() = std::max(grown.min().z(), kGroundGap);
    if (!boxes.empty()) {
      const AlignedBox3d merged = boxes.back().merged(grown);
      if (merged.volume() <= (1 + kMergeSlack) * (boxes.back().volume() + grown.volume())) {
        boxes.back() = merged;
        continue;
      }
    }
    boxes.push_back(grown);
  }
  return boxes;
}

SweptVolume SweepGait(const models::RobotModel& robot, const NominalStance& stance,
                      const std::function<bool()>& keep_going) {
  const GaitMotion gait(robot, stance);
  SweptVolume volume;
  for (const PlanarPose& displacement : ExtremeDisplacements(stance.gait->parameters)) {
    const PlanarPose start;
    try {
      SampleMotion(robot, gait.Phases({start, displacement}, 0, 1), stance.q, keep_going,
                   [&](const std::vector<Eigen::Isometry3d>& X_WL) {
                     volume.Add(robot, X_WL, GaitMotion::StrideFrame(start, displacement));
                   });
    } catch (const MotionError& error) {
      throw InputError(fmt::format(
          "{}: gaits.{}.parameters: the stride ({:.3f} m, {:.3f} m, {:.3f} rad) is not possible: "
          "{}",
          robot.file.string(), stance.gait->name, displacement.x, displacement.y, displacement.yaw,
          error.what()));
    }
  }
  return volume;
}

SweptVolume SweepTransition(const models::RobotModel& robot, const TransitionMotion& transition) {
  SweptVolume volume;
  dynamics::TreeKinematics kinematics(robot);
  for (const Phase& phase : transition.phases()) {
    for (const Knot& knot : phase.knots) {
      kinematics.SetPosition(knot.q);
      volume.Add(robot, kinematics.X_WL(), PlanarPose());
    }
  }
  return volume;
}

}  // namespace possibility::actions
