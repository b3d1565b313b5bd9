#include "actions/crossing/step_over.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <string>

#include "actions/crossing/step_over_motion.h"
#include "actions/planner/planner.h"
#include "actions/verify/verification_report.h"
#include "dynamics/tree/tree_kinematics.h"
#include "models/input/input_error.h"
#include "tests/actions/drchubo1.h"
#include "tests/actions/geared_drchubo1.h"
#include "tests/models/temporary_folder.h"

namespace possibility::actions {
namespace {

StepOverProblem Stepping(const StepOverSettings& settings = {}) {
  return {DrcHubo1(), *DrcHubo1Locomotion().gaits[0], settings};
}

const StepOverMotion& Shipped() {
  static const StepOverMotion motion(Stepping(), DrcHubo1Library(), {});
  return motion;
}

PlanResult PlanOver(const models::Scenario& scenario, std::uint64_t seed = 1,
                    const std::vector<std::string>& actions = {}) {
  PlanRequest request;
  request.seed = seed;
  request.time_limit = 1000;  // sanitizers are slow, and no test is about speed
  request.actions = actions;
  request.library = DrcHubo1Library();
  return PlanTraversal(DrcHubo1(), scenario, request);
}

/// The shipped corridor with a beam of another size.
models::Scenario Beamed(double thickness, double height) {
  models::Scenario scenario = ShippedScenario("beam");
  for (models::Obstacle& obstacle : scenario.environment.obstacles) {
    if (obstacle.name != "beam") continue;
    obstacle.shape.size.x() = thickness;
    obstacle.shape.size.z() = height;
    obstacle.X_WO.translation().z() = height / 2;
  }
  return scenario;
}

void ExpectStepsOver(const PlanResult& result, int steps) {
  ASSERT_EQ(result.status, PlanStatus::kFound) << result.explanation;
  EXPECT_TRUE(result.verification.accepted()) << FormatText(result.verification);
  EXPECT_EQ(std::count_if(result.plan.segments.begin(), result.plan.segments.end(),
                          [](const Segment& segment) { return segment.action == kStepOver; }),
            steps);
}

TEST(StepOver, TheShippedSolutionIsOfThisProblem) { EXPECT_TRUE(Shipped().was_known()); }

TEST(StepOver, LeadsFromStanceToStanceAtRest) {
  const Knot& first = Shipped().phases().front().knots.front();
  const Knot& last = Shipped().phases().back().knots.back();
  const StepOverProblem problem = Stepping();
  EXPECT_EQ(first.t, 0);
  EXPECT_LT((first.q - problem.from()).norm(), 1e-6);
  EXPECT_LT((last.q - problem.to()).norm(), 1e-6);
  EXPECT_LT(first.v.norm() + last.v.norm(), 1e-6);
}

TEST(StepOver, FeetStandBesideTheBeam) {
  const Beam beam = Stepping().beam();
  dynamics::TreeKinematics kinematics(DrcHubo1());
  for (const Phase& phase : Shipped().phases()) {
    kinematics.SetPosition(phase.knots.front().q);
    for (const std::string& contact : phase.contacts) {
      const models::ContactPatch& sole = DrcHubo1().contacts[DrcHubo1().ContactIndex(contact)];
      for (const Eigen::Vector3d& p : sole.points) {
        const double x = kinematics.Position(sole.link, p).x();
        EXPECT_TRUE(x < beam.begin - 0.03 || x > beam.end + 0.03) << contact << " at " << x;
      }
    }
  }
}

TEST(StepOver, ABeamIsSteppedOverFromEverySeed) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    ExpectStepsOver(PlanOver(ShippedScenario("beam"), seed), 1);
  }
}

TEST(StepOver, OneMotionLeadsOverAllThatIsLowerAndThinner) {
  ExpectStepsOver(PlanOver(Beamed(0.1, 0.05)), 1);
  ExpectStepsOver(PlanOver(Beamed(0.02, 0.2)), 1);
  ExpectStepsOver(PlanOver(Beamed(0.02, 0.05)), 1);
}

TEST(StepOver, TwoBeamsAreTwoSteps) {
  models::Scenario scenario = ShippedScenario("beam");
  models::Obstacle second = scenario.environment.obstacles.back();
  ASSERT_EQ(second.name, "beam");
  second.name = "second";
  second.X_WO.translation().x() += 1.5;
  scenario.environment.obstacles.push_back(second);
  scenario.goals.front().x = 3.4;
  ExpectStepsOver(PlanOver(scenario), 2);
}

void ExpectRefused(const models::Scenario& scenario) {
  const PlanResult result = PlanOver(scenario);
  EXPECT_EQ(result.status, PlanStatus::kExhausted) << result.explanation;
  EXPECT_TRUE(result.plan.segments.empty());
}

TEST(StepOver, ABeamTooHighIsRefused) { ExpectRefused(ShippedScenario("beam_infeasible")); }

