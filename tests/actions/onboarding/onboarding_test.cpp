// From DRC-HUBO1's URDF to a robot, without its hand-written YAML.

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <random>

#include "actions/onboarding/facing.h"
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
#include "models/input/input_error.h"
#include "models/robot/robot_yaml.h"
#include "models/world/collision.h"
#include "tests/message_of.h"
#include "tests/models/temporary_folder.h"
#include "tests/replaced.h"

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
  EXPECT_NE(reason.find("out of reach"), std::string::npos) << reason;
}

TEST_F(OnboardingTest, TheJointThatForbidsAPostureIsNamed) {
  RobotDraft stiff = draft();
  stiff.robot.joints[stiff.robot.JointIndex("LKP")].upper = 0.1;
  std::string reason;
  EXPECT_FALSE(StandWith(stiff, {0.8, 1}, &reason).has_value());
  EXPECT_NE(reason.find("the left leg cannot"), std::string::npos) << reason;
  EXPECT_NE(reason.find("'LKP' would be at"), std::string::npos) << reason;
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
  copy.robot.gaits.front().parameters.sway = 0.08;
  const models::TemporaryFolder folder;
  folder.Write("robot.urdf", models::ReadFileContents(kDraftUrdf));
  const models::RobotModel robot =
      models::LoadRobotModel(folder.Write("robot.yaml", RobotYaml(copy, "robot.urdf")));
  EXPECT_EQ(robot.name, copy.robot.name);
  EXPECT_NEAR(robot.gaits.front().parameters.sway, 0.08, 1e-5);
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

/// The draft of DRC-HUBO1 with a change in its URDF.
RobotDraft DraftOf(const std::string& urdf) {
  const models::TemporaryFolder folder;
  return DraftRobot(folder.Write("robot.urdf", urdf), {}, {});
}

TEST_F(OnboardingTest, WithoutCollisionShapesWhatIsSeenStandsForThem) {
  const std::string urdf =
      ReplacedEverywhere(models::ReadFileContents(kDraftUrdf), "collision>", "visual>");
  const RobotDraft seen = DraftOf(urdf);
  for (int i = 0; i < draft().robot.num_links(); ++i) {
    EXPECT_EQ(seen.robot.links[i].shapes.size(), draft().robot.links[i].shapes.size());
  }
  for (const int side : {0, 1}) {
    EXPECT_EQ(seen.robot.contacts[side].points, draft().robot.contacts[side].points);
  }
  ASSERT_EQ(seen.warnings.size(), draft().warnings.size() + 1);
  EXPECT_NE(seen.warnings.front().find("a foot has no collision shape"), std::string::npos);
}

// iCub's root looks backward.
TEST_F(OnboardingTest, ARobotThatLooksBackwardIsTurned) {
  EXPECT_FALSE(FacesBackward(draft()));
  const std::string urdf = models::ReadFileContents(kDraftUrdf);
  const RobotDraft turned = DraftOf(WithTurnedRoot(urdf, draft().tree.root));
  EXPECT_FALSE(FacesBackward(turned));
  EXPECT_EQ(turned.plan.left_leg.joints, draft().plan.left_leg.joints);
  EXPECT_NEAR(turned.leg_length, draft().leg_length, 1e-9);
  for (const int side : {0, 1}) {
    const auto places = [&](const RobotDraft& of) {
      const models::ContactPatch& patch = of.robot.contacts[side];
      return Vector3d(
          models::PosesInRoot(of.robot, Eigen::VectorXd::Zero(of.robot.num_joints()))[patch.link] *
          patch.Centre());
    };
    EXPECT_LT((places(turned) - places(draft())).norm(), 1e-9);
  }
  EXPECT_NE(turned.warnings.back().find("looks along -x"), std::string::npos);
}

// The foot's front edge, 2 cm deep, is lower than the sole by a tilt: it is no sole.
TEST_F(OnboardingTest, TheEdgeOfATiltedFootIsNoSole) {
  std::string urdf = models::ReadFileContents(kDraftUrdf);
  for (const std::string foot : {"Body_LAR", "Body_RAR"}) {
    const std::size_t link = urdf.find("<link name=\"" + foot + "\">");
    const std::size_t end = urdf.find("</link>", link);
    const std::size_t begin = urdf.find("<collision>", link);
    urdf.replace(begin, end - begin,
                 "<collision><origin xyz=\"0.03 0 -0.08\" rpy=\"0 0.1 0\"/><geometry><box "
                 "size=\"0.2 0.1 0.08\"/></geometry></collision><collision><origin xyz=\"0.127 0 "
                 "-0.125\"/><geometry><box size=\"0.02 0.1 0.02\"/></geometry></collision>");
  }
  const RobotDraft tilted = DraftOf(urdf);
  const models::ContactPatch& sole = tilted.robot.contacts[0];
  const Eigen::Vector3d toe = sole.points[0] - sole.Centre();
  const std::string warnings = fmt::format("{}", fmt::join(tilted.warnings, "; "));
  EXPECT_NE(warnings.find("the sole of link 'Body_LAR' is tilted"), std::string::npos) << warnings;
  EXPECT_GT(toe.norm(), 0.06);
  EXPECT_NEAR(sole.normal_L.dot(toe), 0, 1e-3);
}

// A box's moments are known.
TEST_F(OnboardingTest, AnInertiaThatNoBodyHasIsThatOfTheShapes) {
  std::string urdf = models::ReadFileContents(kDraftUrdf);
  const std::size_t hip = urdf.find("<link name=\"Body_RHY\">");
  const std::size_t begin = urdf.find("ixx=\"", hip);
  urdf.insert(begin + 5, "-");
  const RobotDraft repaired = DraftOf(urdf);
  ASSERT_EQ(repaired.inertials.size(), 1u);
  EXPECT_EQ(repaired.inertials[0].link, "Body_RHY");
  const int link = draft().robot.LinkIndex("Body_RHY");
  const models::Inertial& body = repaired.robot.links[link].inertial;
  EXPECT_EQ(body.mass, draft().robot.links[link].inertial.mass);
  EXPECT_EQ(body.p_LC, draft().robot.links[link].inertial.p_LC);
  const Vector3d squares = Vector3d(0.133, 0.0899, 0.1859).cwiseAbs2();
  const Eigen::Matrix3d expected =
      (body.mass / 12 * (squares.sum() * Vector3d::Ones() - squares)).asDiagonal();
  EXPECT_LT((body.I_LC - expected).norm(), 1e-9);
  EXPECT_NE(repaired.warnings.front().find("link 'Body_RHY': inertia is not positive definite"),
            std::string::npos);
}

TEST_F(OnboardingTest, AnInertiaThatNoBodyHasIsAnErrorWithoutShapes) {
  std::string urdf =
      ReplacedEverywhere(models::ReadFileContents(kDraftUrdf), "collision>", "ignored>");
  urdf.insert(urdf.find("ixx=\"", urdf.find("<link name=\"Body_RHY\">")) + 5, "-");
  const std::string error = MessageOf<InputError>([&] { DraftOf(urdf); });
  EXPECT_NE(error.find("link 'Body_RHY': inertia is not positive definite"), std::string::npos);
  EXPECT_NE(error.find("expected an <inertial> that a body can have"), std::string::npos) << error;
}

TEST_F(OnboardingTest, AShapeLargerThanAnyRobotIsAnError) {
  std::string urdf = models::ReadFileContents(kDraftUrdf);
  const std::size_t size = urdf.find("<box size=\"") + 11;
  urdf.replace(size, urdf.find(' ', size) - size, "1e5");
  const std::string error = MessageOf<InputError>([&] { DraftOf(urdf); });
  EXPECT_NE(error.find("reaches 5e+04 m from the link's origin, expected at most 100 m"),
            std::string::npos)
      << error;
}

TEST_F(OnboardingTest, WhatWasAssumedOfInertiasIsWritten) {
  RobotDraft copy = draft();
  models::Inertial body = copy.robot.links[3].inertial;
  body.I_LC *= 1.25;
  copy.inertials = {{copy.robot.links[3].name, body, "a \"reason\""}};
  std::string reason;
  const auto standing = StandWith(copy, {0.88, 0.9}, &reason);
  ASSERT_TRUE(standing.has_value()) << reason;
  copy.robot.name = "robot";
  copy.robot.gaits = {{"walk",
                       standing->posture,
                       {{0, true, copy.left_leg}, {1, true, copy.right_leg}},
                       ScaledParameters(copy, 1, 1)}};
  const models::TemporaryFolder folder;
  folder.Write("robot.urdf", models::ReadFileContents(kDraftUrdf));
  const models::RobotModel robot =
      models::LoadRobotModel(folder.Write("robot.yaml", RobotYaml(copy, "robot.urdf")));
  EXPECT_TRUE(robot.links[3].inertial.I_LC.isApprox(body.I_LC, 1e-8));
  EXPECT_TRUE(robot.links[4].inertial.I_LC.isApprox(copy.robot.links[4].inertial.I_LC, 1e-12));
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
