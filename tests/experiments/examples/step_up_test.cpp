#include "experiments/examples/step_up.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

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

/// `explorers` as in PlanRequest.
PlanResult PlanWithSteps(const models::Scenario& scenario, std::uint64_t seed = 1,
                         const std::vector<std::string>& explorers = {}) {
  PlanRequest request;
  request.library = DrcHubo1Library();
  request.seed = seed;
  request.explorers = explorers;
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
  // Planned steps would lead over the plinth as well.
  const PlanResult result = PlanWithSteps(scenario, 1, {"lattice", "random", "shortcuts"});
  ASSERT_EQ(result.status, PlanStatus::kFound) << result.explanation;
  EXPECT_TRUE(result.verification.accepted()) << FormatText(result.verification);
  EXPECT_EQ(NumberOfSteps(result.plan), 2);
}

TEST(StepUpTest, WithoutTheActionContactsArePlanned) {
  PlanRequest request;
  request.library = DrcHubo1Library();
  request.time_limit = 1000;
  request.actions = {"walk"};
  const PlanResult result = PlanTraversal(DrcHubo1(), Plinth(0.1), request);
  EXPECT_EQ(result.status, PlanStatus::kFound) << result.explanation;
  EXPECT_EQ(NumberOfSteps(result.plan), 0);
}

TEST(StepUpTest, APlinthTooHighIsRefused) {
  for (const double height : {0.25, 0.4}) {
    const PlanResult result = PlanWithSteps(Plinth(height));
    EXPECT_EQ(result.status, PlanStatus::kExhausted) << result.explanation;
    EXPECT_TRUE(result.plan.segments.empty());
  }
}

/// The example's step beside a plinth, without a planner.
struct StepUpScene {
  explicit StepUpScene(double height) : scenario(Plinth(height)), ground(scenario.environment) {
    context.model = &DrcHubo1Locomotion();
    context.world = {&scenario.environment, &ground};
    context.space =
        std::make_shared<PelvisPoseSpace>(scenario.environment.bounds, ground.levels(), 0.137);
    context.gaits = {
        std::make_shared<QuasiStaticAction>(*context.model, 0, context.world, context.space, 0.25)};
    step_up = StepUpFactory().make(context);
  }

  models::Scenario scenario;
  models::GroundMap ground;
  PlanningContext context;
  std::shared_ptr<Manoeuvre> step_up;
};

graph::Point StandingAt(double x, double y, double z) {
  return ToPoint(DrcHubo1Locomotion().gaits[0]->stance.RootPose({x, y, 0}, z));
}

TEST(StepUpTest, MotionOfTheExpectedDurationExistsForAllHeightsOffered) {
  for (const double rise : {0.01, 0.03, 0.06, 0.09, 0.12, 0.15}) {
    const StepUpScene scene(rise);
    const graph::Point low = StandingAt(-0.02, 0.2, 0);
    const graph::Point high = StandingAt(0.48, 0.2, rise);
    for (const graph::Edge& edge : {graph::Edge{low, high}, graph::Edge{high, low}}) {
      ASSERT_TRUE(scene.step_up->CN(edge)) << rise;
      const std::vector<Phase> motion = scene.step_up->Motion(edge, {});
      EXPECT_NEAR(scene.step_up->ExpectedDuration(edge), motion.back().knots.back().t, 1e-9);
    }
  }
}

TEST(StepUpTest, TheJobConfirmsRefutesWithAReasonOrIsCancelled) {
  StepUpScene scene(0.1);
  const graph::Edge edge = {StandingAt(-0.02, 0, 0), StandingAt(0.48, 0, 0.1)};
  graph::JobControl control;
  EXPECT_EQ(scene.step_up->SpawnConfirmationJob(edge)->Run(&control),
            graph::JobVerdict::kConfirmed);

  // The beam is above the stances, but in the way of a robot that stretches.
  models::Obstacle beam;
  beam.name = "beam";
  beam.shape = models::Shape::Box({0.06, 3, 0.04});
  beam.X_WO.translation() << 0.22, 0, 1.31;
  scene.scenario.environment.obstacles.push_back(beam);
  const auto under_a_beam = StepUpFactory().make(scene.context);
  const auto job = under_a_beam->SpawnConfirmationJob(edge);
  EXPECT_EQ(job->Run(&control), graph::JobVerdict::kRefuted);
  EXPECT_NE(job->reason().find("'beam'"), std::string::npos);

  control.Cancel();
  EXPECT_EQ(under_a_beam->SpawnConfirmationJob(edge)->Run(&control), graph::JobVerdict::kUndecided);
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
  for (const std::string file :
       {"experiments/examples/step_up.cpp", "experiments/examples/step_up_main.cpp",
        "actions/conditions/fixed_manoeuvre.cpp"}) {
    sources += TextOf(kSource + "/" + file);
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
