#include "actions/gait/dynamic_gait.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <ostream>
#include <random>
#include <string>
#include <vector>

#include "actions/verify/verifier.h"
#include "tests/actions/dynamic_gaits.h"
#include "tests/actions/load_steps.h"
#include "tests/actions/standing_plan.h"

namespace possibility::actions {
namespace {

constexpr double kKnotSpacing = 0.1;

/// What the verifier says of a motion between two stances on a flat floor; empty if accepted.
std::string FaultsOf(const std::vector<Phase>& motion, const std::string& gait,
                     const PlanarPose& from, const PlanarPose& to, bool simulates = false) {
  const models::RobotModel& robot = DrcHubo1();
  models::Scenario scenario = testing::FlatScenario();
  constexpr double kHalf = 70;  // m
  scenario.environment.obstacles.front().shape = models::Shape::Box({2 * kHalf, 2 * kHalf, 0.1});
  scenario.environment.bounds =
      Eigen::AlignedBox2d(Eigen::Vector2d(-kHalf, -kHalf), Eigen::Vector2d(kHalf, kHalf));
  scenario.actions = {gait};
  scenario.start = {gait, from.x, from.y, 0, from.yaw};
  scenario.goals = {{gait, to.x, to.y, 0, to.yaw}};
  Plan plan;
  plan.robot_file = robot.file;
  plan.robot_hash = robot.content_hash;
  plan.scenario_file = scenario.file;
  plan.scenario_hash = scenario.content_hash;
  for (const models::Joint& joint : robot.joints) plan.joints.push_back(joint.name);
  plan.segments.push_back({gait, motion});
  VerifierSettings settings;
  settings.simulates = simulates;
  const VerificationReport report = Verify(plan, robot, scenario, settings);
  std::string faults;
  for (const Violation& violation : report.violations) {
    faults += fmt::format("{}: {} {} at {} s, limit {}\n", ToString(violation.kind),
                          violation.quantity, violation.value, violation.time, violation.limit);
  }
  return faults;
}

double Duration(const std::vector<Phase>& motion) { return motion.back().knots.back().t; }

/// The motion along one way is accepted by the verifier and no slower than expected.
struct SpeedCase {
  std::string name;
  std::string gait;
  PlanarPose way;
  double distance = 0;  ///< m or rad
  double speed = 0;     ///< least mean speed from rest to rest, m/s or rad/s
};

void PrintTo(const SpeedCase& speed_case, std::ostream* stream) { *stream << speed_case.name; }

class DynamicGaitSpeed : public ::testing::TestWithParam<SpeedCase> {};

TEST_P(DynamicGaitSpeed, IsReachedFromRestToRestAndVerified) {
  const SpeedCase& given = GetParam();
  const FlowingGait& gait = DrcHubo1Flowing(given.gait);
  const std::vector<Phase> motion =
      gait.motion().Motion(StridesThrough(gait.parameters(), {{}, given.way}), kKnotSpacing, {});
  const double speed = given.distance / Duration(motion);
  RecordProperty("mm_or_mrad_per_s", static_cast<int>(1000 * speed));
  EXPECT_GT(speed, given.speed);
  EXPECT_EQ(FaultsOf(motion, given.gait, {}, given.way), "");
}

INSTANTIATE_TEST_SUITE_P(Ways, DynamicGaitSpeed,
                         ::testing::Values(SpeedCase{"walk_ahead", "walk", {5, 0, 0}, 5, 0.45},
                                           SpeedCase{"crawl_ahead", "crawl", {5, 0, 0}, 5, 0.3},
                                           SpeedCase{"walk_turn",
                                                     "walk",
                                                     {0, 0, std::numbers::pi},
                                                     std::numbers::pi,
                                                     30 * std::numbers::pi / 180},
                                           SpeedCase{"walk_aside", "walk", {0, 2, 0}, 2, 0.15}),
                         [](const auto& info) { return info.param.name; });

class DynamicGaitTest : public ::testing::TestWithParam<std::string> {
 protected:
  double Random() { return std::uniform_real_distribution<double>(-1, 1)(generator_); }

  /// Up to three straight ways of strides with turns on the way, end to end.
  std::vector<PlanarPose> RandomWay() {
    std::vector<PlanarPose> stances = {{Random(), Random(), 3 * Random()}};
    const auto ways = 1 + generator_() % 3;
    for (std::size_t i = 0; i < ways; ++i) {
      stances.push_back(stances.back() *
                        PlanarPose{0.8 * Random(), 0.3 * Random(), 0.8 * Random()});
    }
    return StridesThrough(gait_.parameters(), stances);
  }

