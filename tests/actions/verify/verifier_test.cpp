#include "actions/verify/verifier.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <random>

#include "actions/checks/forces_check.h"
#include "actions/plan/interpolation.h"
#include "actions/plan/plan_reader.h"
#include "actions/plan/plan_writer.h"
#include "actions/verify/verification_report.h"
#include "tests/actions/plan_mutations.h"
#include "tests/actions/standing_plan.h"

namespace possibility::actions {
namespace {

using testing::CoupleLastJoint;
using testing::Find;
using testing::KnotsOf;
using testing::ValidSubject;
using testing::VerifierSubject;

TEST(Verifier, AcceptsAStandingPlan) {
  const VerificationReport report = Verified(ValidSubject());
  EXPECT_TRUE(report.accepted()) << FormatText(report);
  EXPECT_LE(report.resolution, 0.005 + 1e-12);
  EXPECT_GE(report.samples, ValidSubject().plan.duration() / 0.005);
  RecordProperty("microseconds_per_sample",
                 static_cast<int>(1e6 * report.seconds / static_cast<double>(report.samples)));
}

TEST(Verifier, CoupledJointsMayMoveTogether) {
  VerifierSubject subject = ValidSubject();
  CoupleLastJoint(&subject);
  EXPECT_EQ(Find(Verified(subject), ViolationKind::kJointCoupling), nullptr);
}

TEST(Verifier, AMasterBearsTheTorqueOfItsMimic) {
  VerifierSubject subject = ValidSubject();
  const int master = subject.robot.JointIndex("LKP");
  const int mimic = subject.robot.JointIndex("RKP");
  subject.robot.joints[mimic].mimic = models::Mimic{master, 2, 0};
  subject.robot.joints[mimic].effort = 0;
  double most = 0;
  for (const Knot* knot : KnotsOf(&subject.plan)) {
    most = std::max(most, std::abs(knot->tau[master] + 2 * knot->tau[mimic]));
  }
  subject.robot.joints[master].effort = 1.01 * most;
  EXPECT_EQ(Find(Verified(subject), ViolationKind::kJointTorque), nullptr);
  subject.robot.joints[master].effort = 0.99 * most;
  const VerificationReport report = Verified(subject);
  const Violation* violation = Find(report, ViolationKind::kJointTorque);
  ASSERT_NE(violation, nullptr);
  EXPECT_EQ(violation->quantity, "LKP torque");
  EXPECT_NEAR(violation->value, most, 0.01 * most);
}

TEST(Verifier, AcceptsAPlanWrittenAndReadBack) {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() /
      ("possibility_verifier_test_" + std::to_string(::getpid()) + ".json");
  VerifierSubject subject = ValidSubject();
  WritePlan(subject.plan, file);
  subject.plan = ReadPlan(file);
  std::filesystem::remove(file);
  const VerificationReport report = Verified(subject);
  EXPECT_TRUE(report.accepted()) << FormatText(report);
}

TEST(Verifier, ReportDoesNotDependOnTheNumberOfThreads) {
  for (const bool broken : {false, true}) {
    VerifierSubject subject = ValidSubject();
    if (broken) {
      testing::MiddleKnot(&testing::FirstPhase(&subject)).q[7] += 0.02;
      testing::AddBar(&subject);
    }
    const VerificationReport one = Verified(subject);
    EXPECT_EQ(one.accepted(), !broken);
    for (const int threads : {2, 3}) {
      VerifierSettings settings;
      settings.threads = threads;
      const VerificationReport many = Verified(subject, settings);
      EXPECT_EQ(many.samples, one.samples);
      ASSERT_EQ(many.violations.size(), one.violations.size());
      for (std::size_t i = 0; i < one.violations.size(); ++i) {
        EXPECT_EQ(many.violations[i].kind, one.violations[i].kind);
        EXPECT_EQ(many.violations[i].time, one.violations[i].time);
        EXPECT_EQ(many.violations[i].quantity, one.violations[i].quantity);
        EXPECT_EQ(many.violations[i].value, one.violations[i].value);
      }
    }
  }
}

/// Against Simbody's own Jacobians: ID - sum J' f must be (0, tau).
TEST(RealiseForces, LeavesNothingOnTheUnactuatedRows) {
  const VerifierSubject& subject = ValidSubject();
  const models::RobotModel& robot = subject.robot;
  const Phase& phase = subject.plan.segments[0].phases[0];
  const std::vector<BearingPoint> points = BearingPoints(robot, phase);
  StateEvaluator evaluator(robot);
  std::mt19937 generator(21);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 20; ++trial) {
    Knot knot = phase.knots[trial % phase.knots.size()];
    for (double& x : knot.v) x += 0.3 * normal(generator);
    for (double& x : knot.a) x += 2 * normal(generator);
    const VerifierState state = evaluator.Evaluate(knot);
    const RealisedForces realised = RealiseForces(state, points, robot, evaluator.dynamics());
    Eigen::VectorXd rest = evaluator.dynamics().InverseDynamics(knot.a);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto J = evaluator.dynamics().PointJacobian(points[i].link, points[i].p_L);
      rest -= J.transpose() * realised.forces.col(i);
      EXPECT_LT((state.Velocity(points[i]) - J * knot.v).norm(), 1e-10);
    }
    EXPECT_LT(rest.head<6>().norm(), 1e-7);
    EXPECT_LT((rest.tail(robot.num_joints()) - realised.torques).norm(), 1e-7);
    EXPECT_GT(realised.declared_residual, 1);
  }
}

