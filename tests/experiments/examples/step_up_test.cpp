#include "experiments/examples/step_up.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "actions/conditions/exploration_pose.h"
#include "actions/planner/planner.h"
#include "actions/verify/verification_report.h"
#include "models/world/ground_map.h"
#include "tests/actions/drchubo1.h"

namespace possibility::actions {
namespace {

const std::string kSource = POSSIBILITY_SOURCE_DIR;

/// The tutorial's scene with a plinth of any height.
models::Scenario Plinth(double height) {
  models::Scenario scenario = models::LoadScenario(kSource + "/experiments/examples/plinth.yaml");
  for (models::Obstacle& obstacle : scenario.environment.obstacles) {
    if (obstacle.name != "plinth") continue;
    obstacle.shape.size.z() = height;
    obstacle.X_WO.translation().z() = height / 2;
  }
  scenario.goals.front().z = height;
  return scenario;
}

PlanResult PlanWithSteps(const models::Scenario& scenario, std::uint64_t seed = 1) {
  PlanRequest request;
  request.seed = seed;
  request.time_limit = 1000;  // sanitizers are slow, and no test is about speed
  request.actions = {"walk", "step_up"};
  request.manoeuvres = {StepUpFactory()};
  return PlanTraversal(DrcHubo1(), scenario, request);
}

int NumberOfSteps(const Plan& plan) {
  return static_cast<int>(std::count_if(plan.segments.begin(), plan.segments.end(),
                                        [](const Segment& s) { return s.action == "step_up"; }));
}

TEST(StepUpTest, StepsOntoThePlinth) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const PlanResult result = PlanWithSteps(Plinth(0.1), seed);
    ASSERT_EQ(result.status, PlanStatus::kFound) << result.explanation;
    EXPECT_TRUE(result.verification.accepted()) << FormatText(result.verification);
    EXPECT_EQ(NumberOfSteps(result.plan), 1);
  }
}

TEST(StepUpTest, StepsUpAndDownAgainBehindThePlinth) {
  models::Scenario scenario = Plinth(0.1);
  scenario.goals = {{"walk", 3.2, 0, 0, 0}};
  const PlanResult result = PlanWithSteps(scenario);
  ASSERT_EQ(result.status, PlanStatus::kFound) << result.explanation;
  EXPECT_TRUE(result.verification.accepted()) << FormatText(result.verification);
  EXPECT_EQ(NumberOfSteps(result.plan), 2);
}

TEST(StepUpTest, WithoutTheActionThePlinthIsExhausted) {
  PlanRequest request;
  request.time_limit = 1000;
  request.actions = {"walk"};
  const PlanResult result = PlanTraversal(DrcHubo1(), Plinth(0.1), request);
  EXPECT_EQ(result.status, PlanStatus::kExhausted) << result.explanation;
}

TEST(StepUpTest, APlinthTooHighIsRefused) {
  for (const double height : {StepUp::kHighest + 0.01, 0.4}) {
    const PlanResult result = PlanWithSteps(Plinth(height));
    EXPECT_EQ(result.status, PlanStatus::kExhausted) << result.explanation;
    EXPECT_TRUE(result.plan.segments.empty());
  }
}

/// Heights over the whole range that the action offers, in both directions, at several headings.
TEST(StepUpTest, MotionExistsForAllHeightsOffered) {
  const LocomotionModel& model = DrcHubo1Locomotion();
  const StepUpMotion motion(DrcHubo1(), *model.gaits[0]);
  for (const double rise : {StepUp::kLowest, 0.03, 0.06, 0.09, 0.12, StepUp::kHighest}) {
    for (const double yaw : {0.0, 1.0, -2.5}) {
      EXPECT_NO_THROW(motion.Generate({0.3, -0.2, yaw}, 0.4, rise, {})) << rise << " " << yaw;
    }
  }
}

class StepUpScene : public ::testing::Test {
 protected:
  StepUpScene() {
    context_.model = &DrcHubo1Locomotion();
    context_.world = {&scenario_.environment, &ground_};
    context_.space =
        std::make_shared<PelvisPoseSpace>(scenario_.environment.bounds, ground_.levels(), 0.137);
    context_.gaits = {std::make_shared<QuasiStaticAction>(*context_.model, 0, context_.world,
                                                          context_.space, 0.25)};
    step_up_ = std::make_unique<StepUp>(context_);
  }
  static graph::Point At(double x, double y, double yaw, double z) {
    return ToPoint(DrcHubo1Locomotion().gaits[0]->stance.RootPose({x, y, yaw}, z));
  }

  models::Scenario scenario_ = Plinth(0.1);
  models::GroundMap ground_{scenario_.environment};
  PlanningContext context_;
  std::unique_ptr<StepUp> step_up_;
};

TEST_F(StepUpScene, EachUnmetNecessaryConditionRefusesTheStep) {
  const graph::Point low = At(-0.02, 0, 0, 0);
  const graph::Point high = At(0.48, 0, 0, 0.1);
  EXPECT_TRUE(step_up_->CN(graph::Edge{low, high}));
  EXPECT_TRUE(step_up_->CN(graph::Edge{high, low})) << "down again";
  EXPECT_FALSE(step_up_->CN(graph::Edge{low, At(0.47, 0, 0, 0.1)})) << "too near";
  EXPECT_FALSE(step_up_->CN(graph::Edge{low, At(0.48, 0.01, 0, 0.1)})) << "to the side";
  EXPECT_FALSE(step_up_->CN(graph::Edge{low, At(0.48, 0, 0.01, 0.1)})) << "turning";
  EXPECT_FALSE(step_up_->CN(graph::Edge{low, At(0.48, 0, 0, 0)})) << "into the plinth";
  EXPECT_FALSE(step_up_->CN(graph::Edge{At(-0.1, 0, 0, 0), At(0.4, 0, 0, 0.1)}))
      << "heels over the edge";
  EXPECT_FALSE(step_up_->CN(graph::Edge{At(0.3, 0, 0, 0), At(0.8, 0, 0, 0.1)}))
      << "too close to stand there";
}