  const FlowingGait& gait_ = DrcHubo1Flowing(GetParam());
  std::mt19937 generator_{11};
};

TEST_P(DynamicGaitTest, RandomWaysVerify) {
  for (int trial = 0; trial < 20; ++trial) {
    const std::vector<PlanarPose> way = RandomWay();
    const std::vector<Phase> motion = gait_.motion().Motion(way, kKnotSpacing, {});
    EXPECT_EQ(FaultsOf(motion, GetParam(), way.front(), way.back()), "") << trial;
  }
}

TEST_P(DynamicGaitTest, LimbsBearLittleWhereTheyLiftAndComeDown) {
  double greatest = 0;
  for (int trial = 0; trial < 20; ++trial) {
    const std::vector<Phase> motion = gait_.motion().Motion(RandomWay(), kKnotSpacing, {});
    const double load = testing::GreatestLoadAtContactChanges(DrcHubo1(), motion);
    EXPECT_LT(load, 0.02) << trial;
    greatest = std::max(greatest, load);
  }
  RecordProperty("ten_thousandths_of_the_weight", static_cast<int>(1e4 * greatest));
}

TEST_P(DynamicGaitTest, TorquesAreContinuousWhereLimbsLiftAndComeDown) {
  constexpr double kStep = 3;  // N m, of up to 70
  double greatest = 0;
  for (int trial = 0; trial < 20; ++trial) {
    const std::vector<Phase> motion = gait_.motion().Motion(RandomWay(), kKnotSpacing, {});
    const double step = testing::GreatestTorqueStep(motion);
    EXPECT_LT(step, kStep) << trial;
    greatest = std::max(greatest, step);
  }
  RecordProperty("mN_m", static_cast<int>(1000 * greatest));
}

TEST_P(DynamicGaitTest, SimulationFollowsTheMotion) {
  const PlanarPose end{0.5, 0.1, 0.2};
  const std::vector<Phase> motion =
      gait_.motion().Motion(StridesThrough(gait_.parameters(), {{}, end}), kKnotSpacing, {});
  EXPECT_EQ(FaultsOf(motion, GetParam(), {}, end, true), "");
}

TEST_P(DynamicGaitTest, SameStridesGiveTheSameMotion) {
  const std::vector<PlanarPose> way = RandomWay();
  const std::vector<Phase> motion = gait_.motion().Motion(way, kKnotSpacing, {});
  const FlowingGait other(DrcHubo1(), GetParam());
  const std::vector<Phase> again = other.motion().Motion(way, kKnotSpacing, {});
  ASSERT_EQ(motion.size(), again.size());
  for (std::size_t i = 0; i < motion.size(); ++i) {
    ASSERT_EQ(motion[i].knots.size(), again[i].knots.size());
    for (std::size_t k = 0; k < motion[i].knots.size(); ++k) {
      EXPECT_EQ(motion[i].knots[k].q, again[i].knots[k].q);
    }
  }
}

TEST_P(DynamicGaitTest, PacesAreFromQuickToSlow) {
  const std::vector<Pace>& paces = gait_.motion().paces();
  ASSERT_FALSE(paces.empty());
  for (std::size_t i = 0; i + 1 < paces.size(); ++i) {
    EXPECT_GT(paces[i].speed(), paces[i + 1].speed());
  }
}

TEST_P(DynamicGaitTest, ExpectedDurationOfFurtherStridesAheadIsThatOfTheMotion) {
  const auto duration = [&](int strides) {
    const PlanarPose goal{strides * gait_.parameters().forward, 0, 0};
    return Duration(
        gait_.motion().Motion(StridesThrough(gait_.parameters(), {{}, goal}), kKnotSpacing, {}));
  };
  const double further = duration(48) - duration(12);  // a way takes whole steps
  EXPECT_NEAR(gait_.motion().ExpectedDuration(48) - gait_.motion().ExpectedDuration(12), further,
              0.05 * further);
  EXPECT_EQ(gait_.motion().ExpectedDuration(0), 0);
}

TEST_P(DynamicGaitTest, SlowJointsLeaveTheQuasiStaticGait) {
  models::RobotModel robot = DrcHubo1();
  robot.content_hash = "slow";
  for (models::Joint& joint : robot.joints) joint.velocity *= 0.25;
  const FlowingGait slow(robot, GetParam());
  EXPECT_TRUE(slow.motion().paces().empty());
  const QuasiStaticGait quasi_static(robot, slow.stance());
  const std::vector<PlanarPose> way = {{}, {0.05, 0, 0}};
  EXPECT_EQ(slow.motion().ExpectedDuration(3), quasi_static.ExpectedDuration(3));
  const std::vector<Phase> motion = slow.motion().Motion(way, kKnotSpacing, {});
  const std::vector<Phase> expected = quasi_static.Motion(way, kKnotSpacing, {});
  ASSERT_EQ(motion.size(), expected.size());
  EXPECT_EQ(Duration(motion), Duration(expected));
  EXPECT_EQ(motion.back().knots.back().q, expected.back().knots.back().q);
}

INSTANTIATE_TEST_SUITE_P(Gaits, DynamicGaitTest, ::testing::Values("walk", "crawl"),
                         [](const auto& info) { return info.param; });

/// Instants at which a motion is at rest between two phases, s, its beginning and its end.
std::vector<double> Rests(const std::vector<Phase>& motion) {
  std::vector<double> rests = {0};
  for (const Phase& phase : motion) {
    const Knot& knot = phase.knots.back();
    if (knot.v.norm() < 1e-6 && knot.a.norm() < 1e-6) rests.push_back(knot.t);
  }
  return rests;
}

TEST(DynamicGait, ALongFlowRestsInTimeInAStanceOnItsWay) {
  for (const std::string name : {"walk", "crawl"}) {
    const LocomotionModel::GaitEntry& gait =
        *DrcHubo1Locomotion().gaits[DrcHubo1Locomotion().GaitIndex(name)];
    // 60 m straight ahead, and a third of it with a bend every metre.
    const PlanarPose far{60, 0, 0};
    std::vector<PlanarPose> straight = PlanStrides(gait.gait.parameters, {}, far);
    std::vector<PlanarPose> bent = {PlanarPose()};
    for (int i = 0; i < 20; ++i) {
      const PlanarPose next = bent.back() * PlanarPose{1, 0, 0};
      for (const PlanarPose& to : {next, next * PlanarPose{0, 0, i % 2 == 0 ? 0.5 : -0.5}}) {
        const auto more = PlanStrides(gait.gait.parameters, bent.back(), to);
        bent.insert(bent.end(), more.begin() + 1, more.end());
      }
    }
    for (const std::vector<PlanarPose>& strides : {straight, bent}) {
      const std::vector<Phase> motion =
          gait.motion->Flow(StraightLines(strides), {}, kKnotSpacing, {});
      const std::vector<double> rests = Rests(motion);
      EXPECT_NEAR(rests.back(), Duration(motion), 1e-9);
      EXPECT_GT(rests.size(), 2u);
      for (std::size_t i = 1; i < rests.size(); ++i) {
        EXPECT_LT(rests[i] - rests[i - 1], 1.1 * kLongestFlow) << name;
        EXPECT_GT(rests[i] - rests[i - 1], 0.4 * kLongestFlow) << name;
      }
      EXPECT_EQ(FaultsOf({motion.begin(), motion.end()}, name, strides.front(), strides.back()),
                "");
    }
  }
}

/// Stopping aside, the expected duration of a way is the sum of its strides' shares.
TEST(DynamicGait, ExpectedDurationOfAWayIsTheSumOfItsStrides) {
  const LocomotionModel::GaitEntry& walk = *DrcHubo1Locomotion().gaits[0];
  const models::GaitParameters& parameters = walk.gait.parameters;
  const auto strides_of = [&](const PlanarPose& from, const PlanarPose& to) {
    const std::vector<PlanarPose> strides = PlanStrides(parameters, from, to);
    double duration = 0;
    for (std::size_t i = 1; i < strides.size(); ++i) {
      duration +=
          walk.motion->DisplacementDuration(parameters, strides[i - 1].Inverse() * strides[i]);
    }
    return duration;
  };
  const PlanarPose ahead{1, 0, 0};
  const double stop = walk.motion->WayDuration(parameters, {}, ahead) - strides_of({}, ahead);
  EXPECT_GT(stop, 0);
  std::mt19937 generator(4);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int way = 0; way < 2000; ++way) {
    const PlanarPose from{3 * unit(generator), 3 * unit(generator), 3 * unit(generator)};
    // Of every class of strides: parts of the displacement are left out in turn.
    PlanarPose displacement{2 * unit(generator), unit(generator), 3 * unit(generator)};
    if ((way & 1) != 0) displacement.x = 0;
    if ((way & 2) != 0) displacement.y = 0;
    if ((way & 4) != 0) displacement.yaw = 0;
    const PlanarPose to = from * displacement;
    const double expected = (way & 7) == 7 ? 0 : stop + strides_of(from, to);
    EXPECT_NEAR(walk.motion->WayDuration(parameters, from, to), expected, 1e-9) << way;
  }
}

}  // namespace
}  // namespace possibility::actions
