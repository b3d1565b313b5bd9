// Planned steps of gaits on four limbs: DRC-HUBO1's crawl, on two soles and two pegs, and the walks
// of two quadrupeds on point feet.

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "actions/footsteps/footstep_plan.h"
#include "actions/footsteps/step_reach.h"
#include "actions/planner/planner.h"
#include "actions/wholebody/limb_bend.h"
#include "actions/wholebody/support_polygon.h"
#include "tests/actions/drchubo1.h"
#include "tests/actions/footsteps/uneven_world.h"
#include "tests/actions/quadruped.h"
#include "tests/actions/shipped_robots.h"

namespace possibility::actions {
namespace {

const LocomotionModel& CrawlingHubo() {
  static const LocomotionModel model = BuildLocomotionModel(DrcHubo1(), {"crawl"});
  return model;
}

const LocomotionModel& OnFourLimbs(const std::string& name) {
  if (name == "drchubo1") return CrawlingHubo();
  return name == "quadruped" ? QuadrupedLocomotion() : RobotNamed(name).model();
}

class LimbStepsTest : public ::testing::TestWithParam<const char*> {
 protected:
  const LocomotionModel& model() const { return OnFourLimbs(GetParam()); }
  const NominalStance& stance() const { return model().gaits[0]->stance; }
  FootstepLimits limits() const { return FootstepLimits::Of(*model().robot, stance()); }
  bool IsPeg(int limb) const {
    return model().robot->contacts[stance().gait->limbs[limb].contact].name.ends_with("peg");
  }
  double margin() const { return stance().gait->parameters.com_margin; }

  /// Steps ahead over ground that the world has; empty if none are found.
  std::vector<Footstep> StepsIn(UnevenWorld* world, const GroundedStance& from,
                                const GroundedStance& to) const {
    FootstepSearch search(model(), 0, world->Built(), from, {to}, limits());
    FootstepSearch::Status status = FootstepSearch::Status::kSearching;
    while (status == FootstepSearch::Status::kSearching) status = search.Advance(200);
    EXPECT_FALSE(search.ProvesNone());
    return search.steps();
  }

  void ExpectBearing(const UnevenWorld& world, const Footstep& step) const {
    for (const Eigen::Vector2d& p : stance().bearing_points[step.limb]) {
      const auto level = world.ground->LevelAt(step.to.stance * p, step.to.z, 1e-9);
      ASSERT_TRUE(level);
      EXPECT_GE(world.ground->Clearance(*level, step.to.stance * p), limits().margin - 1e-6);
    }
  }

  /// Some point keeps the gait's margin from all edges of what bears.
  void ExpectSupport(const std::vector<Foothold>& feet, int swinging) const {
    std::vector<Eigen::Vector2d> points;
    for (std::size_t limb = 0; limb < feet.size(); ++limb) {
      if (static_cast<int>(limb) == swinging) continue;
      for (const Eigen::Vector2d& p : stance().bearing_points[limb]) {
        points.push_back(feet[limb].stance * p);
      }
    }
    const SupportPolygon support(points);
    const Eigen::Vector2d centre = RestOf(feet, swinging).stance * stance().centre_of_mass;
    EXPECT_GE(support.Margin(support.Nearest(centre, margin())), margin() - 1e-3);
  }

