// The real long jump, slowed down. Planning does not wait for its jobs where walking is possible.

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "actions/jump/long_jump.h"
#include "actions/planner/planner.h"
#include "actions/verify/verification_report.h"
#include "tests/actions/drchubo1.h"
#include "tests/actions/leap.h"

namespace possibility::actions {
namespace {

using Clock = std::chrono::steady_clock;

/// A long jump whose jobs take `slowness` times as long as they would. A twin job runs first to
/// measure that time.
class SlowJump : public LongJump {
 public:
  SlowJump(const PlanningContext& context, const models::Jump& jump, double slowness,
           std::atomic<int>* jobs_that_ended)
      : LongJump(context, jump),
        twin_(context, jump),
        slowness_(slowness),
        jobs_that_ended_(jobs_that_ended) {}

  std::unique_ptr<graph::ConfirmationJob> SpawnConfirmationJob(
      const graph::Edge& edge) const override {
    auto job = LongJump::SpawnConfirmationJob(edge);
    auto rehearsal = twin_.SpawnConfirmationJob(edge);
    if (!job || !rehearsal) return nullptr;
    return std::make_unique<Job>(std::move(job), std::move(rehearsal), slowness_, jobs_that_ended_);
  }

 private:
  class Job : public graph::ConfirmationJob {
   public:
    Job(std::unique_ptr<graph::ConfirmationJob> job,
        std::unique_ptr<graph::ConfirmationJob> rehearsal, double slowness,
        std::atomic<int>* jobs_that_ended)
        : job_(std::move(job)),
          rehearsal_(std::move(rehearsal)),
          slowness_(slowness),
          jobs_that_ended_(jobs_that_ended) {}

    graph::JobVerdict Run(graph::JobControl* control) override {
      const Clock::time_point begin = Clock::now();
      rehearsal_->Run(control);
      const auto end = begin + (slowness_ - 1) * (Clock::now() - begin);
      while (Clock::now() < end) {
        if (!control->Checkpoint()) return graph::JobVerdict::kUndecided;
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
      }
      const graph::JobVerdict verdict = job_->Run(control);
      if (!control->cancelled()) ++*jobs_that_ended_;
      return verdict;
    }
    std::string reason() const override { return job_->reason(); }

   private:
    std::unique_ptr<graph::ConfirmationJob> job_;
    std::unique_ptr<graph::ConfirmationJob> rehearsal_;
    double slowness_;
    std::atomic<int>* jobs_that_ended_;
  };

  LongJump twin_;
  double slowness_;
  std::atomic<int>* jobs_that_ended_;
};

/// The shipped robot without its jump, which is a manoeuvre of the request instead.
models::RobotModel WithoutJumps() {
  models::RobotModel robot = DrcHubo1();
  robot.jumps.clear();
  return robot;
}

class SlowJumpScene : public ::testing::TestWithParam<int> {
 protected:
  /// Without a library every jump is solved cold.
  PlanResult Plan(bool with_bridge, double slowness, int threads) {
    models::Scenario scenario = PitScene(with_bridge);
    const models::Jump& jump = DrcHubo1().jumps.front();
    scenario.actions = {"walk", "crawl", jump.name};
    PlanRequest request;
    request.threads = threads;
    request.time_limit = 1000;  // sanitizers are slow, and no test is about speed
    request.manoeuvres = {{jump.name, [&](const PlanningContext& context) {
                             return std::make_shared<SlowJump>(context, jump, slowness,
                                                               &jobs_that_ended_);
                           }}};
    return PlanTraversal(robot_, scenario, request);
  }

  const models::RobotModel robot_ = WithoutJumps();
  std::atomic<int> jobs_that_ended_ = 0;
};

class SlowJumpTest : public SlowJumpScene {};
class SlowJumpLong : public SlowJumpScene {};

TEST_P(SlowJumpTest, WalkingDoesNotWaitForTheJump) {
  const PlanResult result = Plan(true, 10, GetParam());
  ASSERT_EQ(result.status, PlanStatus::kFound) << result.explanation;
  EXPECT_TRUE(result.verification.accepted()) << FormatText(result.verification);
  for (const Segment& segment : result.plan.segments) EXPECT_EQ(segment.action, "walk");
  EXPECT_GE(result.plan.statistics.at("jobs spawned"), 1);
  EXPECT_GE(result.plan.statistics.at("jobs cancelled"), 1);
  EXPECT_EQ(result.plan.statistics.at("jobs failed"), 0) << "waited until it was out of time";
  EXPECT_EQ(jobs_that_ended_, 0);
  RecordProperty("graph_seconds", std::to_string(result.plan.timings.graph_s));
}

/// The control: here planning has to wait for the jump.
TEST_P(SlowJumpLong, WithoutTheBridgeTheJumpIsThePlan) {
  const PlanResult result = Plan(false, 2, GetParam());
  ASSERT_EQ(result.status, PlanStatus::kFound) << result.explanation;
  EXPECT_GE(jobs_that_ended_, 1);
}

INSTANTIATE_TEST_SUITE_P(Threads, SlowJumpTest, ::testing::Values(2, 3));
INSTANTIATE_TEST_SUITE_P(Threads, SlowJumpLong, ::testing::Values(2));

}  // namespace
}  // namespace possibility::actions