/// Slightly beyond the motion's limits. Steps are planned as well, in vain.
TEST(StepOverLong, ABeamSlightlyTooHighOrTooThickIsRefused) {
  ExpectRefused(Beamed(0.1, 0.21));
  ExpectRefused(Beamed(0.11, 0.2));
}

TEST(StepOver, WithoutItTheBeamIsInTheWay) {
  EXPECT_EQ(PlanOver(ShippedScenario("beam"), 1, {"walk"}).status, PlanStatus::kExhausted);
}

/// A shelf above the beam leaves room to stand on both sides.
TEST(StepOver, WhatElseIsInTheWayIsHitByTheJob) {
  models::Scenario scenario = ShippedScenario("beam");
  models::Obstacle shelf;
  shelf.name = "shelf";
  shelf.shape = models::Shape::Box({0.1, 2, 0.1});
  shelf.X_WO.translation() << 0.65, 0, 1;
  scenario.environment.obstacles.push_back(shelf);
  PlanRequest request;
  request.time_limit = 5;
  request.library = DrcHubo1Library();
  const PlanResult result = PlanTraversal(DrcHubo1(), scenario, request);
  EXPECT_NE(result.status, PlanStatus::kFound);
  EXPECT_NE(result.explanation.find("'shelf'"), std::string::npos) << result.explanation;
}

TEST(StepOver, NeedsAGaitOnTwoFeet) {
  models::Scenario scenario = ShippedScenario("beam");
  scenario.start.action = scenario.goals.front().action = "crawl";
  try {
    PlanOver(scenario, 1, {"crawl", "step_over"});
    FAIL() << "nothing thrown";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("'step_over' needs a gait on two feet"),
              std::string::npos)
        << error.what();
  }
  EXPECT_THROW(StepOverProblem(DrcHubo1(), *DrcHubo1Locomotion().gaits[1]), InputError);
}

TEST(StepOver, TheIdentityDependsOnTheObstacle) {
  StepOverSettings lower;
  lower.height = 0.15;
  EXPECT_NE(Stepping(lower).Identity(), Stepping().Identity());
  EXPECT_EQ(Stepping().Identity(), Stepping().Identity());
}

TEST(StepOver, IsCancelledWhenTimeIsUp) {
  const CancellationToken cancelled([] { return false; });
  EXPECT_THROW(StepOverMotion(Stepping(), {}, cancelled), Cancelled);
  EXPECT_THROW(StepOverMotion(Stepping(), DrcHubo1Library(), cancelled), Cancelled);
}

/// The shipped robot's motion is close to that of one with rotors.
TEST(StepOverLong, ARobotWithRotorsBeginsWithTheMotionOfOneWithout) {
  const models::RobotModel geared = GearedDrcHubo1();
  const LocomotionModel model = BuildLocomotionModel(geared, {"walk"}, {}, DrcHubo1Library());
  const StepOverProblem problem(geared, *model.gaits[0]);
  const StepOverMotion from_shipped(problem, DrcHubo1Library(), {});
  EXPECT_FALSE(from_shipped.was_known());
  const models::TemporaryFolder empty;
  const StepOverMotion from_nothing(problem, empty.path(), {});
  EXPECT_LT(from_shipped.iterations(), from_nothing.iterations() / 2);
}

/// Solved from nothing, and read again.
TEST(StepOverLong, ASolutionIsKeptInTheLibrary) {
  const models::TemporaryFolder folder;
  StepOverSettings low;
  low.height = 0.1;
  low.thickness = 0.05;
  const StepOverProblem problem = Stepping(low);
  const StepOverMotion first(problem, folder.path(), {});
  EXPECT_FALSE(first.was_known());
  // From the shipped step over a higher beam, to the same optimum.
  const StepOverMotion from_shipped(problem, DrcHubo1Library(), {});
  EXPECT_FALSE(from_shipped.was_known());
  EXPECT_LT(from_shipped.iterations(), first.iterations());
  EXPECT_NEAR(from_shipped.phases().back().knots.back().t, first.phases().back().knots.back().t,
              1e-3);
  first.Save();
  const StepOverMotion second(problem, folder.path(), {});
  EXPECT_TRUE(second.was_known());
  ASSERT_EQ(second.phases().size(), first.phases().size());
  for (std::size_t i = 0; i < first.phases().size(); ++i) {
    ASSERT_EQ(second.phases()[i].knots.size(), first.phases()[i].knots.size());
    for (std::size_t k = 0; k < first.phases()[i].knots.size(); ++k) {
      EXPECT_EQ(second.phases()[i].knots[k].q, first.phases()[i].knots[k].q);
      EXPECT_EQ(second.phases()[i].knots[k].tau, first.phases()[i].knots[k].tau);
    }
  }
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path())) {
    if (entry.is_regular_file()) std::ofstream(entry.path()) << "{\"format\": 1";
  }
  EXPECT_FALSE(StepOverMotion(problem, folder.path(), {}).was_known()) << "damaged";
}

}  // namespace
}  // namespace possibility::actions
