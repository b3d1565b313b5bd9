// Whatever the verifier accepts of randomly edited plans, a second opinion has to accept as well.

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

/// Without simulations, which the second opinion has none of.
VerificationReport Verified(const VerifierSubject& subject) {
  VerifierSettings settings;
  settings.simulates = false;
  return Verify(subject.plan, subject.robot, subject.scenario, settings);
}

TEST(PlanOracle, AcceptsTheUntouchedPlans) {
  for (const VerifierSubject& subject : {ValidSubject(), HopSubject()}) {
    EXPECT_EQ(PlanOracle(subject.robot, subject.scenario).FaultOf(subject.plan), "");
  }
}

/// It is a judge only if it finds what is wrong, too.
TEST(PlanOracle, RefusesWhatTheVerifierRefuses) {
  int refused = 0;
  int agreed = 0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    VerifierSubject subject = seed % 2 == 0 ? ValidSubject() : HopSubject();
    RandomEdits(seed).Apply(&subject);
    const VerificationReport report = Verified(subject);
    if (report.accepted() || report.violations.front().kind == ViolationKind::kStructure) continue;
    ++refused;
    agreed += PlanOracle(subject.robot, subject.scenario).FaultOf(subject.plan).empty() ? 0 : 1;
  }
  RecordProperty("refused", refused);
  RecordProperty("agreed", agreed);
  // Torques and forces that are declared falsely are none of its business.
  EXPECT_GT(agreed, refused / 2);
}

void ExpectNoFalseAcceptance(unsigned first_seed, unsigned count) {
  int accepted = 0;
  std::map<ViolationKind, int> found;
  for (unsigned seed = first_seed; seed < first_seed + count; ++seed) {
    VerifierSubject subject = seed % 2 == 0 ? ValidSubject() : HopSubject();
    const std::string edits = RandomEdits(seed).Apply(&subject);
    const VerificationReport report = Verified(subject);
    for (const Violation& violation : report.violations) ++found[violation.kind];
    if (!report.accepted()) continue;
    ++accepted;
    EXPECT_EQ(PlanOracle(subject.robot, subject.scenario).FaultOf(subject.plan), "")
        << "seed " << seed << ": " << edits << "\n"
        << FormatText(report);
  }
  for (const auto& [kind, times] : found) ::testing::Test::RecordProperty(ToString(kind), times);
  ::testing::Test::RecordProperty("accepted", accepted);
  // Or nothing would have been asked.
  EXPECT_GT(accepted, static_cast<int>(count / 20));
  EXPECT_LT(accepted, static_cast<int>(count / 2));
}

TEST(RandomEdits, NoneIsAcceptedFalsely) { ExpectNoFalseAcceptance(0, 200); }
TEST(RandomEditsLong, NoneIsAcceptedFalsely) { ExpectNoFalseAcceptance(1000, 2000); }

}  // namespace
}  // namespace possibility::actions
