#include "actions/swept_volume.h"

#include <gtest/gtest.h>

#include <random>

#include "models/input_error.h"
#include "tests/actions/drchubo1.h"

namespace possibility::actions {
namespace {

/// Every link of the robot at `X_WL`, seen from `frame`, must lie in the union of `boxes`. Checked
/// on a cloud of surface points of each shape.
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

TEST(SweptVolumeTest, HoldsRandomStridesOfEveryGait) {
  const LocomotionModel& model = DrcHubo1Locomotion();
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> unit(-1, 1);
  MotionSettings fine;
  fine.knot_spacing = 0.02;
  MotionBuilder builder(*model.robot, fine);
  dynamics::TreeKinematics kinematics(*model.robot);
  for (const auto& gait : model.gaits) {
    const models::GaitParameters& parameters = gait->stance.gait->parameters;
    for (int trial = 0; trial < 15; ++trial) {
      PlanarPose d{unit(generator), unit(generator), unit(generator)};
      const double size = std::abs(d.x) + std::abs(d.y) + std::abs(d.yaw);
      d = {d.x / size * parameters.forward, d.y / size * parameters.lateral,
           d.yaw / size * parameters.turn};
      for (const Phase& phase :
           builder.Build(gait->motion->Phases({PlanarPose(), d}, 0, 1), gait->stance.q)) {
        for (const Knot& knot : phase.knots) {
          kinematics.SetPosition(knot.q);
          ExpectInside(*model.robot, kinematics.X_WL(), GaitMotion::StrideFrame(PlanarPose(), d),
                       gait->sweep, &generator);
        }
      }
    }
  }
}

TEST(SweptVolumeTest, CrawlingIsLowerThanWalking) {
  const LocomotionModel& model = DrcHubo1Locomotion();
  EXPECT_NEAR(model.gaits[0]->sweep.back().max().z(), 1.25, 0.02);  // head top 1.247 m
  EXPECT_NEAR(model.gaits[1]->sweep.back().max().z(), 0.80, 0.02);  // 0.78 m published
  EXPECT_NEAR(model.gaits[0]->sweep.front().min().z(), SweptVolume::kGroundGap, 1e-12);
}

TEST(SweptVolumeTest, AGaitTheRobotCannotWalkIsRefusedByName) {
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

}  // namespace
}  // namespace possibility::actions
