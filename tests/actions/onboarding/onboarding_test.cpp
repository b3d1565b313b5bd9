// From DRC-HUBO1's URDF to a robot, without its hand-written YAML.

#include <gtest/gtest.h>

#include <random>

#include "actions/onboarding/foot_placement.h"
#include "actions/onboarding/gait_numbers.h"
#include "actions/onboarding/robot_draft.h"
#include "actions/onboarding/robot_yaml_writer.h"
#include "actions/onboarding/standing_posture.h"
#include "actions/onboarding/touching_pairs.h"
#include "actions/wholebody/nominal_stance.h"
#include "dynamics/tree/tree_kinematics.h"
#include "models/facts/zero_poses.h"
#include "models/input/file_contents.h"
#include "models/robot/robot_yaml.h"
#include "models/world/collision.h"
#include "tests/models/temporary_folder.h"

namespace possibility::actions {
namespace {

using Eigen::Vector3d;

const std::string kDraftUrdf =
    std::string(POSSIBILITY_SOURCE_DIR) + "/models/drchubo1/drchubo1.urdf";

class OnboardingTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { draft_ = new RobotDraft(DraftRobot(kDraftUrdf, {}, {})); }
  static void TearDownTestSuite() { delete draft_; }
  static const RobotDraft& draft() { return *draft_; }
  static models::RobotModel Published() {
    return models::LoadRobotModel(std::string(POSSIBILITY_SOURCE_DIR) +
                                  "/models/drchubo1/drchubo1.yaml");
  }

