#include "actions/gait/foothold_plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "actions/gait/stride.h"
#include "tests/actions/drchubo1.h"
#include "tests/actions/dynamic_gaits.h"
#include "tests/actions/quadruped.h"

namespace possibility::actions {
namespace {

using Eigen::Vector2d;
using Groups = std::vector<std::vector<int>>;

/// Bounds of long steps: those that DRC-HUBO1 can walk and crawl with.
StepBounds LongSteps(const models::GaitParameters& parameters) {
  return {1.4 * parameters.forward, 3 * parameters.lateral, 3 * parameters.turn};
}

double Effort(const StepBounds& bounds, const PlanarPose& d) {
  return CombinedEffort(d.x / bounds.forward, d.y / bounds.lateral, WrapAngle(d.yaw) / bounds.turn);
}

/// Distance of two convex patches across the line that separates them best, among the normals of
/// all lines through two points of one patch; negative where they overlap.
double Separation(const std::vector<Vector2d>& a, const std::vector<Vector2d>& b) {
  std::vector<Vector2d> directions = {b.front() - a.front()};
  for (const auto* patch : {&a, &b}) {
    for (const Vector2d& p : *patch) {
      for (const Vector2d& q : *patch) {
        if (p != q) directions.emplace_back(q.y() - p.y(), p.x() - q.x());
      }
    }
  }
  double separation = -std::numeric_limits<double>::infinity();
  for (const Vector2d& direction : directions) {
    const Vector2d unit = direction.normalized();
    double top_of_a = -std::numeric_limits<double>::infinity();
    double bottom_of_b = std::numeric_limits<double>::infinity();
    for (const Vector2d& p : a) top_of_a = std::max(top_of_a, unit.dot(p));
    for (const Vector2d& p : b) bottom_of_b = std::min(bottom_of_b, unit.dot(p));
    separation = std::max(separation, bottom_of_b - top_of_a);
  }
  return separation;
}

/// Where the groups of limbs stand.
class Footholds {
 public:
  Footholds(const NominalStance& stance, const Groups& groups, const PlanarPose& start)
      : stance_(stance), groups_(groups), at_(groups.size(), start) {}

  void Take(const Step& step) { at_[step.group] = step.stance; }
  const std::vector<PlanarPose>& at() const { return at_; }

  /// Least separation of the patches of two groups.
  double Separation() const {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < groups_.size(); ++i) {
      for (std::size_t k = 0; k < i; ++k) {
        for (const int limb : groups_[i]) {
          for (const int other : groups_[k]) {
            least = std::min(least, actions::Separation(Patch(limb, at_[i]), Patch(other, at_[k])));
          }
        }
      }
    }
    return least;
  }

 private:
  std::vector<Vector2d> Patch(int limb, const PlanarPose& at) const {
    std::vector<Vector2d> points;
    for (const Vector2d& p : stance_.bearing_points[limb]) points.push_back(at * p);
    return points;
  }

  const NominalStance& stance_;
  const Groups& groups_;
  std::vector<PlanarPose> at_;
};

std::set<std::set<std::string>> ContactsOf(const models::RobotModel& robot,
                                           const NominalStance& stance) {
  std::set<std::set<std::string>> names;
  for (const std::vector<int>& group : SwingGroups(stance)) {
    std::set<std::string> contacts;
    for (const int limb : group) {
      contacts.insert(robot.contacts[stance.gait->limbs[limb].contact].name);
    }
    names.insert(contacts);
  }
  return names;
}

class FootholdPlanTest : public ::testing::TestWithParam<std::string> {
 protected:
  double Random() { return std::uniform_real_distribution<double>(-1, 1)(generator_); }

  std::vector<PlanarPose> Strides(const std::vector<PlanarPose>& stances) const {
    return StridesThrough(parameters_, stances);
  }

  /// Up to four ways, each straight, aside, oblique, a turn on the spot or all at once.
  std::vector<PlanarPose> RandomWay() {
    std::vector<PlanarPose> stances = {{Random(), Random(), 3 * Random()}};
    const auto ways = 1 + generator_() % 4;
    for (std::size_t i = 0; i < ways; ++i) {
      const StrideClass strides = kStrideClasses[generator_() % kStrideClasses.size()];
      PlanarPose d;
      if (Includes(strides, {1, 0, 0})) d.x = 1.5 * Random();
      if (Includes(strides, {0, 1, 0})) d.y = 0.7 * Random();
      if (Includes(strides, {0, 0, 1})) d.yaw = 1.5 * Random();
      stances.push_back(stances.back() * d);
    }
    return Strides(stances);
  }