TEST(RealiseForces, KeepsConsistentForcesAndTorques) {
  const VerifierSubject& subject = ValidSubject();
  const Phase& phase = subject.plan.segments[0].phases[0];
  const std::vector<BearingPoint> points = BearingPoints(subject.robot, phase);
  StateEvaluator evaluator(subject.robot);
  for (const Knot& knot : phase.knots) {
    const VerifierState state = evaluator.Evaluate(knot);
    const RealisedForces realised =
        RealiseForces(state, points, subject.robot, evaluator.dynamics());
    EXPECT_LT((realised.forces - knot.forces).norm(), 1e-5);
    EXPECT_LT((realised.torques - knot.tau).norm(), 1e-5);
  }
}

/// The robot as a projectile at 16 m/s: 4 m from sample to sample at a resolution of 0.25 s.
VerifierSubject Projectile() {
  VerifierSubject subject = ValidSubject();
  Knot knot = subject.plan.segments[0].phases[0].knots[0];
  knot.q[6] += 5;
  knot.v.setZero();
  knot.v[3] = 16;
  knot.a.setZero();
  knot.forces.resize(3, 0);
  Phase flight;
  for (int i = 0; i < 3; ++i) {
    flight.knots.push_back(knot);
    knot.t += 0.25;
    knot.q[4] += 4;
  }
  subject.plan.segments = {{"walk", {flight}}};
  return subject;
}

TEST(Verifier, FindsAPenetrationBetweenSamples) {
  VerifierSubject subject = Projectile();
  VerifierSettings settings;
  settings.resolution = 0.25;
  EXPECT_EQ(Find(Verified(subject, settings), ViolationKind::kPenetration), nullptr);
  models::Obstacle sheet;
  sheet.name = "sheet";
  sheet.shape = models::Shape::Box({0.001, 0.5, 0.5});
  sheet.X_WO.translation() << 1, 0, 5 + subject.robot.gaits[0].posture.root_height;
  subject.scenario.environment.obstacles.push_back(sheet);
  const VerificationReport report = Verified(subject, settings);
  const Violation* violation = Find(report, ViolationKind::kPenetration);
  ASSERT_NE(violation, nullptr);
  EXPECT_NE(violation->quantity.find("sheet"), std::string::npos);
  EXPECT_GT(violation->time, 0);
  EXPECT_LT(violation->time, 0.25);
}

/// A foot that creeps by less than 1 mm in each segment has moved over the plan.
TEST(Verifier, FollowsContactsAcrossSegments) {
  for (const double distance : {0.0008, 0.0012}) {
    VerifierSubject subject = ValidSubject();
    const double speed = distance / subject.plan.duration();
    for (Knot* knot : KnotsOf(&subject.plan)) {
      knot->q[4] += speed * knot->t;
      knot->v[3] += speed;
    }
    const VerificationReport report = Verified(subject);
    const Violation* violation = Find(report, ViolationKind::kContactMotion);
    EXPECT_EQ(violation != nullptr, distance > 0.001) << FormatText(report);
    if (violation != nullptr) {
      EXPECT_NEAR(violation->value, distance, 1e-6);
      EXPECT_EQ(violation->segment, 1);
    }
  }
}

