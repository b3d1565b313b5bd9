#include "actions/gait/swept_volume.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "models/input/input_error.h"
#include "tests/actions/drchubo1.h"
#include "tests/actions/dynamic_gaits.h"
#include "tests/actions/quadruped.h"

namespace possibility::actions {
namespace {

/// Expects that every link of the robot at `X_WL`, seen from `frame`, lies in the union of `boxes`.
/// Checked on a cloud of surface points of each shape.
void ExpectInside(const models::RobotModel& robot, const std::vector<Eigen::Isometry3d>& X_WL,
                  const PlanarPose& frame, const std::vector<Eigen::AlignedBox3d>& boxes,
                  std::mt19937* generator) {
  std::normal_distribution<double> normal;
  const Eigen::Isometry3d X_FW = frame.At(0).inverse();
  for (int link = 0; link < robot.num_links(); ++link) {
    for (const models::PosedShape& posed : robot.links[link].shapes) {
      for (int i = 0; i < 10; ++i) {
        const Eigen::Vector3d direction(normal(*generator), normal(*generator), normal(*generator));
        Eigen::Vector3d p = X_FW * X_WL[link] * posed.X_PS * posed.shape.Support(direction);
        p.z() = std::max(p.z(), SweptVolume::kGroundGap);
        const bool inside = std::any_of(boxes.begin(), boxes.end(),
                                        [&p](const auto& box) { return box.contains(p); });
        ASSERT_TRUE(inside) << robot.links[link].name << " at " << p.transpose();
      }
    }
  }
}

/// A stride of the class, of any length that the bounds allow. Every second one is of the greatest
/// length.
PlanarPose RandomStride(StrideClass strides, const models::GaitParameters& parameters,
                        std::mt19937* generator) {
  std::uniform_real_distribution<double> unit(-1, 1);
  PlanarPose share;
  if (Includes(strides, {1, 0, 0})) share.x = unit(*generator);
  if (Includes(strides, {0, 1, 0})) share.y = unit(*generator);
  if (Includes(strides, {0, 0, 1})) share.yaw = unit(*generator);
  double size = std::abs(share.x) + std::abs(share.y) + std::abs(share.yaw);
  if ((*generator)() % 2 == 0) size = std::max(size, 1.0);
  return {share.x / size * parameters.forward, share.y / size * parameters.lateral,
          share.yaw / size * parameters.turn};
}

void ExpectVolumesHoldRandomStrides(const LocomotionModel& model, int trials) {
  std::mt19937 generator(1);
  constexpr double kFine = 0.02;  // s
  dynamics::TreeKinematics kinematics(*model.robot);
  for (const auto& gait : model.gaits) {
    for (int trial = 0; trial < trials; ++trial) {
      const StrideClass strides = kStrideClasses[trial % kStrideClasses.size()];
      const PlanarPose d = RandomStride(strides, gait->stance.gait->parameters, &generator);
      for (const Phase& phase : gait->motion->Motion({PlanarPose(), d}, kFine, {})) {
        for (const Knot& knot : phase.knots) {
          kinematics.SetPosition(knot.q);
          ExpectInside(*model.robot, kinematics.X_WL(), StrideFrame(PlanarPose(), d),
                       gait->volumes.sweep(strides), &generator);
        }
      }
    }
  }
}

TEST(SweptVolumeTest, HoldsRandomStridesOfEveryClass) {
  ExpectVolumesHoldRandomStrides(DrcHubo1Locomotion(), 15);
  ExpectVolumesHoldRandomStrides(QuadrupedLocomotion(), 15);
}
TEST(SweptVolumeLong, HoldsRandomStridesOfEveryClass) {
  ExpectVolumesHoldRandomStrides(DrcHubo1Locomotion(), 300);
  ExpectVolumesHoldRandomStrides(QuadrupedLocomotion(), 300);
}

/// Whether the point lies in some box of some frame.
bool IsInside(const Eigen::Vector3d& p_W, const std::vector<PlanarPose>& frames,
              const std::vector<Eigen::AlignedBox3d>& boxes) {
  return std::any_of(frames.begin(), frames.end(), [&](const PlanarPose& frame) {
    Eigen::Vector3d p = frame.At(0).inverse() * p_W;
    p.z() = std::max(p.z(), SweptVolume::kGroundGap);
    return std::any_of(boxes.begin(), boxes.end(),
                       [&p](const auto& box) { return box.contains(p); });
  });
}

/// Expects that every link lies in the volumes of a way all through the motion. Checked on a cloud
/// of surface points of each shape.
void ExpectInside(const models::RobotModel& robot, const std::vector<Phase>& motion,
                  const std::vector<PlanarPose>& frames,
                  const std::vector<Eigen::AlignedBox3d>& boxes, std::mt19937* generator) {
  std::normal_distribution<double> normal;
  dynamics::TreeKinematics kinematics(robot);
  for (const Phase& phase : motion) {
    for (const Knot& knot : phase.knots) {
      kinematics.SetPosition(knot.q);
      for (int link = 0; link < robot.num_links(); ++link) {
        for (const models::PosedShape& posed : robot.links[link].shapes) {
          for (int i = 0; i < 4; ++i) {
            const Eigen::Vector3d direction(normal(*generator), normal(*generator),
                                            normal(*generator));
            const Eigen::Vector3d p =
                kinematics.X_WL()[link] * posed.X_PS * posed.shape.Support(direction);
            ASSERT_TRUE(IsInside(p, frames, boxes))
                << robot.links[link].name << " at " << p.transpose() << ", " << knot.t << " s";
          }
        }
      }
    }
  }
}

/// Ways of up to `most` strides of one class, of any length.
void ExpectVolumesHoldRandomWays(const std::string& name, int trials, double most) {
  const models::RobotModel& robot = DrcHubo1();
  const FlowingGait& gait = DrcHubo1Flowing(name);
  const GaitVolumes volumes = SweepGait(robot, gait.stance(), gait.motion());
  std::mt19937 generator(4);
  std::uniform_real_distribution<double> count(1, most);
  for (int trial = 0; trial < trials && !::testing::Test::HasFailure(); ++trial) {
    const StrideClass strides = kStrideClasses[trial % kStrideClasses.size()];
    const PlanarPose stride = RandomStride(strides, gait.parameters(), &generator);
    const double n = count(generator);
    const std::vector<PlanarPose> way =
        PlanStrides(gait.parameters(), {}, {n * stride.x, n * stride.y, n * stride.yaw});
    std::vector<PlanarPose> frames;
    for (std::size_t i = 0; i + 1 < way.size(); ++i) {
      frames.push_back(StrideFrame(way[i], way[i + 1]));
    }
    SCOPED_TRACE(::testing::Message() << name << ", trial " << trial << ": " << way.back().x << ", "
                                      << way.back().y << ", " << way.back().yaw);
    ExpectInside(robot, gait.motion().Motion(way, 0.03, {}), frames, volumes.sweep(strides),
                 &generator);
  }
}

class FlowingSweptVolumeTest : public ::testing::TestWithParam<std::string> {};
class FlowingSweptVolumeLong : public ::testing::TestWithParam<std::string> {};

TEST_P(FlowingSweptVolumeTest, HoldsRandomWaysOfEveryClass) {
  ExpectVolumesHoldRandomWays(GetParam(), 60, 8);
}

TEST_P(FlowingSweptVolumeLong, HoldsRandomWaysOfEveryClass) {
  ExpectVolumesHoldRandomWays(GetParam(), 500, 16);
}

const auto kGaitName = [](const auto& info) { return info.param; };
INSTANTIATE_TEST_SUITE_P(Gaits, FlowingSweptVolumeTest, ::testing::Values("walk", "crawl"),
                         kGaitName);
INSTANTIATE_TEST_SUITE_P(Gaits, FlowingSweptVolumeLong, ::testing::Values("walk", "crawl"),
                         kGaitName);

/// The farthest poses, relative to a stance of the gait, that the frame of a stride of the class
/// may have.
std::vector<PlanarPose> HalfStrides(StrideClass strides, const models::GaitParameters& p) {
  switch (strides) {
    case StrideClass::kStraight:
      return {{p.forward / 2, 0, 0}, {-p.forward / 2, 0, 0}};
    case StrideClass::kSideways:
      return {{0, p.lateral / 2, 0}, {0, -p.lateral / 2, 0}};
    case StrideClass::kOblique:
      return {{p.forward / 2, 0, 0}, {0, p.lateral / 2, 0}, {-p.forward / 4, p.lateral / 4, 0}};
    default:
      return {{}};
  }
}

TEST(SweptVolumeTest, SweepsOfHalfStridesHoldTheStandingVolume) {
  for (const LocomotionModel* model : {&DrcHubo1Locomotion(), &QuadrupedLocomotion()}) {
    for (const auto& gait : model->gaits) {
      for (const StrideClass strides : kStrideClasses) {
        for (const PlanarPose& d : HalfStrides(strides, gait->stance.gait->parameters)) {
          for (const Eigen::AlignedBox3d& box : gait->volumes.standing) {
            const Eigen::AlignedBox3d moved = box.translated(Eigen::Vector3d(d.x, d.y, 0));
            const auto& sweep = gait->volumes.sweep(strides);
            EXPECT_TRUE(std::any_of(sweep.begin(), sweep.end(),
                                    [&](const auto& other) { return other.contains(moved); }));
          }
        }
      }
    }
  }
}

TEST(SweptVolumeTest, StridesInOneDirectionNeedLessRoomAcrossIt) {
  const auto extent = [](const std::vector<Eigen::AlignedBox3d>& boxes) -> Eigen::Vector3d {
    Eigen::AlignedBox3d hull;
    for (const Eigen::AlignedBox3d& box : boxes) hull.extend(box);
    return hull.sizes();
  };
  for (const auto& gait : DrcHubo1Locomotion().gaits) {
    const GaitVolumes& volumes = gait->volumes;
    const models::GaitParameters& parameters = gait->stance.gait->parameters;
    const Eigen::Vector3d any = extent(volumes.sweep(StrideClass::kAny));
    EXPECT_LT(extent(volumes.sweep(StrideClass::kStraight)).y(), any.y() - parameters.lateral / 2);
    EXPECT_LT(extent(volumes.sweep(StrideClass::kSideways)).x(), any.x() - parameters.forward / 2);
    EXPECT_LT(extent(volumes.standing).y(),
              extent(volumes.sweep(StrideClass::kStraight)).y() - 0.02);
  }
}

TEST(SweptVolumeTest, CrawlingIsLowerThanWalking) {
  const LocomotionModel& model = DrcHubo1Locomotion();
  EXPECT_NEAR(model.gaits[0]->volumes.standing.back().max().z(), 1.25, 0.02);  // head top 1.247 m
  EXPECT_NEAR(model.gaits[1]->volumes.standing.back().max().z(), 0.80, 0.02);  // 0.78 m published
  EXPECT_NEAR(model.gaits[0]->volumes.standing.front().min().z(), SweptVolume::kGroundGap, 1e-12);
}

TEST(SweptVolumeTest, AStrideBeyondTheRobotsReachIsRefusedByGaitName) {
  models::RobotModel robot = DrcHubo1();
  for (models::Gait& gait : robot.gaits) gait.parameters.forward = 0.9;
  try {
    BuildLocomotionModel(robot, {"walk"});
    FAIL() << "a stride of 0.9 m was accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("gaits.walk.parameters: the stride"),
              std::string::npos)
        << error.what();
  }
}

TEST(SweptVolume, VolumesOfAGaitDoNotDependOnThreads) {
  const FlowingGait& gait = DrcHubo1Flowing("walk");
  const GaitVolumes one = SweepGait(DrcHubo1(), gait.stance(), gait.motion());
  const GaitVolumes several = SweepGait(DrcHubo1(), gait.stance(), gait.motion(), {}, 3);
  for (const StrideClass strides : kStrideClasses) {
    const auto& boxes = one.sweep(strides);
    ASSERT_EQ(boxes.size(), several.sweep(strides).size());
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      EXPECT_EQ(boxes[i].min(), several.sweep(strides)[i].min());
      EXPECT_EQ(boxes[i].max(), several.sweep(strides)[i].max());
    }
  }
}

}  // namespace
}  // namespace possibility::actions