  const models::Gait& gait_ = DrcHubo1().GaitNamed(GetParam());
  const models::GaitParameters& parameters_ = gait_.parameters;
  const NominalStance stance_ = SolveNominalStance(DrcHubo1(), gait_);
  const Groups groups_ = SwingGroups(stance_);
  const StepBounds bounds_ = LongSteps(parameters_);
  std::mt19937 generator_{5};
};

TEST(SwingGroupsTest, FeetOfAWalkSwingAlone) {
  const NominalStance stance = SolveNominalStance(DrcHubo1(), DrcHubo1().GaitNamed("walk"));
  EXPECT_EQ(ContactsOf(DrcHubo1(), stance),
            (std::set<std::set<std::string>>{{"left_sole"}, {"right_sole"}}));
}

TEST(SwingGroupsTest, SoleSwingsWithTheOppositePegInACrawl) {
  const NominalStance stance = SolveNominalStance(DrcHubo1(), DrcHubo1().GaitNamed("crawl"));
  EXPECT_EQ(
      ContactsOf(DrcHubo1(), stance),
      (std::set<std::set<std::string>>{{"left_sole", "right_peg"}, {"right_sole", "left_peg"}}));
}

/// Two point feet bear on a line, on which nothing balances.
TEST(SwingGroupsTest, PointFeetSwingOneByOne) {
  const NominalStance stance = SolveNominalStance(Quadruped(), Quadruped().GaitNamed("walk"));
  EXPECT_EQ(SwingGroups(stance), (std::vector<std::vector<int>>{{0}, {1}, {2}, {3}}));
}

TEST_P(FootholdPlanTest, RandomWaysEndWithAllLimbsInTheLastStanceWithinBoundsAndApart) {
  for (int trial = 0; trial < 150; ++trial) {
    const std::vector<PlanarPose> way = RandomWay();
    const std::vector<Step> steps = PlanSteps(stance_, groups_, way, bounds_);
    ASSERT_FALSE(steps.empty()) << trial;
    Footholds feet(stance_, groups_, way.front());
    for (const Step& step : steps) {
      feet.Take(step);
      for (const PlanarPose& other : feet.at()) {
        EXPECT_LE(Effort(bounds_, other.Inverse() * step.stance), 1 + 1e-6) << trial;
      }
      EXPECT_GT(feet.Separation(), 0) << trial;
    }
    for (const PlanarPose& at : feet.at()) {
      EXPECT_LT((at.position() - way.back().position()).norm(), 1e-9) << trial;
      EXPECT_NEAR(WrapAngle(at.yaw - way.back().yaw), 0, 1e-9) << trial;
    }
  }
}

TEST_P(FootholdPlanTest, GroupsAlternateInAsFewStepsAsTheBoundsAllowOnAStraightWay) {
  for (const double length : {-2.0, -0.5, 0.1, 0.7, 1.3, 3.0, 5.0}) {
    const std::vector<Step> steps =
        PlanSteps(stance_, groups_, Strides({{}, {length, 0, 0}}), bounds_);
    // The first group leads by one step; the last step closes up.
    EXPECT_EQ(static_cast<double>(steps.size()),
              std::ceil(std::abs(length) / bounds_.forward - 1e-9) + 1)
        << length;
    int group = -1;
    for (const Step& step : steps) {
      EXPECT_NE(step.group, group) << length;
      group = step.group;
    }
  }
}

TEST_P(FootholdPlanTest, LongerStepsAreNoMore) {
  for (int trial = 0; trial < 10; ++trial) {
    const std::vector<PlanarPose> way = RandomWay();
    StepBounds shorter = bounds_;
    shorter.forward *= 0.7;
    shorter.lateral *= 0.7;
    shorter.turn *= 0.7;
    EXPECT_LE(PlanSteps(stance_, groups_, way, bounds_).size(),
              PlanSteps(stance_, groups_, way, shorter).size());
  }
}

using FootholdPlanOfTwoFeet = FootholdPlanTest;

TEST_P(FootholdPlanOfTwoFeet, OpensAndClosesUpInTurnOnAWayAside) {
  const double nominal = Footholds(stance_, groups_, {}).Separation();
  for (const double length : {1.0, -1.0}) {
    Footholds feet(stance_, groups_, {});
    bool opens = true;
    for (const Step& step : PlanSteps(stance_, groups_, Strides({{}, {0, length, 0}}), bounds_)) {
      feet.Take(step);
      if (opens) {
        EXPECT_GT(feet.Separation(), nominal);
      } else {
        EXPECT_LE(feet.Separation(), nominal + 1e-9);
      }
      opens = !opens;
    }
    EXPECT_TRUE(opens);
  }
}

TEST_P(FootholdPlanTest, WayOfOneStanceNeedsNoSteps) {
  EXPECT_TRUE(PlanSteps(stance_, groups_, {{1, 2, 3}}, bounds_).empty());
}

TEST_P(FootholdPlanTest, ScheduleAlternatesSwingsAndSupportOfAllLimbs) {
  const StepTiming timing = {0.4, bounds_.forward, 0.07, 0.3};
  const std::vector<PlanarPose> way =
      Strides({{1, 2, 0.5}, PlanarPose{1, 2, 0.5} * PlanarPose{1, 0, 0}});
  const std::vector<Step> steps = PlanSteps(stance_, groups_, way, bounds_);
  const models::ContactSchedule schedule =
      ScheduleOf(DrcHubo1(), stance_, groups_, way.front(), steps, timing);
  models::CheckContactSchedule(schedule);
  ASSERT_EQ(schedule.intervals.size(), 2 * steps.size() + 1);
  for (std::size_t k = 0; k < schedule.intervals.size(); ++k) {
    const models::ContactInterval& interval = schedule.intervals[k];
    const bool swings = k % 2 == 1;
    const std::vector<int> group = swings ? groups_[steps[k / 2].group] : std::vector<int>();
    for (int limb = 0; limb < static_cast<int>(interval.bearing.size()); ++limb) {
      const bool swings_now = std::find(group.begin(), group.end(), limb) != group.end();
      EXPECT_NE(interval.bearing[limb].has_value(), swings_now);
    }
    if (swings) continue;
    const bool rests = k == 0 || k + 1 == schedule.intervals.size();
    EXPECT_DOUBLE_EQ(interval.duration, rests ? timing.start : timing.double_support);
  }
  for (std::size_t limb = 0; limb < stance_.patch_centres.size(); ++limb) {
    const Eigen::Vector3d centre = way.back().At(0) * stance_.patch_centres[limb];
    EXPECT_LT((schedule.intervals.back().bearing[limb]->translation() - centre).norm(), 1e-9);
  }
}

TEST_P(FootholdPlanTest, ShorterSwingsTakeLessTimeButNotLessThanTheirShare) {
  const StepTiming timing = {0.4, 0.2, 0.07, 0.3};
  double before = 0;
  for (const double length : {0.001, 0.05, 0.12, 0.14, 0.16, 0.18, 0.2, 0.3}) {
    const models::ContactSchedule schedule = ScheduleOf(
        DrcHubo1(), stance_, groups_, {}, {{0, {length, 0, 0}}, {1, {length, 0, 0}}}, timing);
    for (const int k : {1, 3}) {
      EXPECT_NEAR(schedule.intervals[k].duration,
                  0.4 * std::min(1.0, std::max(0.75, length / timing.swing_length)), 1e-12);
    }
    EXPECT_GE(schedule.intervals[1].duration, before);
    before = schedule.intervals[1].duration;
  }
}

INSTANTIATE_TEST_SUITE_P(Gaits, FootholdPlanTest, ::testing::Values("walk", "crawl"),
                         [](const auto& info) { return info.param; });
INSTANTIATE_TEST_SUITE_P(Gaits, FootholdPlanOfTwoFeet, ::testing::Values("walk"));

TEST(CombinedEffort, OfOneDirectionIsThatOfTheDirection) {
  EXPECT_DOUBLE_EQ(CombinedEffort(-0.7, 0, 0), 0.7);
  EXPECT_DOUBLE_EQ(CombinedEffort(0, 0.7, 0), 0.7);
  EXPECT_DOUBLE_EQ(CombinedEffort(0, 0, -0.7), 0.7);
}

TEST(CombinedEffort, IsANormBetweenTheRootOfSquaresAndTheSum) {
  std::mt19937 generator(5);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int trial = 0; trial < 1000; ++trial) {
    const Eigen::Vector3d a(unit(generator), unit(generator), unit(generator));
    const Eigen::Vector3d b(unit(generator), unit(generator), unit(generator));
    const auto effort = [](const Eigen::Vector3d& d) {
      return CombinedEffort(d.x(), d.y(), d.z());
    };
    EXPECT_GE(effort(a), a.norm() - 1e-12);
    EXPECT_LE(effort(a), a.lpNorm<1>() + 1e-12);
    EXPECT_NEAR(effort(-3 * a), 3 * effort(a), 1e-12);
    EXPECT_LE(effort(a + b), effort(a) + effort(b) + 1e-12);
  }
}

}  // namespace
}  // namespace possibility::actions
