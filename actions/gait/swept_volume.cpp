#include "actions/gait/swept_volume.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "actions/wholebody/motion_error.h"
#include "common/run_on_threads.h"
#include "models/input/input_error.h"
#include "models/world/collision.h"

namespace possibility::actions {
namespace {

using Eigen::AlignedBox3d;

/// Knot spacing of sampled motions, closer than in plans, s.
constexpr double kSamplingInterval = 0.04;

/// Merging two slabs may add at most this fraction to their volume.
constexpr double kMergeSlack = 0.03;

/// Strides of a sampled way of a gait that flows: start, two steps at full speed, stop. Optimised
/// steps are as long as two strides.
constexpr int kStridesOnTheWay = 8;

/// Zero displacement, and the corners, edge midpoints and face centres of the octahedron of allowed
/// strides.
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

/// Mixed strides use a share of every bound: flowing motions of them stay inside those of the axes.
bool IsAlongOneAxis(const PlanarPose& displacement) {
  return (displacement.x != 0) + (displacement.y != 0) + (displacement.yaw != 0) == 1;
}

/// Checks self-collision at every knot and passes each knot's link poses to `visit`.
template <typename Visitor>
void VisitPoses(const models::RobotModel& robot, const std::vector<Phase>& motion,
                const Visitor& visit) {
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

/// Equal strides, one after the other.
std::vector<PlanarPose> Strides(const PlanarPose& displacement, int count) {
  std::vector<PlanarPose> strides = {PlanarPose()};
  for (int i = 0; i < count; ++i) strides.push_back(strides.back() * displacement);
  return strides;
}

std::vector<PlanarPose> FramesOf(const std::vector<PlanarPose>& strides) {
  std::vector<PlanarPose> frames;
  for (size_t i = 0; i + 1 < strides.size(); ++i) {
    frames.push_back(StrideFrame(strides[i], strides[i + 1]));
  }
  return frames;
}

SweptVolume SweepStrides(const models::RobotModel& robot, const NominalStance& stance,
                         const GaitMotion& gait, const PlanarPose& displacement, int count,
                         const CancellationToken& cancellation) {
  SweptVolume volume;
  const std::vector<PlanarPose> strides = Strides(displacement, count);
  const std::vector<PlanarPose> frames = FramesOf(strides);
  dynamics::TreeKinematics nominal(robot);
  nominal.SetPosition(stance.q);
  try {
    for (const std::vector<Phase>& motion :
         gait.Variants(strides, kSamplingInterval, cancellation)) {
      VisitPoses(robot, motion, [&](const std::vector<Eigen::Isometry3d>& X_WL) {
        volume.Add(robot, X_WL, frames, nominal.X_WL());
      });
    }
  } catch (const MotionError& error) {
    throw InputError(fmt::format(
        "{}: gaits.{}.parameters: the stride ({:.3f} m, {:.3f} m, {:.3f} rad) is not possible: {}",
        robot.file.string(), stance.gait->name, displacement.x, displacement.y, displacement.yaw,
        error.what()));
  }
  return volume;
}

/// The frame in which `p_F` is closest to `p_W`, both seen from above.
std::size_t Nearest(const std::vector<PlanarPose>& frames, const Eigen::Vector3d& p_F,
                    const Eigen::Vector3d& p_W) {
  const auto distance = [&](const PlanarPose& frame) {
    return (frame * Eigen::Vector2d(p_F.head<2>()) - p_W.head<2>()).squaredNorm();
  };
  return std::min_element(
             frames.begin(), frames.end(),
             [&](const PlanarPose& a, const PlanarPose& b) { return distance(a) < distance(b); }) -
         frames.begin();
}

/// Whether the box around both is little larger than the two. Empty boxes add nothing.
bool AddsLittle(const AlignedBox3d& a, const AlignedBox3d& b) {
  if (a.isEmpty() || b.isEmpty()) return true;
  return a.merged(b).volume() <= (1 + kMergeSlack) * (a.volume() + b.volume());
}

}  // namespace

void SweptVolume::Add(const models::RobotModel& robot, const std::vector<Eigen::Isometry3d>& X_WL,
                      const std::vector<PlanarPose>& frames,
                      const std::vector<Eigen::Isometry3d>& nominal_X_FL) {
  std::vector<Eigen::Isometry3d> X_FW;
  X_FW.reserve(frames.size());
  for (const PlanarPose& frame : frames) X_FW.push_back(frame.At(0).inverse());
  for (int link = 0; link < robot.num_links(); ++link) {
    for (const models::PosedShape& posed : robot.links[link].shapes) {
      const Eigen::Isometry3d X_WS = X_WL[link] * posed.X_PS;
      const std::size_t frame =
          frames.size() == 1
              ? 0
              : Nearest(frames, nominal_X_FL[link] * posed.X_PS.translation(), X_WS.translation());
      Add(posed.shape.Bounds(X_FW[frame] * X_WS));
    }
  }
}

void SweptVolume::Add(const AlignedBox3d& bounds) {
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

void SweptVolume::Add(const SweptVolume& other) {
  if (other.slabs_.size() > slabs_.size()) slabs_.resize(other.slabs_.size());
  for (size_t slab = 0; slab < other.slabs_.size(); ++slab) slabs_[slab].extend(other.slabs_[slab]);
}

std::vector<AlignedBox3d> SweptVolume::Boxes() const {
  return BoxesOf({*this}, {kSamplingMargin}).front();
}

std::vector<std::vector<AlignedBox3d>> SweptVolume::BoxesOf(const std::vector<SweptVolume>& volumes,
                                                            const std::vector<double>& margins) {
  std::vector<std::vector<AlignedBox3d>> boxes(volumes.size());
  size_t slabs = 0;
  for (const SweptVolume& volume : volumes) slabs = std::max(slabs, volume.slabs_.size());
  for (size_t slab = 0; slab < slabs; ++slab) {
    std::vector<AlignedBox3d> grown;
    bool merges = slab > 0;
    for (size_t i = 0; i < volumes.size(); ++i) {
      grown.push_back(volumes[i].Grown(slab, margins[i]));
      merges = merges && AddsLittle(boxes[i].back(), grown.back());
    }
    for (size_t i = 0; i < volumes.size(); ++i) {
      if (merges) {
        boxes[i].back().extend(grown[i]);
      } else {
        boxes[i].push_back(grown[i]);
      }
    }
  }
  for (std::vector<AlignedBox3d>& list : boxes) {
    std::erase_if(list, [](const AlignedBox3d& box) { return box.isEmpty(); });
  }
  return boxes;
}

AlignedBox3d SweptVolume::Grown(size_t slab, double margin) const {
  AlignedBox3d grown = slab < slabs_.size() ? slabs_[slab] : AlignedBox3d();
  if (grown.isEmpty()) return grown;
  grown.min().array() -= margin;
  grown.max().array() += margin;
  grown.min().z() = std::max(grown.min().z(), kGroundGap);
  return grown;
}

GaitVolumes SweepGait(const models::RobotModel& robot, const NominalStance& stance,
                      const GaitMotion& gait, const CancellationToken& cancellation, int threads) {
  const std::vector<PlanarPose> extremes = ExtremeDisplacements(stance.gait->parameters);
  std::vector<SweptVolume> swept(extremes.size());
  ForEachOnThreads(threads, extremes.size(), [&](std::size_t i) {
    swept[i] = SweepStrides(robot, stance, gait, extremes[i], 1, cancellation);
    if (gait.Flows() && IsAlongOneAxis(extremes[i])) {
      swept[i].Add(SweepStrides(robot, stance, gait, extremes[i], kStridesOnTheWay, cancellation));
    }
  });
  std::vector<SweptVolume> volumes(kStrideClasses.size() + 1);
  std::vector<double> margins(kStrideClasses.size(), SweptVolume::kSamplingMargin);
  for (size_t extreme = 0; extreme < extremes.size(); ++extreme) {
    for (size_t i = 0; i < kStrideClasses.size(); ++i) {
      if (Includes(kStrideClasses[i], extremes[extreme])) volumes[i].Add(swept[extreme]);
    }
  }
  dynamics::TreeKinematics kinematics(robot);
  kinematics.SetPosition(stance.q);
  volumes.back().Add(robot, kinematics.X_WL(), {PlanarPose()}, {});
  margins.push_back(SweptVolume::kStandingMargin);

  std::vector<std::vector<AlignedBox3d>> boxes = SweptVolume::BoxesOf(volumes, margins);
  GaitVolumes result;
  result.standing = std::move(boxes.back());
  std::move(boxes.begin(), boxes.end() - 1, result.sweeps.begin());
  return result;
}

}  // namespace possibility::actions
