// The independent check must accept every randomly edited plan that the verifier accepts.

#include "tests/actions/verify/random_edits.h"

#include <gtest/gtest.h>

#include <map>

#include "actions/verify/verification_report.h"
#include "actions/verify/verifier.h"
#include "tests/actions/drchubo1.h"
#include "tests/actions/hop_plan.h"
#include "tests/actions/standing_plan.h"
#include "tests/actions/verify/plan_oracle.h"

namespace possibility::actions {
namespace {

using testing::PlanOracle;
using testing::RandomEdits;
using testing::ValidSubject;
using testing::VerifierSubject;

const VerifierSubject& HopSubject() {
  static const VerifierSubject subject = testing::HopPlan(DrcHubo1().file.string());
  return subject;
}

/// Without simulations, which the independent check does not run.
VerificationReport VerifiedUnsimulated(const VerifierSubject& subject) {
  VerifierSettings settings;
  settings.simulates = false;
  return Verify(subject.plan, subject.robot, subject.scenario, settings);
}

TEST(PlanOracle, AcceptsTheUntouchedPlans) {
  for (const VerifierSubject& subject : {ValidSubject(), HopSubject()}) {
    EXPECT_EQ(PlanOracle(subject.robot, subject.scenario).FaultOf(subject.plan), "");
  }
}

/// The check is of use only if it finds faults, too.
TEST(PlanOracle, RefusesMostPlansThatTheVerifierRefuses) {
  int refused = 0;
  int agreed = 0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    VerifierSubject subject = seed % 2 == 0 ? ValidSubject() : HopSubject();
    RandomEdits(seed).Apply(&subject);
    const VerificationReport report = VerifiedUnsimulated(subject);
    if (report.accepted() || report.violations.front().kind == ViolationKind::kStructure) continue;
    ++refused;
    agreed += PlanOracle(subject.robot, subject.scenario).FaultOf(subject.plan).empty() ? 0 : 1;
  }
  RecordProperty("refused", refused);
  RecordProperty("agreed", agreed);
  // It does not check the declared torques and forces.
  EXPECT_GT(agreed, refused / 2);
}

void ExpectNoFalseAcceptance(unsigned first_seed, unsigned count) {
  int accepted = 0;
  std::map<ViolationKind, int> found;
  for (unsigned seed = first_seed; seed < first_seed + count; ++seed) {
    VerifierSubject subject = seed % 2 == 0 ? ValidSubject() : HopSubject();
    const std::string edits = RandomEdits(seed).Apply(&subject);
    const VerificationReport report = VerifiedUnsimulated(subject);
    for (const Violation& violation : report.violations) ++found[violation.kind];
    if (!report.accepted()) continue;
    ++accepted;
    EXPECT_EQ(PlanOracle(subject.robot, subject.scenario).FaultOf(subject.plan), "")
        << "seed " << seed << ": " << edits << "\n"
        << FormatText(report);
  }
  for (const auto& [kind, times] : found) ::testing::Test::RecordProperty(ToString(kind), times);
  ::testing::Test::RecordProperty("accepted", accepted);
  // Otherwise the test would have checked nothing.
  EXPECT_GT(accepted, static_cast<int>(count / 20));
  EXPECT_LT(accepted, static_cast<int>(count / 2));
}

TEST(RandomEdits, NoPlanIsAcceptedFalsely) { ExpectNoFalseAcceptance(0, 200); }
TEST(RandomEditsLong, NoPlanIsAcceptedFalsely) { ExpectNoFalseAcceptance(1000, 2000); }

}  // namespace
}  // namespace possibility::actions
