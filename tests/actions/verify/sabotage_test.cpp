#include <gtest/gtest.h>

#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "actions/verify/verification_report.h"
#include "models/input/input_error.h"
#include "tests/actions/packed_subject.h"
#include "tests/actions/plan_mutations.h"
#include "tests/actions/shipped_robots.h"
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

void ExpectViolation(const VerifierSubject& subject, const PlanMutation& mutation) {
  const VerificationReport report = Verify(subject.plan, subject.robot, subject.scenario);
  bool found = false;
  for (const Violation& violation : report.violations) {
    found = found || violation.kind == mutation.expected;
  }
  EXPECT_TRUE(found) << "expected " << ToString(mutation.expected) << "\n" << FormatText(report);
}

void ExpectFound(VerifierSubject subject, const PlanMutation& mutation) {
  mutation.apply(&subject);
  ExpectViolation(subject, mutation);
}

/// Of a plan of version 2, in a file. What no such file can hold may be refused instead.
void ExpectFoundInAFile(VerifierSubject subject, const PlanMutation& mutation) {
  mutation.apply(&subject);
  const bool may_be_refused = mutation.expected == ViolationKind::kStructure ||
                              mutation.expected == ViolationKind::kAction ||
                              mutation.name == "ScheduleOfNothing";
  try {
    subject.plan = testing::Repacked(subject.robot, subject.plan);
  } catch (const std::invalid_argument& error) {
    EXPECT_TRUE(may_be_refused) << error.what();
    return;
  } catch (const InputError& error) {
    EXPECT_TRUE(may_be_refused) << error.what();
    return;
  }
  ExpectViolation(subject, mutation);
}

TEST_P(Sabotage, AMutationOfAStandingPlanOfVersion2IsFound) {
  static const VerifierSubject subject = testing::Refined(ValidSubject());
  ExpectFoundInAFile(subject, GetParam());
}
TEST_P(Sabotage, AMutationOfAWalkingAndCrawlingPlanOfVersion2IsFound) {
  static const VerifierSubject subject = testing::Refined(WalkAndCrawl());
  ExpectFoundInAFile(subject, GetParam());
}

TEST_P(Sabotage, AMutationOfAStandingPlanIsFound) { ExpectFound(ValidSubject(), GetParam()); }
TEST_P(Sabotage, AMutationOfAWalkingAndCrawlingPlanIsFound) {
  ExpectFound(WalkAndCrawl(), GetParam());
}

/// Of another robot, on all its feet.
const VerifierSubject& StandingOf(const std::string& robot) {
  static std::map<std::string, VerifierSubject> subjects;
  const auto known = subjects.find(robot);
  if (known != subjects.end()) return known->second;
  return subjects[robot] = testing::StandingPlan(RobotNamed(robot).robot().file.string());
}

const VerifierSubject& RefinedStandingOf(const std::string& robot) {
  static std::map<std::string, VerifierSubject> subjects;
  const auto known = subjects.find(robot);
  if (known != subjects.end()) return known->second;
  return subjects[robot] = testing::Refined(StandingOf(robot));
}

/// Point feet have neither corners nor headings, and no other robot than DRC-HUBO1 crawls.
bool IsPossible(const std::string& mutation, const std::string& robot) {
  if (mutation == "StartByOtherGait") return false;
  const bool is_of_soles = mutation == "CornersPull" || mutation == "ScheduleOfOtherHeadings";
  return !is_of_soles || RobotNamed(robot).robot().contacts.front().points.size() == 4;
}

TEST_P(Sabotage, AMutationOfEveryRobotsStandingPlanIsFound) {
  for (const std::string& robot : ShippedRobotNames()) {
    SCOPED_TRACE(robot);
    if (!IsPossible(GetParam().name, robot)) continue;
    ExpectFound(StandingOf(robot), GetParam());
    ExpectFoundInAFile(RefinedStandingOf(robot), GetParam());
  }
}

INSTANTIATE_TEST_SUITE_P(Mutations, Sabotage, ::testing::ValuesIn(PlanMutations()),
                         [](const auto& info) { return info.param.name; });

TEST(SabotageBaseline, TheUntouchedPlansAreAccepted) {
  std::vector<VerifierSubject> subjects = {ValidSubject(), WalkAndCrawl()};
  for (const std::string& robot : ShippedRobotNames()) subjects.push_back(StandingOf(robot));
  for (VerifierSubject& subject : subjects) {
    subject.plan.schedule = ScheduleOfMotion(subject.robot, subject.plan.segments);
    const VerificationReport report = Verify(subject.plan, subject.robot, subject.scenario);
    EXPECT_TRUE(report.accepted()) << FormatText(report);
    subject.plan = testing::Repacked(subject.robot, testing::Refined(subject).plan);
    const VerificationReport of_version_2 = Verified(subject);
    EXPECT_TRUE(of_version_2.accepted()) << FormatText(of_version_2);
  }
}

}  // namespace
}  // namespace possibility::actions
