// Whole plans by several threads, many times: the tests to run under the thread sanitizer.

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "actions/planner/planner.h"
#include "actions/verify/verification_report.h"
#include "tests/actions/drchubo1.h"
#include "tests/actions/leap.h"

namespace possibility::actions {
namespace {

/// Plans by the paper's algorithm, which solves its jumps while it explores.
constexpr int kJumpsSolved = 10;
/// Plans with jumps of the library.
constexpr int kJumpsRead = 10;
/// Plans beside a manoeuvre whose motion is refuted once a route uses it.
constexpr int kDetours = 40;
/// Plans beside a manoeuvre whose jobs throw.
constexpr int kFaults = 40;

PlanRequest Request(int seed) {
  PlanRequest request;
  request.seed = static_cast<std::uint64_t>(seed);
  request.threads = 3;
  request.time_limit = 1000;  // sanitizers are slow
  request.library = DrcHubo1Library();
  return request;
}

/// The pit without a bridge. The only way across is a jump, which lands crawling.
models::Scenario SceneToJump() {
  models::Scenario scenario = PitScene(false);
  scenario.actions = {"walk", "crawl", "jump"};
  scenario.start = {"walk", -0.8, 0, 0, 0};
  scenario.goals = {{"crawl", 1.2, 0, 0, 0}};
  return scenario;
}

void ExpectPlan(const models::Scenario& scenario, const PlanRequest& request, bool jumps) {
  const PlanResult result = PlanTraversal(DrcHubo1(), scenario, request);
  ASSERT_EQ(result.status, PlanStatus::kFound) << request.seed << ": " << result.explanation;
  EXPECT_TRUE(result.verification.accepted())
      << request.seed << ": " << FormatText(result.verification);
  EXPECT_EQ(std::any_of(result.plan.segments.begin(), result.plan.segments.end(),
                        [](const Segment& segment) { return segment.action == "jump"; }),
            jumps);
}

void ExpectJumps(int plans, PlannerPreset preset) {
  const models::Scenario scenario = SceneToJump();
  for (int seed = 1; seed <= plans; ++seed) {
    PlanRequest request = Request(seed);
    request.preset = preset;
    ExpectPlan(scenario, request, true);
  }
}

void ExpectWalks(int plans, const Leap::RunJob& run_job) {
  models::Scenario scenario = PitScene(true);
  // Start and goal are near the bridge, because sanitizers are slow.
  scenario.start = {"walk", -0.7, 0.3, 0, 0};
  scenario.goals = {{"walk", 0.7, 0.3, 0, 0}};
  for (int seed = 1; seed <= plans; ++seed) {
    PlanRequest request = Request(seed);
    request.manoeuvres = {LeapFactory(run_job, [](const Leap& leap) { return leap.Slide(); })};
    ExpectPlan(scenario, request, false);
  }
}

TEST(ThreadedPlansLong, JumpsSolvedWhileExploringArePlanned) {
  ExpectJumps(kJumpsSolved, PlannerPreset::kPaper);
}
TEST(ThreadedPlansLong, JumpsOfTheLibraryArePlanned) {
  ExpectJumps(kJumpsRead, PlannerPreset::kDefault);
}
TEST(ThreadedPlansLong, ARefutedLeapLeavesAWalkingPlan) { ExpectWalks(kDetours, Sleeps(0.02)); }
TEST(ThreadedPlansLong, JobsThatThrowLeaveAWalkingPlan) {
  ExpectWalks(kFaults, [](graph::JobControl*) -> graph::JobVerdict {
    throw std::runtime_error("the job's fuse blew");
  });
}

}  // namespace
}  // namespace possibility::actions
