#include "experiments/samples/plan_samples.h"

#include <gtest/gtest.h>

#include <vector>

#include "models/input/input_error.h"
#include "tests/experiments/sample_plan.h"

namespace possibility::experiments {
namespace {

std::vector<PlanSample> SamplesEvery(const actions::Plan& plan, double step) {
  std::vector<PlanSample> samples;
  VisitEvery(plan, step, [&](const PlanSample& sample) { samples.push_back(sample); });
  return samples;
}

class PlanSamples : public ::testing::Test {
 protected:
  const models::RobotModel robot_ = testing::SampleRobot();
  const actions::Plan plan_ = testing::SamplePlan(robot_, 4, 9);
};

TEST_F(PlanSamples, APeriodGivesEvenTimesAndTheEnd) {
  const std::vector<PlanSample> samples = SamplesEvery(plan_, 0.3);
  ASSERT_EQ(samples.size(), 15u);
  for (std::size_t i = 0; i + 1 < samples.size(); ++i) {
    EXPECT_NEAR(samples[i].knot.t, 0.3 * i, 1e-12);
    EXPECT_EQ(samples[i].segment, 0.3 * i < 2 ? 0 : 1);
  }
  EXPECT_EQ(samples.back().knot.t, 4);
}

TEST_F(PlanSamples, APeriodThatLandsOnAKnotGivesThatKnot) {
  const std::vector<PlanSample> samples = SamplesEvery(plan_, 0.5);
  ASSERT_EQ(samples.size(), 9u);
  EXPECT_EQ(samples[4].segment, 1) << "where two phases meet, the later one counts";
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const auto& knots = plan_.segments[i < 4 ? 0 : 1].phases[0].knots;
    const actions::Knot& knot = knots[2 * (i < 4 ? i : i - 4)];
    EXPECT_LT((samples[i].knot.q - knot.q).norm(), 1e-9);
    EXPECT_LT((samples[i].knot.forces - knot.forces).norm(), 1e-9);
  }
}

TEST_F(PlanSamples, RefusesAPeriodOfTooManyRows) {
  EXPECT_THROW(SamplesEvery(plan_, 1e-9), InputError);
}

TEST_F(PlanSamples, TellKnotsFromWhatLiesBetween) {
  const std::vector<PlanSample> samples = SamplesEvery(plan_, 0.125);  // knots are 0.25 s apart
  for (std::size_t i = 0; i < samples.size(); ++i) EXPECT_EQ(samples[i].is_knot, i % 2 == 0) << i;
}

}  // namespace
}  // namespace possibility::experiments
