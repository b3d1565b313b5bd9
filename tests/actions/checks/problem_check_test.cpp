// Plans whose motion is sound, but which solve another problem than the scenario's.

#include "actions/checks/problem_check.h"

#include <gtest/gtest.h>

#include <random>

#include "actions/verify/verification_report.h"
#include "actions/verify/verifier.h"
#include "tests/actions/hop_plan.h"
#include "tests/actions/verify/walk_and_crawl.h"

namespace possibility::actions {
namespace {

using testing::ValidSubject;
using testing::VerifierSubject;
using testing::WalkAndCrawl;

constexpr const char* kDrcHubo1 = POSSIBILITY_SOURCE_DIR "/models/drchubo1/drchubo1.yaml";

const VerifierSubject& Hopping() {
  static const VerifierSubject subject = testing::HopPlan(kDrcHubo1);
  return subject;
}

/// The report's entry of one kind; empty if there is none.
std::string Found(const VerificationReport& report, ViolationKind kind) {
  for (const Violation& violation : report.violations) {
    if (violation.kind == kind) return violation.quantity;
  }
  return "";
}

/// Expects exactly one violation, of this kind and with these words.
void ExpectOnly(const VerifierSubject& subject, ViolationKind kind, const std::string& words) {
  const VerificationReport report = Verified(subject);
  ASSERT_EQ(report.violations.size(), 1u) << FormatText(report);
  EXPECT_EQ(report.violations.front().kind, kind) << FormatText(report);
  EXPECT_NE(report.violations.front().quantity.find(words), std::string::npos)
      << FormatText(report);
}

TEST(VerifierProblem, AcceptsWhatTheScenarioAllows) {
  for (const VerifierSubject& subject : {ValidSubject(), WalkAndCrawl(), Hopping()}) {
    const VerificationReport report = Verified(subject);
    EXPECT_TRUE(report.accepted()) << FormatText(report);
  }
}

TEST(VerifierProblem, AnActionThatTheScenarioDoesNotListIsRefused) {
  VerifierSubject subject = WalkAndCrawl();
  subject.scenario.actions = {"walk"};
  ExpectOnly(subject, ViolationKind::kAction, "'crawl' is not among the scenario's actions");
  subject = Hopping();
  subject.scenario.actions = {"walk"};
  ExpectOnly(subject, ViolationKind::kAction, "'hop' is not among the scenario's actions");
}

/// Possible in memory only: a file must list some.
TEST(VerifierProblem, AScenarioWithoutActionsAllowsAll) {
  VerifierSubject subject = WalkAndCrawl();
  subject.scenario.actions.clear();
  EXPECT_TRUE(Verified(subject).accepted());
  subject.plan.segments.front().action = "<b>";
  ExpectOnly(subject, ViolationKind::kAction, "is no action");
}

/// A scenario may allow an action that only some program knows, if its name is a valid action name.
TEST(VerifierProblem, AScenarioCannotAllowMarkup) {
  VerifierSubject subject = Hopping();
  subject.plan.segments.front().action = "<b>";
  subject.scenario.actions = {"walk", "<b>"};
  ExpectOnly(subject, ViolationKind::kAction, "\"<b>\" is no action");
}

TEST(VerifierProblem, AFlightInWalkingIsRefused) {
  VerifierSubject subject = Hopping();
  subject.plan.segments.front().action = "walk";
  ExpectOnly(subject, ViolationKind::kAction, "'walk' flies");
}

TEST(VerifierProblem, AnImpactInWalkingIsRefused) {
  VerifierSubject subject = Hopping();
  Segment& hop = subject.plan.segments.front();
  Segment landing{"walk", {hop.phases.back()}};
  hop.phases.pop_back();
  subject.plan.segments.push_back(landing);
  ExpectOnly(subject, ViolationKind::kAction, "'walk' hits the ground");
}

/// The name does not matter: hands are no part of walking.
TEST(VerifierProblem, CrawlingDeclaredAsWalkingIsRefused) {
  VerifierSubject subject = WalkAndCrawl();
  for (Segment& segment : subject.plan.segments) segment.action = "walk";
  subject.scenario.actions = {"walk"};
  ExpectOnly(subject, ViolationKind::kAction, "'walk' bears on left_peg");
}

TEST(VerifierProblem, AnActionInAnotherGaitThanTheOneBeforeIsRefused) {
  VerifierSubject subject = WalkAndCrawl();
  subject.plan.segments[1].action = "crawl";
  ExpectOnly(subject, ViolationKind::kAction,
             "'crawl' begins in the gait 'crawl', the segment before it ends in 'walk'");
}

TEST(VerifierProblem, ATransitionThatTheRobotLacksIsRefused) {
  VerifierSubject subject = WalkAndCrawl();
  subject.robot.transitions.clear();
  ExpectOnly(subject, ViolationKind::kAction, "the robot has no transition");
}

TEST(VerifierProblem, ARobotThatIsNotTheScenariosIsRefused) {
  VerifierSubject subject = ValidSubject();
  subject.scenario.robot_hash = subject.robot.content_hash;
  EXPECT_TRUE(Verified(subject).accepted());
  subject.scenario.robot_hash.back() ^= 1;
  ExpectOnly(subject, ViolationKind::kFileMismatch, "the scenario's is");
}

/// The root is where it should be, one foot 5 cm before its place and the other as far behind it.
TEST(VerifierProblem, FeetOffTheirPlacesInTheStanceAreRefused) {
  const VerificationReport report = Verified(testing::StandingPlan(kDrcHubo1, 0.05));
  ASSERT_EQ(report.violations.size(), 2u) << FormatText(report);
  for (const Violation& violation : report.violations) {
    EXPECT_NE(violation.quantity.find("off its place in the stance"), std::string::npos)
        << FormatText(report);
    EXPECT_NEAR(violation.value, 0.05, 1e-6);
  }
  EXPECT_NE(Found(report, ViolationKind::kStart), "");
  EXPECT_NE(Found(report, ViolationKind::kGoal), "");
}

TEST(VerifierProblem, SwayOfTheRootBeyondTheBoundsIsLimited) {
  VerifierSubject subject = ValidSubject();
  double farthest = -1;  // m, of the root in y
  for (const Knot* knot : testing::KnotsOf(&subject.plan)) {
    farthest = std::max(farthest, knot->q[5]);
  }
  subject.scenario.environment.bounds.max().y() = farthest - kSway + 1e-4;
  EXPECT_TRUE(Verified(subject).accepted());
  subject.scenario.environment.bounds.max().y() = farthest - kSway - 1e-4;
  ExpectOnly(subject, ViolationKind::kBounds, "root beyond the scenario's bounds");
}

Knot RandomKnot(double t, std::mt19937* generator) {
  std::normal_distribution<double> normal;
  Knot knot;
  knot.t = t;
  knot.q = Eigen::VectorXd::Zero(8);
  knot.q[0] = 1;
  knot.v = Eigen::VectorXd::Zero(7);
  knot.a = Eigen::VectorXd::Zero(7);
  for (int axis = 0; axis < 2; ++axis) {
    knot.q[4 + axis] = 0.6 * normal(*generator);
    knot.v[3 + axis] = 5 * normal(*generator);
    knot.a[3 + axis] = 20 * normal(*generator);
  }
  return knot;
}

/// Compared with the interpolant at steps of 1/2000 of the way, between knots as well as at them.
TEST(VerifierProblem, FindsTheFarthestPlaceBeyondTheBoundsBetweenKnots) {
  std::mt19937 generator(31);
  std::uniform_real_distribution<double> unit(0, 1);
  models::Scenario scenario;
  scenario.environment.bounds = {Eigen::Vector2d(-1, -1), Eigen::Vector2d(1, 1)};
  int beyond = 0;
  int hidden = 0;  // beyond the bounds between the knots alone
  for (int trial = 0; trial < 500; ++trial) {
    const double duration = std::pow(10, -2 * unit(generator));
    const Knot k0 = RandomKnot(0.5, &generator);
    const Knot k1 = RandomKnot(0.5 + duration, &generator);
    const auto outside = [&](const Knot& knot) {
      return scenario.environment.bounds.exteriorDistance(Eigen::Vector2d(knot.q.segment<2>(4)));
    };
    double expected = 0;
    for (int i = 0; i <= 2000; ++i) {
      expected = std::max(expected, outside(Interpolate(k0, k1, k0.t + duration * i / 2000)));
    }
    Plan plan;
    plan.segments = {{"walk", {{{}, {k0, k1}, Eigen::Matrix3Xd(3, 0)}}}};
    ViolationLog log;
    CheckBounds(plan, scenario, &log);
    if (std::abs(expected - kSway) < 1e-4) continue;
    ASSERT_EQ(log.Has(ViolationKind::kBounds), expected > kSway) << expected;
    if (expected <= kSway) continue;
    ++beyond;
    hidden += outside(k0) <= kSway && outside(k1) <= kSway;
    const Violation violation = log.Worst().front();
    EXPECT_NEAR(violation.value, expected, 1e-4);
    EXPECT_NEAR(outside(Interpolate(k0, k1, violation.time)), violation.value, 1e-9);
  }
  EXPECT_GT(beyond, 100);
  EXPECT_GT(hidden, 20);
}

TEST(VerifierProblem, EmptyBoundsBoundNothing) {
  std::mt19937 generator(32);
  Plan plan;
  plan.segments = {
      {"walk",
       {{{}, {RandomKnot(0, &generator), RandomKnot(1, &generator)}, Eigen::Matrix3Xd(3, 0)}}}};
  ViolationLog log;
  CheckBounds(plan, {}, &log);
  EXPECT_FALSE(log.Has(ViolationKind::kBounds));
}

}  // namespace
}  // namespace possibility::actions
