// Straight ways between stances are decided coarse to fine, with boxes that cover many samples at
// once. The answers must equal those of looking at every sample by itself.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>

#include "actions/conditions/exploration_pose.h"
#include "actions/conditions/quasi_static_action.h"
#include "tests/actions/drchubo1.h"
#include "tests/actions/random_scene.h"

namespace possibility::actions {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// A scene with shapes of all kinds, standing, lying and hanging.
models::Environment MixedScene(std::mt19937* generator, int count) {
  models::Environment environment = RandomEnvironment(generator, count);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int i = 0; i < count; ++i) {
    const models::Shape shape =
        i % 2 == 0 ? models::Shape::Cylinder(0.05, 0.8) : models::Shape::Sphere(0.1);
    Isometry3d X_WO = RandomStance(generator, 3).At(0.8 + 0.7 * unit(*generator));
    X_WO.rotate(Eigen::AngleAxisd(2 * unit(*generator), Vector3d::UnitX()));
    environment.obstacles.push_back({fmt::format("piece_{}", i), shape, X_WO, false});
  }
  return environment;
}

class StraightWays {
 public:
  StraightWays(int gait, models::Environment environment)
      : model_(DrcHubo1Locomotion()),
        gait_(gait),
        environment_(std::move(environment)),
        ground_(environment_),
        world_{&environment_, &ground_},
        checker_(environment_),
        action_(model_, gait, world_,
                std::make_shared<PelvisPoseSpace>(environment_.bounds, ground_.levels(), 0.137),
                0.25) {}

  const QuasiStaticAction& action() const { return action_; }
  GroundedStance At(const PlanarPose& pose) const { return {gait_, pose, 0}; }
  graph::Point PointAt(const PlanarPose& pose) const {
    return ToPoint(model_.gaits[gait_]->stance.RootPose(pose, 0));
  }

  bool StanceBySample(const PlanarPose& pose) const {
    return environment_.bounds.contains(PointAt(pose).head<2>()) && HasRoomToStand(pose);
  }

  /// The rule as it is written. Samples are in the middle of equal shares. The ground is checked
  /// for the sweep's motion within its share, the room in the frames of the strides.
  bool WayBySamples(const PlanarPose& from, const PlanarPose& to) const {
    if (from.position() == to.position() && from.yaw == to.yaw) return HasRoomToStand(from);
    const StrideClass strides = ClassOfStrides(from, to);
    const std::vector<AlignedBox3d>& boxes = volumes().sweep(strides);
    double radius = 0;
    for (const AlignedBox3d& box : boxes) {
      const Vector2d far = box.min().head<2>().cwiseAbs().cwiseMax(box.max().head<2>().cwiseAbs());
      radius = std::max(radius, far.norm());
    }
    const double inflation = QuasiStaticAction::kEdgeInflation;
    const double travel =
        (to.position() - from.position()).norm() + radius * std::abs(WrapAngle(to.yaw - from.yaw));
    const int samples = std::max(1, static_cast<int>(std::ceil(travel / (2 * inflation))));
    const std::vector<PlanarPose> stances =
        PlanStrides(model_.gaits[gait_]->stance.gait->parameters, from, to);
    const double half_stride = KeepsHeading(strides) ? 0.5 / (stances.size() - 1.0) : 0;
    for (int i = 0; i < samples; ++i) {
      const double share = (i + 0.5) / samples;
      const PlanarPose frame = Interpolate(from, to, half_stride + (1 - 2 * half_stride) * share);
      if (!GroundHolds(Interpolate(from, to, share), travel / (2 * samples))) return false;
      if (!BoxesAreFree(frame, boxes, Growth(strides))) return false;
    }
    return true;
  }

 private:
  bool HasRoomToStand(const PlanarPose& pose) const {
    return GroundHolds(pose, 0) && BoxesAreFree(pose, volumes().standing, Vector2d::Zero());
  }

  const GaitVolumes& volumes() const { return model_.gaits[gait_]->volumes; }

