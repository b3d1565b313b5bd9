#include <gtest/gtest.h>

#include "actions/verify/verification_report.h"
#include "tests/actions/plan_mutations.h"
#include "tests/actions/standing_plan.h"
#include "tests/actions/verify/walk_and_crawl.h"

namespace possibility::actions {
namespace {

using testing::PlanMutation;
using testing::PlanMutations;
using testing::ValidSubject;
using testing::VerifierSubject;
using testing::WalkAndCrawl;

class Sabotage : public ::testing::TestWithParam<PlanMutation> {};

void ExpectFound(VerifierSubject subject, const PlanMutation& mutation) {
  mutation.apply(&subject);
  const VerificationReport report = Verify(subject.plan, subject.robot, subject.scenario);
  bool found = false;
  for (const Violation& violation : report.violations) {
    found = found || violation.kind == mutation.expected;
  }
  EXPECT_TRUE(found) << "expected " << ToString(mutation.expected) << "\n" << FormatText(report);
}

TEST_P(Sabotage, AMutationOfAStandingPlanIsFound) { ExpectFound(ValidSubject(), GetParam()); }
TEST_P(Sabotage, AMutationOfAWalkingAndCrawlingPlanIsFound) {
  ExpectFound(WalkAndCrawl(), GetParam());
}

INSTANTIATE_TEST_SUITE_P(Mutations, Sabotage, ::testing::ValuesIn(PlanMutations()),
                         [](const auto& info) { return info.param.name; });

TEST(SabotageBaseline, TheUntouchedPlansAreAccepted) {
  for (VerifierSubject subject : {ValidSubject(), WalkAndCrawl()}) {
    subject.plan.schedule = ScheduleOfMotion(subject.robot, subject.plan.segments);
    const VerificationReport report = Verify(subject.plan, subject.robot, subject.scenario);
    EXPECT_TRUE(report.accepted()) << FormatText(report);
  }
}

}  // namespace
}  // namespace possibility::actions