  void ExpectSequence(const UnevenWorld& world, const GroundedStance& from,
                      const GroundedStance& to, const std::vector<Footstep>& steps) const {
    std::vector<Foothold> feet(stance().gait->limbs.size(), Foothold{from.pose, from.z});
    for (const Footstep& step : steps) {
      EXPECT_EQ(step.from.stance.x, feet[step.limb].stance.x);
      EXPECT_EQ(step.from.z, feet[step.limb].z);
      ExpectBearing(world, step);
      ExpectSupport(feet, step.limb);
      feet[step.limb] = step.to;
    }
    for (const Foothold& foot : feet) {
      EXPECT_LT((foot.stance.position() - to.pose.position()).norm(), 1e-9);
      EXPECT_NEAR(foot.z, to.z, 1e-9);
    }
  }
};

/// In 20 worlds of slabs with gaps and small differences in height.
TEST_P(LimbStepsTest, EachStepBearsOnGroundAndLeavesTheOthersInBalance) {
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> unit(0, 1);
  const double size = limits().forward;
  int found = 0;
  for (int trial = 0; trial < 20; ++trial) {
    const double gap = 0.6 * size * unit(generator);
    const double rise = 0.2 * size * unit(generator);
    UnevenWorld world;
    world.Ground(-2.5, -0.1, 0).Ground(-0.1 + gap, 5, rise);
    const GroundedStance from = UnevenWorld::StanceAt(-1);
    const GroundedStance to = UnevenWorld::StanceAt(1, rise, 0.1 * unit(generator));
    const std::vector<Footstep> steps = StepsIn(&world, from, to);
    if (steps.empty()) continue;
    ++found;
    ExpectSequence(world, from, to, steps);
    if (HasFatalFailure()) return;
  }
  EXPECT_GE(found, 18);
}

TEST_P(LimbStepsTest, NothingLeadsAcrossAWideGap) {
  UnevenWorld world;
  world.Ground(-2.5, -0.5, 0).Ground(0.5, 5, 0);
  EXPECT_TRUE(StepsIn(&world, UnevenWorld::StanceAt(-1.2), UnevenWorld::StanceAt(1.4)).empty());
}

/// What a limb reaches while three others bear, at most.
TEST_P(LimbStepsTest, ALimbFarFromTheOthersIsOutOfReach) {
  const StepReach reach(*model().robot, stance());
  std::vector<Foothold> feet(stance().gait->limbs.size());
  for (int limb = 0; limb < static_cast<int>(feet.size()); ++limb) {
    ASSERT_TRUE(reach.HighestRoot(feet, limb));
    // The joints of DRC-HUBO1's arms are no chain: held ones are between them.
    const bool is_chain = BendOf(*model().robot, stance().gait->limbs[limb]).has_value();
    EXPECT_EQ(is_chain, !IsPeg(limb));
    if (!is_chain) continue;
    std::vector<Foothold> apart = feet;
    apart[limb].stance.x = 20 * limits().forward;  // five lengths of a limb
    EXPECT_FALSE(reach.HighestRoot(apart, limb));
  }
}

class PointFeetTest : public LimbStepsTest {};

/// Feet that all stand at one place hold nothing up.
TEST_P(PointFeetTest, FeetThatCannotBalanceTheRobotDoNotBear) {
  const StepReach reach(*model().robot, stance());
  std::vector<Foothold> feet(stance().gait->limbs.size());
  const Eigen::Vector2d place = stance().patch_centres[0].head<2>();
  for (std::size_t limb = 1; limb < feet.size(); ++limb) {
    const Eigen::Vector2d to = place - Eigen::Vector2d(stance().patch_centres[limb].head<2>());
    feet[limb].stance = {to.x(), to.y(), 0};
  }
  EXPECT_FALSE(reach.HighestRoot(feet, 0));
}

INSTANTIATE_TEST_SUITE_P(Robots, PointFeetTest, ::testing::Values("quadruped", "a1"));
INSTANTIATE_TEST_SUITE_P(Robots, LimbStepsTest, ::testing::Values("drchubo1", "quadruped", "a1"));

PlanResult PlanOnFourLimbs(const std::string& scene, PlanRequest request = {}) {
  const bool is_a1 = scene.starts_with("a1/");
  request.library = is_a1 ? RobotNamed("a1").Library() : DrcHubo1Library();
  return PlanTraversal(is_a1 ? RobotNamed("a1").robot() : DrcHubo1(), ShippedScenario(scene),
                       request);
}

class LimbScenes : public ::testing::TestWithParam<const char*> {};

TEST_P(LimbScenes, AreCrossedByPlannedSteps) {
  const PlanResult result = PlanOnFourLimbs(GetParam());
  ASSERT_EQ(result.status, PlanStatus::kFound) << result.explanation;
  EXPECT_TRUE(result.verification.accepted());
  ASSERT_TRUE(result.plan.search);
  EXPECT_EQ(result.plan.search->explorers.front(), "footsteps");
}

INSTANTIATE_TEST_SUITE_P(Shipped, LimbScenes,
                         ::testing::Values("a1/crack", "a1/steps", "crawl_crack"));

/// The steps over the sill take longer.
TEST(LimbScenesInTime, TimeThatEndsBeforeStepsAreFoundIsNoExhaustedSearch) {
  PlanRequest request;
  request.time_limit = 3;
  EXPECT_EQ(PlanOnFourLimbs("crawl_sill", request).status, PlanStatus::kTimeLimit);
}

TEST(LimbScenesLong, ACrawlLeadsOverASill) {
  const PlanResult result = PlanOnFourLimbs("crawl_sill");
  ASSERT_EQ(result.status, PlanStatus::kFound) << result.explanation;
  EXPECT_TRUE(result.verification.accepted());
}

}  // namespace
}  // namespace possibility::actions