TEST_F(StepUpScene, TheExpectedDurationIsThatOfTheMotion) {
  for (const double y : {0.0, 0.3, -0.123}) {
    const graph::Point low = At(-0.02, y, 0, 0);
    const graph::Point high = At(0.48, y, 0, 0.1);
    for (const graph::Edge& edge : {graph::Edge{low, high}, graph::Edge{high, low}}) {
      const double duration = step_up_->Motion(edge, {}).back().knots.back().t;
      EXPECT_NEAR(step_up_->ExpectedDuration(edge), duration, 1e-9) << y;
    }
  }
  const StepUpMotion motion(DrcHubo1(), *DrcHubo1Locomotion().gaits[0]);
  for (const double rise : {StepUp::kLowest, 0.06, StepUp::kHighest}) {
    const PlanarPose from{0.3, -0.2, rise};
    const double duration = motion.Generate(from, 0.4, rise, {}).back().knots.back().t;
    EXPECT_NEAR(motion.ExpectedDuration(from), duration, 1e-9) << rise;
  }
}

TEST_F(StepUpScene, LaunchesAndLandingsAtAnEdgeAreFoundFromBothSides) {
  const graph::Point target = At(1.5, 0.3, 0, 0.1);
  const auto launch = step_up_->FindLaunchPoint(At(-1, 0.2, 2, 0), target);
  ASSERT_TRUE(launch.has_value());
  const graph::Point landing = step_up_->ExtendTowards(*launch, target);
  EXPECT_TRUE(step_up_->CN(graph::Edge{*launch, landing}));
  EXPECT_EQ(*step_up_->FindLaunchPoint(*launch, target), *launch) << "there already";

  const graph::Point floor = At(-1, 0.3, 0, 0);
  const auto descent = step_up_->FindLaunchPoint(At(1.5, 0.2, 1, 0.1), floor);
  ASSERT_TRUE(descent.has_value());
  EXPECT_TRUE(step_up_->CN(graph::Edge{*descent, step_up_->ExtendTowards(*descent, floor)}));

  const auto arrival = step_up_->FindLandingPoint(At(1.5, 0.2, 1, 0.1), floor);
  ASSERT_TRUE(arrival.has_value());
  EXPECT_TRUE(step_up_->CN(graph::Edge{step_up_->ReverseExtend(*arrival, floor), *arrival}));
}

TEST_F(StepUpScene, TheJobConfirmsRefutesWithAReasonOrIsCancelled) {
  const graph::Edge edge = {At(-0.02, 0, 0, 0), At(0.48, 0, 0, 0.1)};
  graph::JobControl control;
  EXPECT_EQ(step_up_->SpawnConfirmationJob(edge)->Run(&control), graph::JobVerdict::kConfirmed);

  // The beam is above the stances, but in the way of a robot that stretches.
  models::Obstacle beam;
  beam.name = "beam";
  beam.shape = models::Shape::Box({0.06, 3, 0.04});
  beam.X_WO.translation() << 0.22, 0, 1.31;
  scenario_.environment.obstacles.push_back(beam);
  const StepUp under_a_beam(context_);
  const auto job = under_a_beam.SpawnConfirmationJob(edge);
  EXPECT_EQ(job->Run(&control), graph::JobVerdict::kRefuted);
  EXPECT_NE(job->reason().find("'beam'"), std::string::npos);

  control.Cancel();
  const graph::Edge other = {At(-0.02, 0.1, 0, 0), At(0.48, 0.1, 0, 0.1)};
  EXPECT_EQ(step_up_->SpawnConfirmationJob(other)->Run(&control), graph::JobVerdict::kUndecided);
}

std::string TextOf(const std::string& file) {
  std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

/// The C++ code in the tutorial must be in the source, word for word.
TEST(StepUpTutorialTest, QuotesTheSourceWordForWord) {
  std::string sources;
  for (const std::string file : {"step_up.h", "step_up.cpp", "step_up_motion.h",
                                 "step_up_motion.cpp", "step_up_main.cpp", "plinth.yaml"}) {
    sources += TextOf(kSource + "/experiments/examples/" + file);
  }
  const std::string page = TextOf(kSource + "/docs/tutorial_new_action.md");
  int quotes = 0;
  for (size_t begin = page.find("```cpp\n"); begin != std::string::npos;
       begin = page.find("```cpp\n", begin)) {
    begin += std::string("```cpp\n").size();
    const size_t end = page.find("```", begin);
    ASSERT_NE(end, std::string::npos);
    const std::string quote = page.substr(begin, end - begin);
    EXPECT_NE(sources.find(quote), std::string::npos) << quote;
    ++quotes;
    begin = end + 3;
  }
  EXPECT_GE(quotes, 6);
}

}  // namespace
}  // namespace possibility::actions
