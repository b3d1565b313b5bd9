// False plans whose faults the knots do not show: between two knots, in what adds up from phase to
// phase, or in how the plan is cut.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "actions/checks/forces_check.h"
#include "actions/plan/interpolation.h"
#include "actions/verify/verification_report.h"
#include "actions/verify/verifier.h"
#include "tests/actions/drchubo1.h"
#include "tests/actions/hop_plan.h"
#include "tests/actions/plan_mutations.h"
#include "tests/actions/standing_plan.h"

namespace possibility::actions {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using testing::KnotsOf;
using testing::PelvisShift;
using testing::PhasesOf;
using testing::ValidSubject;
using testing::VerifierSubject;

void ExpectRefused(const VerifierSubject& subject, ViolationKind expected) {
  const VerificationReport report = Verified(subject);
  const bool found = std::any_of(report.violations.begin(), report.violations.end(),
                                 [&](const Violation& v) { return v.kind == expected; });
  EXPECT_TRUE(found) << "expected " << ToString(expected) << "\n" << FormatText(report);
}

const NominalStance& WalkingStance() {
  static const NominalStance stance = SolveNominalStance(DrcHubo1(), DrcHubo1().GaitNamed("walk"));
  return stance;
}

MotionSettings KnotsApart(double spacing) {
  MotionSettings settings;
  settings.knot_spacing = spacing;
  settings.minimum_intervals = 1;
  return settings;
}

VerifierSubject PlanOf(const std::vector<MotionPhase>& phases, const MotionSettings& settings) {
  VerifierSubject subject = testing::PlanWithoutMotion(DrcHubo1().file.string());
  MotionBuilder builder(subject.robot, settings);
  subject.plan.segments = {{"walk", builder.Build(phases, WalkingStance().q)}};
  return subject;
}

/// There and back. The plan has only the first and the last knot of both phases.
TEST(HiddenMotion, AMotionWithOnlyItsEndKnotsIsRefused) {
  for (const double duration : {5e-3, 1e-3, 1e-5}) {
    const Vector3d shift(0.02, 0.03, -0.02);
    const VerifierSubject subject = PlanOf({PelvisShift(WalkingStance(), shift, false, duration),
                                            PelvisShift(WalkingStance(), shift, true, duration)},
                                           KnotsApart(1));
    ASSERT_EQ(KnotsOf(&const_cast<VerifierSubject&>(subject).plan).size(), 4u);
    ExpectRefused(subject, ViolationKind::kJointSpeed);
  }
}

/// The pelvis moves between two knots at rest 4 ms apart, by too little for the limits of speed. No
/// motor can do that.
TEST(HiddenMotion, AStartTooSuddenForTheMotorsIsRefused) {
  const Vector3d shift(0.004, 0, 0);
  const VerifierSubject subject = PlanOf({PelvisShift(WalkingStance(), shift, false, 4e-3),
                                          PelvisShift(WalkingStance(), shift, true, 4e-3)},
                                         KnotsApart(1));
  ExpectRefused(subject, ViolationKind::kJointTorque);
}

/// From rest to 0.5 m/s within 4 ms, and to rest again. At every knot the acceleration is zero.
TEST(HiddenMotion, SpeedWithoutAccelerationAtTheKnotsIsRefused) {
  constexpr double kTime = 4e-3;
  constexpr double kSpeed = 0.5;
  const auto faster = [](bool first) {
    MotionPhase phase = PelvisShift(WalkingStance(), Vector3d::Zero(), false, kTime);
    const auto still = phase.task;
    phase.task = [=](double t) {
      WholeBodyTask task = still(t);
      const bool moves = (t > kTime / 2) == first;
      task.root_position.value.x() = kSpeed * (first ? t / 2 : kTime / 2 + t / 2);
      task.root_position.rate.x() = moves ? kSpeed : 0;
      return task;
    };
    return phase;
  };
  VerifierSubject subject = PlanOf({faster(true), faster(false)}, KnotsApart(1));
  subject.scenario.goals[0].x = kSpeed * kTime;
  ExpectRefused(subject, ViolationKind::kJointTorque);
}

TEST(HiddenMotion, AnArmDisplacedAtOneKnotIsRefused) {
  for (const double spacing : {5e-3, 1e-3}) {
    const double duration = 40 * spacing;
    MotionPhase phase = PelvisShift(WalkingStance(), Vector3d::Zero(), false, duration);
    const auto still = phase.task;
    const int joint = DrcHubo1().JointIndex("LSP");
    phase.task = [=](double t) {
      WholeBodyTask task = still(t);
      if (std::abs(t - duration / 2) < spacing / 2) task.joints.value[joint] -= 1;
      return task;
    };
    ExpectRefused(PlanOf({phase}, KnotsApart(spacing)), ViolationKind::kJointSpeed);
  }
}

/// A joint is within its limits at every knot and at every sample, but not in between.
TEST(HiddenMotion, LimitsAreCheckedBetweenTheSamples) {
  for (const bool speed : {false, true}) {
    VerifierSubject subject = ValidSubject();
    const Phase& phase = testing::FirstPhase(&subject);
    const int joint = subject.robot.JointIndex("LKP");
    double largest = 0;
    double largest_at_knots = 0;
    for (std::size_t i = 0; i + 1 < phase.knots.size(); ++i) {
      const Knot& k0 = phase.knots[i];
      const Knot& k1 = phase.knots[i + 1];
      const auto value = [&](const Knot& knot) {
        return speed ? std::abs(knot.v[6 + joint]) : knot.q[7 + joint];
      };
      largest_at_knots = std::max({largest_at_knots, value(k0), value(k1)});
      for (int step = 0; step <= 10000; ++step) {
        const double t = k0.t + step * 1e-4 * (k1.t - k0.t);
        largest = std::max(largest, value(Interpolate(k0, k1, t)));
      }
    }
    double& limit =
        speed ? subject.robot.joints[joint].velocity : subject.robot.joints[joint].upper;
    limit = largest - 1e-6 + 1e-8;
    ASSERT_TRUE(Verified(subject).accepted()) << FormatText(Verified(subject));
    limit = largest - 1e-6 - 1e-8;
    ExpectRefused(subject, speed ? ViolationKind::kJointSpeed : ViolationKind::kJointPosition);
  }
}

/// Cuts every phase of a plan into phases of one interval each.
void CutAtEveryKnot(Plan* plan) {
  for (Segment& segment : plan->segments) {
    std::vector<Phase> pieces;
    for (const Phase& phase : segment.phases) {
      for (std::size_t i = 0; i + 1 < phase.knots.size(); ++i) {
        Phase piece = phase;
        piece.knots = {phase.knots[i], phase.knots[i + 1]};
        if (i > 0) piece.impulses.resize(3, 0);
        pieces.push_back(std::move(piece));
      }
    }
    segment.phases = std::move(pieces);
  }
}

TEST(HiddenMotion, ManyJumpsBelowTheToleranceAreRefused) {
  VerifierSubject subject = ValidSubject();
  CutAtEveryKnot(&subject.plan);
  ASSERT_TRUE(Verified(subject).accepted()) << FormatText(Verified(subject));
  const VerifierSubject whole = subject;
  double shift = 0;
  for (Phase* phase : PhasesOf(&subject.plan)) {
    for (Knot& knot : phase->knots) knot.q[4] += shift;
    shift += 9e-7;
  }
  ExpectRefused(subject, ViolationKind::kPositionContinuity);

  subject = whole;
  for (Phase* phase : PhasesOf(&subject.plan)) phase->knots.back().v[3] -= 9e-7;
  subject.plan.segments.back().phases.back().knots.back().v[3] += 9e-7;
  ExpectRefused(subject, ViolationKind::kVelocityContinuity);
}

/// Sets forces and torques of a knot to those that realise its motion.
void Realise(const models::RobotModel& robot, Phase* phase, StateEvaluator* evaluator) {
  const std::vector<BearingPoint> points = BearingPoints(robot, *phase);
  for (Knot& knot : phase->knots) {
    knot.forces = Matrix3Xd::Zero(3, points.size());
    const VerifierState state = evaluator->Evaluate(knot);
    const RealisedForces realised = RealiseForces(state, points, robot, evaluator->dynamics());
    knot.forces = realised.forces;
    knot.tau = realised.torques;
  }
}

/// Both soles creep below the speed that is allowed, bearing in turn on two corners and on the
/// other two, so that no corner is listed for long.
TEST(HiddenMotion, SolesThatGlideOnAlternatingCornersAreRefused) {
  constexpr double kSpeed = 1.9e-3;  // m/s
  constexpr double kPhase = 0.4;     // s, in which a corner creeps by 0.76 mm
  for (const bool moves : {false, true}) {
    VerifierSubject subject = testing::PlanWithoutMotion(DrcHubo1().file.string());
    MotionSettings settings = KnotsApart(0.1);
    MotionBuilder builder(subject.robot, settings);
    std::vector<MotionPhase> tasks(10,
                                   PelvisShift(WalkingStance(), Vector3d::Zero(), false, kPhase));
    std::vector<Phase> phases = builder.Build(tasks, WalkingStance().q);
    const double duration = phases.back().knots.back().t;
    StateEvaluator evaluator(subject.robot);
    for (std::size_t i = 0; i < phases.size(); ++i) {
      for (Knot& knot : phases[i].knots) {
        const ScalarSignal s = RestToRest(knot.t, duration);
        knot.q[4] += moves ? kSpeed * duration / 2 * s.value : 0;
        knot.v[3] += moves ? kSpeed * duration / 2 * s.rate : 0;
        knot.a[3] += moves ? kSpeed * duration / 2 * s.acceleration : 0;
      }
      if (i > 0 && i + 1 < phases.size()) {
        for (std::string& contact : phases[i].contacts) contact += i % 2 == 0 ? "[0,2]" : "[1,3]";
      }
      Realise(subject.robot, &phases[i], &evaluator);
    }
    subject.plan.segments = {{"walk", phases}};
    subject.scenario.goals[0].x = phases.back().knots.back().q[4];
    if (moves) {
      ExpectRefused(subject, ViolationKind::kContactMotion);
    } else {
      EXPECT_TRUE(Verified(subject).accepted()) << FormatText(Verified(subject));
    }
  }
}

/// The velocity jumps at every other knot. The impulses that explain it are of soles that stand on
/// the ground already.
TEST(HiddenMotion, AnImpactWithoutATouchdownIsRefused) {
  VerifierSubject subject = ValidSubject();
  CutAtEveryKnot(&subject.plan);
  std::vector<Phase*> phases = PhasesOf(&subject.plan);
  for (std::size_t i = 1; i < phases.size(); i += 2) {
    phases[i]->impulses = Matrix3Xd::Zero(3, phases[i]->knots.front().forces.cols());
  }
  ExpectRefused(subject, ViolationKind::kImpact);
}

/// A hop is one motion, however its phases are split into segments.
TEST(HiddenMotion, AHopCutIntoSegmentsIsSimulatedAsOne) {
  VerifierSubject subject = testing::HopPlan(DrcHubo1().file.string());
  const std::vector<Phase> phases = subject.plan.segments[0].phases;
  const double end = phases.back().knots.back().t;
  // Cuts also in the middle of the flight and of the phase after the landing.
  subject.plan.segments.clear();
  for (const Phase& phase : phases) {
    const std::size_t middle = phase.knots.size() / 2;
    Phase first = phase;
    first.knots.resize(middle + 1);
    Phase second = phase;
    second.knots.erase(second.knots.begin(), second.knots.begin() + static_cast<long>(middle));
    second.impulses.resize(3, 0);
    subject.plan.segments.push_back({"hop", {first}});
    subject.plan.segments.push_back({"hop", {second}});
  }
  const VerificationReport report = Verified(subject);
  EXPECT_TRUE(report.accepted()) << FormatText(report);
  ASSERT_EQ(report.rollouts.size(), 1u);
  EXPECT_EQ(report.rollouts[0].segment, 0);
  EXPECT_EQ(report.rollouts[0].last_segment, 5);
  EXPECT_EQ(report.rollouts[0].drift.start, 0);
  EXPECT_EQ(report.rollouts[0].drift.end, end);
}

}  // namespace
}  // namespace possibility::actions
