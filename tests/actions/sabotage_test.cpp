#include <gtest/gtest.h>

#include "actions/route_motion.h"
#include "actions/verification_report.h"
#include "tests/actions/drchubo1.h"
#include "tests/actions/plan_mutations.h"
#include "tests/actions/standing_plan.h"

namespace possibility::actions {
namespace {

using testing::PlanMutation;
using testing::PlanMutations;
using testing::ValidSubject;
using testing::VerifierSubject;

/// A stride of walking, the transition, a stride of crawling and the transition back, as the
/// planner generates them.
const VerifierSubject& WalkAndCrawl() {
  static const VerifierSubject subject = [] {
    const LocomotionModel& model = DrcHubo1Locomotion();
    VerifierSubject result{{}, DrcHubo1(), ValidSubject().scenario};
    const models::Stance& start = result.scenario.start;
    const auto leg = [&](int transition, bool backwards, int gait, const PlanarPose& from,
                         const PlanarPose& displacement) {
      RouteLeg route_leg;
      route_leg.transition = transition;
      route_leg.backwards = backwards;
      route_leg.gait = gait;
      route_leg.from = from;
      route_leg.to = from * displacement;
      route_leg.z = start.z;
      return route_leg;
    };
    const PlanarPose sit = model.transitions[0].motion->displacement();
    Route route = {leg(-1, false, 0, {start.x, start.y, start.yaw}, {0.2, 0, 0})};
    route.push_back(leg(0, false, 0, route.back().to, sit));
    route.push_back(leg(-1, false, 1, route.back().to, {0.15, 0, 0}));
    route.push_back(leg(0, true, 0, route.back().to, sit.Inverse()));
    result.plan = ValidSubject().plan;
    result.plan.segments = GenerateMotion(model, route, 1, {});
    result.scenario.goals = {start};
    result.scenario.goals[0].x = route.back().to.x;
    result.scenario.goals[0].y = route.back().to.y;
    return result;
  }();
  return subject;
}

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

TEST_P(Sabotage, OfAStandingPlanIsFound) { ExpectFound(ValidSubject(), GetParam()); }
TEST_P(Sabotage, OfAWalkingAndCrawlingPlanIsFound) { ExpectFound(WalkAndCrawl(), GetParam()); }

INSTANTIATE_TEST_SUITE_P(Mutations, Sabotage, ::testing::ValuesIn(PlanMutations()),
                         [](const auto& info) { return info.param.name; });

TEST(SabotageBaseline, TheUntouchedPlansAreAccepted) {
  for (const VerifierSubject& subject : {ValidSubject(), WalkAndCrawl()}) {
    const VerificationReport report = Verify(subject.plan, subject.robot, subject.scenario);
    EXPECT_TRUE(report.accepted()) << FormatText(report);
  }
}

}  // namespace
}  // namespace possibility::actions