TEST(Verifier, NamesTheWorstOfEachKind) {
  VerifierSubject subject = ValidSubject();
  Phase& phase = testing::FirstPhase(&subject);
  phase.knots[2].tau[3] += 1;
  phase.knots[4].tau[5] -= 7;
  phase.knots[5].tau[1] += 2;
  const VerificationReport report = Verified(subject);
  ASSERT_EQ(report.violations.size(), 1u) << FormatText(report);
  const Violation& violation = report.violations.front();
  EXPECT_EQ(violation.kind, ViolationKind::kDynamics);
  EXPECT_EQ(violation.segment, 0);
  EXPECT_EQ(violation.time, phase.knots[4].t);
  EXPECT_NE(violation.quantity.find(subject.robot.joints[5].name), std::string::npos);
  EXPECT_NEAR(violation.value, 7, 1e-3);
  EXPECT_EQ(violation.unit, "N m");
}

TEST(Verifier, FindsAnArmInTheTorso) {
  VerifierSubject subject = ValidSubject();
  for (Knot& knot : testing::FirstPhase(&subject).knots) {
    knot.q[7 + subject.robot.JointIndex("LSY")] = -1.5;
    knot.q[7 + subject.robot.JointIndex("LSP")] = -0.5;
  }
  const VerificationReport report = Verified(subject);
  const Violation* violation = Find(report, ViolationKind::kSelfCollision);
  ASSERT_NE(violation, nullptr) << FormatText(report);
  EXPECT_NE(violation->quantity.find("Body_Torso"), std::string::npos) << violation->quantity;
}

/// For any numbers, the verifier reaches a verdict, and it is a rejection.
TEST(Verifier, RejectsWildNumbers) {
  std::mt19937 generator(22);
  for (int trial = 0; trial < 150; ++trial) {
    VerifierSubject subject = ValidSubject();
    const std::vector<Knot*> knots = KnotsOf(&subject.plan);
    Knot& knot = *knots[generator() % knots.size()];
    const double wild = std::pow(10, static_cast<double>(generator() % 12) - 1);
    Eigen::VectorXd* const fields[] = {&knot.q, &knot.v, &knot.a, &knot.tau};
    Eigen::VectorXd& field = *fields[trial % 4];
    const Eigen::Index at = static_cast<Eigen::Index>(generator() % field.size());
    field[at] += trial % 8 < 4 ? wild : -wild;
    EXPECT_FALSE(Verified(subject).accepted()) << trial % 4 << " " << at << " " << wild;
  }
}

TEST(Verifier, RefusesInvalidSettings) {
  VerifierSettings settings;
  settings.resolution = 0;
  EXPECT_THROW(Verified(ValidSubject(), settings), std::invalid_argument);
  settings = {};
  settings.threads = 0;
  EXPECT_THROW(Verified(ValidSubject(), settings), std::invalid_argument);
}

TEST(VerificationReport, ReadsAsTextAndAsJson) {
  VerificationReport report;
  report.samples = 1234;
  report.resolution = 0.005;
  report.seconds = 0.5;
  EXPECT_EQ(FormatText(report), "accepted: 1234 samples at most 5 ms apart, checked in 0.50 s\n");
  report.violations = {{ViolationKind::kJointTorque, 3, 12.3456, "LKP torque", 312.5, 300, "N m"},
                       {ViolationKind::kStructure, -1, 0, "no segments", 1, 0, ""}};
  EXPECT_EQ(FormatText(report),
            "rejected: 1234 samples at most 5 ms apart, checked in 0.50 s\n"
            "  joint torque: LKP torque, 312.5 N m (limit 300), segment 3 at 12.346 s\n"
            "  structure: no segments\n");
  const std::string text = FormatJson(report);
  EXPECT_EQ(text.find('\n'), std::string::npos);
  const nlohmann::json json = nlohmann::json::parse(text);
  EXPECT_EQ(json["accepted"], false);
  EXPECT_EQ(json["samples"], 1234);
  EXPECT_EQ(json["violations"].size(), 2u);
  EXPECT_EQ(json["violations"][0]["kind"], "joint_torque");
  EXPECT_EQ(json["violations"][0]["limit"], 300);
}

}  // namespace
}  // namespace possibility::actions
