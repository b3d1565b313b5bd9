// Rotors, friction and torque-speed lines between the planner's dynamics and the verifier's.

#include <gtest/gtest.h>

#include <cmath>

#include "actions/verify/verification_report.h"
#include "actions/verify/verifier.h"
#include "tests/actions/drchubo1.h"
#include "tests/actions/plan_mutations.h"
#include "tests/actions/standing_plan.h"

namespace possibility::actions {
namespace {

using testing::Find;
using testing::VerifierSubject;

models::RobotModel DrivenRobot() {
  models::RobotModel robot = DrcHubo1();
  for (models::Joint& joint : robot.joints) {
    joint.actuator = {0.3, 1, 2, 0.1, models::TorqueSpeedLine{150, 20}};
  }
  return robot;
}

/// The pelvis is shifted and comes back.
VerifierSubject DrivenSubject() {
  VerifierSubject subject = testing::ValidSubject();
  subject.robot = DrivenRobot();
  const NominalStance stance = SolveNominalStance(subject.robot, subject.robot.GaitNamed("walk"));
  const Eigen::Vector3d shift(0.02, 0.03, -0.02);
  subject.plan.segments.clear();
  for (const Phase& phase : MotionBuilder(subject.robot)
                                .Build({testing::PelvisShift(stance, shift, false, 0.8),
                                        testing::PelvisShift(stance, shift, true, 0.8)},
                                       stance.q)) {
    subject.plan.segments.push_back({"walk", {phase}});
  }
  return subject;
}

TEST(VerifiedActuators, AMotionPlannedWithThemIsAccepted) {
  const VerificationReport report = Verified(DrivenSubject());
  EXPECT_TRUE(report.accepted()) << FormatText(report);
}

TEST(VerifiedActuators, APlanForOtherActuatorsIsRefused) {
  for (const auto change : {+[](models::Actuator* a) { a->armature = 0; },
                            +[](models::Actuator* a) { a->viscous_friction = 0; },
                            +[](models::Actuator* a) { a->dry_friction = 0; }}) {
    VerifierSubject subject = DrivenSubject();
    change(&subject.robot.joints[subject.robot.JointIndex("LKP")].actuator);
    const VerificationReport report = Verified(subject);
    const Violation* violation = Find(report, ViolationKind::kDynamics);
    ASSERT_NE(violation, nullptr);
    EXPECT_EQ(violation->quantity, "LKP declared torque off inverse dynamics");
  }
}

TEST(VerifiedActuators, ADrivingTorqueBeyondTheLineIsRefused) {
  VerifierSubject subject = DrivenSubject();
  const int knee = subject.robot.JointIndex("LKP");
  double share = 0;  // of the torque at which the line begins, where the knee is driven fastest
  for (const Knot* knot : testing::KnotsOf(&subject.plan)) {
    const double along = knot->tau[knee] * (knot->v[6 + knee] < 0 ? -1 : 1);
    share = std::max(share, along / (1 - std::abs(knot->v[6 + knee]) / 2));
  }
  models::Joint& joint = subject.robot.joints[knee];
  joint.actuator.line = models::TorqueSpeedLine{1.01 * share, 2};
  EXPECT_EQ(Find(Verified(subject), ViolationKind::kJointTorque), nullptr);
  joint.actuator.line->stall_torque = 0.98 * share;
  const VerificationReport report = Verified(subject);
  const Violation* violation = Find(report, ViolationKind::kJointTorque);
  ASSERT_NE(violation, nullptr);
  EXPECT_EQ(violation->quantity, "LKP torque");
}

TEST(VerifiedActuators, AMotionBackwardsHasTheTorquesThatItNeeds) {
  VerifierSubject subject = DrivenSubject();
  std::vector<Phase> phases;
  for (const Segment& segment : subject.plan.segments) {
    phases.insert(phases.end(), segment.phases.begin(), segment.phases.end());
  }
  subject.plan.segments.clear();
  for (const Phase& phase : Reversed(subject.robot, phases)) {
    subject.plan.segments.push_back({"walk", {phase}});
  }
  const VerificationReport report = Verified(subject);
  EXPECT_TRUE(report.accepted()) << FormatText(report);
}

}  // namespace
}  // namespace possibility::actions