  /// How far strides of the class may move boxes along their axes within a share.
  static Vector2d Growth(StrideClass strides) {
    const double inflation = QuasiStaticAction::kEdgeInflation;
    return {strides == StrideClass::kSideways ? 0 : inflation,
            strides == StrideClass::kStraight ? 0 : inflation};
  }

  bool GroundHolds(const PlanarPose& pose, double clearance) const {
    double radius = 0;
    const auto& patches = model_.gaits[gait_]->stance.bearing_points;
    for (const auto& points : patches) {
      for (const Vector2d& p : points) radius = std::max(radius, p.norm());
    }
    const auto holds = [&](const Vector2d& p, double needed) {
      const std::optional<int> level = ground_.LevelAt(p, 0, 1e-6);
      return level && ground_.Clearance(*level, p) >= needed;
    };
    if (holds(pose.position(), radius + clearance + 1e-6)) return true;
    for (const auto& points : patches) {
      for (const Vector2d& p : points) {
        if (!holds(pose * p, clearance)) return false;
      }
    }
    return true;
  }

  bool BoxesAreFree(const PlanarPose& pose, const std::vector<AlignedBox3d>& boxes,
                    const Vector2d& growth) const {
    for (const AlignedBox3d& box : boxes) {
      Isometry3d X_SB = Isometry3d::Identity();
      X_SB.translation() = box.center();
      const Vector3d size = box.sizes() + 2 * Vector3d(growth.x(), growth.y(), 0);
      if (!checker_.IsFree(models::Shape::Box(size), pose.At(0) * X_SB, 0)) return false;
    }
    return true;
  }

  const LocomotionModel& model_;
  int gait_;
  models::Environment environment_;
  models::GroundMap ground_;
  World world_;
  models::CollisionChecker checker_;
  QuasiStaticAction action_;
};

TEST(StraightWay, AnswersAgreeWithSingleSamples) {
  std::mt19937 generator(5);
  std::uniform_real_distribution<double> unit(-1, 1);
  int clear = 0;
  int blocked = 0;
  for (int scene = 0; scene < 60; ++scene) {
    const StraightWays ways(scene % 2, MixedScene(&generator, scene % 12));
    for (int trial = 0; trial < 40; ++trial) {
      const PlanarPose from = RandomStance(&generator, 3);
      const double reach = trial % 2 == 0 ? 0.3 : 3;
      PlanarPose displacement{reach * unit(generator), reach * unit(generator),
                              3 * unit(generator)};
      const StrideClass strides = kStrideClasses[trial % kStrideClasses.size()];
      if (!Includes(strides, {1, 0, 0})) displacement.x = 0;
      if (!Includes(strides, {0, 1, 0})) displacement.y = 0;
      if (!Includes(strides, {0, 0, 1})) displacement.yaw = 0;
      const PlanarPose to = from * displacement;
      const bool by_samples = ways.WayBySamples(from, to);
      EXPECT_EQ(ways.action().IsClear(ways.At(from), ways.At(to)), by_samples);
      const bool ends = ways.StanceBySample(from) && ways.StanceBySample(to);
      EXPECT_EQ(ways.action().CS(ways.PointAt(from)), ways.StanceBySample(from));
      EXPECT_EQ(ways.action().CS(graph::Edge{ways.PointAt(from), ways.PointAt(to)}),
                ends && by_samples);
      ++(ends && by_samples ? clear : blocked);
    }
  }
  EXPECT_GT(clear, 150);
  EXPECT_GT(blocked, 150);
}

TEST(StraightWay, TurnsOnTheSpotAgreeWithSingleSamples) {
  std::mt19937 generator(6);
  for (int scene = 0; scene < 40; ++scene) {
    const StraightWays ways(scene % 2, MixedScene(&generator, 4));
    const PlanarPose from = RandomStance(&generator, 2.5);
    for (const double turn : {0.0, 0.2, 1.6, 3.1}) {
      const PlanarPose to{from.x, from.y, from.yaw + turn};
      EXPECT_EQ(ways.action().IsClear(ways.At(from), ways.At(to)), ways.WayBySamples(from, to));
    }
  }
}

}  // namespace
}  // namespace possibility::actions