 private:
  static inline RobotDraft* draft_ = nullptr;
};

TEST_F(OnboardingTest, MassesAndJointsAreThoseOfTheHandWrittenRobot) {
  const models::RobotModel published = Published();
  ASSERT_EQ(draft().robot.num_joints(), published.num_joints());
  for (int i = 0; i < published.num_links(); ++i) {
    EXPECT_EQ(draft().robot.links[i].name, published.links[i].name);
    EXPECT_EQ(draft().robot.links[i].inertial.mass, published.links[i].inertial.mass);
  }
}

// The author's sole is 1 mm above the hull's lowest point; its outline was measured by hand.
TEST_F(OnboardingTest, SolesAreNearTheHandWrittenOnes) {
  const models::RobotModel published = Published();
  for (const int side : {0, 1}) {
    const models::ContactPatch& sole = draft().robot.contacts[side];
    const models::ContactPatch& known = published.contacts[published.ContactIndex(sole.name)];
    EXPECT_EQ(draft().robot.links[sole.link].name, published.links[known.link].name);
    EXPECT_LT((sole.Centre() - known.Centre()).norm(), 0.01);
  }
}

TEST_F(OnboardingTest, FeetGoWhereJointsWouldPutThem) {
  std::mt19937 random(61);
  std::uniform_real_distribution<double> uniform(0, 1);
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(draft().robot.num_joints());
  for (int trial = 0; trial < 20; ++trial) {
    const int side = trial % 2;
    const FootPlacement placement(draft(), side);
    const double y = (side == 0 ? 1 : -1) * (0.08 + 0.06 * uniform(random));
    const Vector3d centre(0.2 * (uniform(random) - 0.5), y, -0.65 - 0.1 * uniform(random));
    const auto leg = placement.Solve(centre, 0.01, rest);
    ASSERT_TRUE(leg.has_value()) << centre.transpose();
    Eigen::VectorXd joints = rest;
    const std::vector<int>& indices = side == 0 ? draft().left_leg : draft().right_leg;
    for (int i = 0; i < 6; ++i) {
      joints[indices[i]] = (*leg)[i];
      EXPECT_GE((*leg)[i], draft().robot.joints[indices[i]].lower + 0.01 - 1e-9);
      EXPECT_LE((*leg)[i], draft().robot.joints[indices[i]].upper - 0.01 + 1e-9);
    }
    const models::ContactPatch& sole = draft().robot.contacts[side];
    const auto X_RL = models::PosesInRoot(draft().robot, joints);
    EXPECT_LT((X_RL[sole.link] * sole.Centre() - centre).norm(), 1e-8);
    EXPECT_LT((X_RL[sole.link].linear() * sole.normal_L + Vector3d::UnitZ()).norm(), 1e-8);
  }
}

TEST_F(OnboardingTest, OutOfReachThereIsNoPosture) {
  std::string reason;
  EXPECT_FALSE(StandWith(draft(), {1.2, 1}, &reason).has_value());
  EXPECT_NE(reason.find("leg cannot put its sole level"), std::string::npos) << reason;
}

TEST_F(OnboardingTest, StandsBalancedOnLevelSolesAndTouchesNothing) {
  for (const double extension : {0.8, 0.9}) {
    std::string reason;
    const auto standing = StandWith(draft(), {extension, 0.9}, &reason);
    ASSERT_TRUE(standing.has_value()) << reason;
    dynamics::TreeKinematics kinematics(draft().robot);
    kinematics.SetPosition(draft().robot.Configuration(standing->posture));
    double front = -1, back = 1;
    for (const models::ContactPatch& sole : draft().robot.contacts) {
      for (const Vector3d& p : sole.points) {
        const Vector3d place = kinematics.Position(sole.link, p);
        EXPECT_NEAR(place.z(), 0, 1e-7);
        front = std::max(front, place.x());
        back = std::min(back, place.x());
      }
    }
    const double com = kinematics.CentreOfMass().x();
    EXPECT_GT(com, back + 0.25 * (front - back));
    EXPECT_LT(com, front - 0.25 * (front - back));
    // Arms hang clear of the rest.
    const models::CollisionChecker checker(draft().robot, models::Environment());
    for (const auto& pair : checker.SelfProximities(kinematics.X_WL(), 0.01)) {
      const bool is_listed = [&] {
        for (const IgnoredPair& ignored : TouchingPairs(draft(), standing->posture.joints)) {
          if (ignored.link == pair.link && ignored.other == pair.other) return true;
        }
        return false;
      }();
      EXPECT_TRUE(is_listed) << draft().robot.links[pair.link].name << " and "
                             << draft().robot.links[pair.other].name;
    }
  }
}

TEST_F(OnboardingTest, TheFileThatIsWrittenIsTheRobot) {
  RobotDraft copy = draft();
  std::string reason;
  const auto standing = StandWith(copy, {0.88, 0.9}, &reason);
  ASSERT_TRUE(standing.has_value()) << reason;
  copy.robot.name = "a \"quoted\" robot";
  copy.ignored = TouchingPairs(copy, standing->posture.joints);
  copy.robot.gaits = {{"walk",
                       standing->posture,
                       {{0, true, copy.left_leg}, {1, true, copy.right_leg}},
                       ScaledParameters(copy, 1, 1)}};
  const models::TemporaryFolder folder;
  folder.Write("robot.urdf", models::ReadFileContents(kDraftUrdf));
  const models::RobotModel robot =
      models::LoadRobotModel(folder.Write("robot.yaml", RobotYaml(copy, "robot.urdf")));
  EXPECT_EQ(robot.name, copy.robot.name);
  EXPECT_EQ(robot.sagittal_pairs.size(), copy.pairs.pairs.size());
  EXPECT_EQ(robot.ignored_collisions.size(), copy.ignored.size());
  for (int i = 0; i < robot.num_links(); ++i) {
    ASSERT_EQ(robot.links[i].shapes.size(), copy.robot.links[i].shapes.size());
    for (std::size_t s = 0; s < robot.links[i].shapes.size(); ++s) {
      const auto& read = robot.links[i].shapes[s];
      const auto& written = copy.robot.links[i].shapes[s];
      const Eigen::AlignedBox3d a = read.shape.Bounds(read.X_PS);
      const Eigen::AlignedBox3d b = written.shape.Bounds(written.X_PS);
      EXPECT_LT((a.min() - b.min()).norm() + (a.max() - b.max()).norm(), 1e-5);
    }
  }
  // The nominal stance needs no correction.
  const NominalStance stance = SolveNominalStance(robot, robot.gaits.front());
  EXPECT_LT((stance.q - robot.Configuration(standing->posture)).norm(), 1e-4);
}

TEST_F(OnboardingTest, NumbersScaleWithTheLeg) {
  RobotDraft twice = draft();
  twice.leg_length *= 2;
  twice.sole_width *= 2;
  const models::GaitParameters one = ScaledParameters(draft(), 1, 1);
  const models::GaitParameters two = ScaledParameters(twice, 1, 1);
  EXPECT_NEAR(two.forward, 2 * one.forward, 1e-12);
  EXPECT_NEAR(two.com_margin, 2 * one.com_margin, 1e-12);
  EXPECT_NEAR(two.swing_time, std::sqrt(2) * one.swing_time, 1e-12);
  EXPECT_EQ(two.turn, one.turn);
  EXPECT_EQ(two.com_acceleration, one.com_acceleration);
}

}  // namespace
}  // namespace possibility::actions
