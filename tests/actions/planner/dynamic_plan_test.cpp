#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "actions/plan/plan_reader.h"
#include "actions/plan/plan_writer.h"
#include "actions/rollout/rollout_check.h"
#include "actions/verify/verification_report.h"
#include "actions/verify/verifier.h"
#include "dynamics/simbody/simbody_dynamics.h"
#include "models/input/input_error.h"
#include "tests/actions/hop_plan.h"
#include "tests/actions/packed_subject.h"
#include "tests/actions/plan_mutations.h"

namespace possibility::actions {
namespace {

using Eigen::Matrix3d;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using testing::Find;
using testing::HopPlan;
using testing::PlanMutation;
using testing::VerifierSubject;

/// Shared by all tests, which work on copies of it.
const VerifierSubject& ValidSubject() {
  static const VerifierSubject subject =
      HopPlan(POSSIBILITY_SOURCE_DIR "/models/drchubo1/drchubo1.yaml");
  return subject;
}

Phase& Flight(VerifierSubject* subject) { return subject->plan.segments[0].phases[1]; }
Phase& Landing(VerifierSubject* subject) { return subject->plan.segments[0].phases[2]; }

/// Turns the robot about its centre of mass by an angle that comes and goes within the flight. The
/// parabola stays the same, the angular momentum does not.
void Wobble(VerifierSubject* subject) {
  constexpr double kAngle = 2e-3;
  Phase& phase = Flight(subject);
  dynamics::SimbodyDynamics dynamics(subject->robot);
  const double start = phase.knots.front().t;
  const double duration = phase.knots.back().t - start;
  for (Knot& knot : phase.knots) {
    dynamics.SetState(knot.q, knot.v);
    const Vector3d centre = dynamics.CentreOfMass();
    const Vector3d drift = dynamics.CentreOfMassVelocity();
    const ScalarSignal angle = Bump(knot.t - start, duration);
    const Matrix3d turn =
        Eigen::AngleAxisd(kAngle * angle.value, Vector3d::UnitY()).toRotationMatrix();
    const Vector3d rate = kAngle * angle.rate * Vector3d::UnitY();
    const Vector3d arm = turn * (knot.q.segment<3>(4) - centre);
    const Eigen::Quaterniond R =
        Eigen::Quaterniond(turn) * Eigen::Quaterniond(knot.q[0], knot.q[1], knot.q[2], knot.q[3]);
    knot.q.head<4>() << R.w(), R.vec();
    knot.q.segment<3>(4) = centre + arm;
    knot.v.head<3>() = rate + turn * knot.v.head<3>().eval();
    knot.v.segment<3>(3) = drift + turn * (knot.v.segment<3>(3).eval() - drift) + rate.cross(arm);
  }
}

/// Makes the flight longer, as if gravity were the moon's.
void FallSlowly(VerifierSubject* subject) {
  Phase& phase = Flight(subject);
  for (Knot& knot : phase.knots) {
    const ScalarSignal s =
        Bump(knot.t - phase.knots.front().t, phase.knots.back().t - phase.knots.front().t);
    knot.q[6] += 3e-4 * s.value;
    knot.v[5] += 3e-4 * s.rate;
    knot.a[5] += 3e-4 * s.acceleration;
  }
}

/// Adds impulses that two points exchange along the line between them. They change nothing else.
void Exchange(int i, int j, double magnitude, VerifierSubject* subject) {
  Phase& phase = Landing(subject);
  dynamics::SimbodyDynamics dynamics(subject->robot);
  dynamics.SetState(phase.knots.front().q, phase.knots.front().v);
  const models::ContactPatch& patch =
      subject->robot.contacts[subject->robot.ContactIndex(phase.contacts.front())];
  const Vector3d line = dynamics.PointPosition(patch.link, patch.points[j]) -
                        dynamics.PointPosition(patch.link, patch.points[i]);
  phase.impulses.col(i) += magnitude * line.normalized();
  phase.impulses.col(j) -= magnitude * line.normalized();
}

/// Two corners of a sole pull and two push as much more.
void MakeImpulsesPull(VerifierSubject* subject) {
  Matrix3Xd& impulses = Landing(subject).impulses;
  const double extra = impulses.row(2).leftCols<4>().maxCoeff() + 0.1;
  for (int i = 0; i < 4; ++i) impulses(2, i) += i % 2 == 0 ? extra : -extra;
}

/// The robot leaves the ground again, `factor` times as fast as if it had stuck.
void Bounce(double factor, VerifierSubject* subject) {
  Phase& phase = Landing(subject);
  const VectorXd before = Flight(subject).knots.back().v;
  VectorXd& after = phase.knots.front().v;
  after = (before + factor * (after - before)).eval();
  phase.impulses *= factor;
}

std::vector<PlanMutation> DynamicMutations() {
  using Subject = VerifierSubject;
  using Kind = ViolationKind;
  return {
      {"ImpulseScaled", [](Subject* s) { Landing(s).impulses *= 1.001; }, Kind::kImpact},
      {"ImpulseOfOnePointMissing", [](Subject* s) { Landing(s).impulses.col(1).setZero(); },
       Kind::kImpact},
      {"ImpulsesPull", MakeImpulsesPull, Kind::kImpact},
      {"ImpulsesLeaveTheirCones", [](Subject* s) { Exchange(0, 1, 2, s); }, Kind::kImpact},
      {"Bounce", [](Subject* s) { Bounce(1.5, s); }, Kind::kImpact},
      {"BounceHigherThanFallen", [](Subject* s) { Bounce(3, s); }, Kind::kImpact},
      {"VelocityAfterImpactOff", [](Subject* s) { Landing(s).knots.front().v[6] += 1e-2; },
       Kind::kImpact},
      {"ImpactUndeclared", [](Subject* s) { Landing(s).impulses.resize(3, 0); },
       Kind::kVelocityContinuity},
      {"PositionJumpsInImpact",
       [](Subject* s) {
         for (Knot& knot : Landing(s).knots) knot.q[7] += 1e-5;
       },
       Kind::kPositionContinuity},
      {"ImpulseMissing", [](Subject* s) { Landing(s).impulses.conservativeResize(3, 7); },
       Kind::kStructure},
      {"ImpulseNotFinite", [](Subject* s) { Landing(s).impulses(2, 0) = NAN; }, Kind::kStructure},
      {"ImpactBeforeTheStart",
       [](Subject* s) { s->plan.segments[0].phases[0].impulses = Matrix3Xd::Zero(3, 8); },
       Kind::kStructure},
      {"ForceInFlight",
       [](Subject* s) {
         for (Knot& knot : Flight(s).knots) knot.forces = Matrix3Xd::Zero(3, 1);
       },
       Kind::kStructure},
      {"OffTheParabola", FallSlowly, Kind::kFlight},
      {"AngularMomentumComesAndGoes", Wobble, Kind::kFlight},
      {"FlightWithContacts",
       [](Subject* s) {
         Flight(s).contacts = Landing(s).contacts;
         for (Knot& knot : Flight(s).knots) knot.forces = Matrix3Xd::Zero(3, 8);
       },
       Kind::kContactMotion},
      {"PointUnknown", [](Subject* s) { Landing(s).contacts[0] += "[0,1,2,4]"; }, Kind::kStructure},
      {"PointsOutOfOrder", [](Subject* s) { Landing(s).contacts[0] += "[0,2,1,3]"; },
       Kind::kStructure},
      {"PatchTwiceInParts",
       [](Subject* s) {
         Landing(s).contacts = {"left_sole[0,1]", "left_sole[2,3]", "right_sole"};
       },
       Kind::kStructure},
      {"EndsOnItsToes",
       [](Subject* s) {
         Landing(s).contacts[0] += "[0,3]";
         const auto without = [](const Matrix3Xd& all) {
           Matrix3Xd some(3, 6);
           some << all.col(0), all.rightCols(5);
           return some;
         };
         Landing(s).impulses = without(Landing(s).impulses);
         for (Knot& knot : Landing(s).knots) knot.forces = without(knot.forces);
       },
       Kind::kGoal},
  };
}

class DynamicPlanMutation : public ::testing::TestWithParam<PlanMutation> {};

TEST_P(DynamicPlanMutation, AMutationOfAHopIsFound) {
  VerifierSubject subject = ValidSubject();
  GetParam().apply(&subject);
  const VerificationReport report = Verified(subject);
  const bool found = std::any_of(report.violations.begin(), report.violations.end(),
                                 [](const Violation& v) { return v.kind == GetParam().expected; });
  EXPECT_TRUE(found) << "expected " << ToString(GetParam().expected) << "\n" << FormatText(report);
  EXPECT_TRUE(report.rollouts.empty());
}

/// What a file of version 2 cannot hold may be refused instead.
TEST_P(DynamicPlanMutation, AMutationOfAHopOfVersion2IsFoundInItsFile) {
  static const VerifierSubject hop = testing::Refined(ValidSubject());
  VerifierSubject subject = hop;
  GetParam().apply(&subject);
  const bool may_be_refused = GetParam().expected == ViolationKind::kStructure;
  try {
    subject.plan = testing::Repacked(subject.robot, subject.plan);
  } catch (const std::invalid_argument& error) {
    EXPECT_TRUE(may_be_refused) << error.what();
    return;
  } catch (const InputError& error) {
    EXPECT_TRUE(may_be_refused) << error.what();
    return;
  }
  EXPECT_NE(Find(Verified(subject), GetParam().expected), nullptr) << FormatText(Verified(subject));
}

INSTANTIATE_TEST_SUITE_P(Mutations, DynamicPlanMutation, ::testing::ValuesIn(DynamicMutations()),
                         [](const auto& info) { return info.param.name; });

TEST(DynamicPlan, AHopIsAccepted) {
  const VerificationReport report = Verified(ValidSubject());
  EXPECT_TRUE(report.accepted()) << FormatText(report);
  ASSERT_EQ(report.rollouts.size(), 1u);
  const RolloutDrift& drift = report.rollouts[0].drift;
  EXPECT_TRUE(drift.follows());
  EXPECT_TRUE(drift.ends_at_rest);
  EXPECT_GT(drift.impacts, 0);
  EXPECT_LT(drift.worst_position, 2e-3);
  EXPECT_LT(drift.worst_orientation, 2e-3);
  EXPECT_LT(drift.worst_joint, 5e-3);
  EXPECT_GT(drift.worst_joint, 0);
  EXPECT_LT(drift.end_position, 1e-3);
}

TEST(DynamicPlan, AHopIsAcceptedWhenWrittenAndReadBack) {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() /
      ("possibility_dynamic_plan_test_" + std::to_string(::getpid()) + ".json");
  VerifierSubject subject = ValidSubject();
  WritePlan(subject.plan, file);
  subject.plan = ReadPlan(file);
  std::filesystem::remove(file);
  ASSERT_EQ(Landing(&subject).impulses.cols(), 8);
  EXPECT_TRUE(Verified(subject).accepted());
}

TEST(DynamicPlan, NamesTheViolatedQuantityOfAnImpact) {
  const auto quantity = [](const std::function<void(VerifierSubject*)>& change) {
    VerifierSubject subject = ValidSubject();
    change(&subject);
    const VerificationReport report = Verified(subject);
    const Violation* violation = Find(report, ViolationKind::kImpact);
    return violation == nullptr ? std::string("none") : violation->quantity;
  };
  using Subject = VerifierSubject;
  EXPECT_EQ(quantity(MakeImpulsesPull), "left_sole point 3 impulse pulls on the ground");
  EXPECT_NE(quantity([](Subject* s) { Exchange(0, 1, 2, s); }).find("tangential impulse"),
            std::string::npos);
  EXPECT_EQ(quantity([](Subject* s) { Landing(s).impulses *= 1.001; }),
            "root jump of momentum off the declared impulses");
  EXPECT_NE(quantity([](Subject* s) { Bounce(1.5, s); }).find("not at rest after the impact"),
            std::string::npos);
}

TEST(DynamicPlan, NamesTheViolatedQuantityOfAFlight) {
  for (const bool wobbles : {false, true}) {
    VerifierSubject subject = ValidSubject();
    wobbles ? Wobble(&subject) : FallSlowly(&subject);
    const VerificationReport report = Verified(subject);
    const Violation* violation = Find(report, ViolationKind::kFlight);
    ASSERT_NE(violation, nullptr);
    EXPECT_EQ(violation->quantity,
              wobbles ? "change of angular momentum in flight" : "centre of mass off its parabola");
    EXPECT_GT(violation->time, Flight(&subject).knots.front().t);
    EXPECT_LT(violation->time, Flight(&subject).knots.back().t);
  }
}

/// The root of a flight in two phases must follow the same motion as in one phase. The second half
/// must continue what the first half began.
TEST(DynamicPlan, AFlightInTwoPhasesIsCheckedAsOne) {
  VerifierSubject subject = ValidSubject();
  std::vector<Phase>& phases = subject.plan.segments[0].phases;
  Phase second = phases[1];
  const std::size_t middle = second.knots.size() / 2;
  phases[1].knots.resize(middle + 1);
  second.knots.erase(second.knots.begin(), second.knots.begin() + static_cast<long>(middle));
  phases.insert(phases.begin() + 2, second);
  EXPECT_TRUE(Verified(subject).accepted());
  for (std::size_t p = 2; p < phases.size(); ++p) {
    for (Knot& knot : phases[p].knots) knot.q[4] += 2e-4;
  }
  const VerificationReport report = Verified(subject);
  EXPECT_NE(Find(report, ViolationKind::kFlight), nullptr) << FormatText(report);
}

/// A sole that stays on its toes keeps them in place. Its heel may come down elsewhere.
TEST(DynamicPlan, PartsOfAPatchAreAnchoredPointByPoint) {
  VerifierSubject subject = ValidSubject();
  Phase& push = subject.plan.segments[0].phases[0];
  Phase second = push;
  const std::size_t middle = push.knots.size() / 2;
  push.knots.resize(middle + 1);
  second.knots.erase(second.knots.begin(), second.knots.begin() + static_cast<long>(middle));
  second.contacts[0] = "left_sole[0,1,3]";
  for (Knot& knot : second.knots) {
    const Matrix3Xd all = knot.forces;
    knot.forces.resize(3, 7);
    knot.forces << all.leftCols<2>(), all.rightCols<5>();
  }
  subject.plan.segments[0].phases.insert(subject.plan.segments[0].phases.begin() + 1, second);
  // Three corners instead of four do not carry the same forces, but they are in the same places.
  const VerificationReport report = Verified(subject);
  EXPECT_EQ(Find(report, ViolationKind::kContactMotion), nullptr) << FormatText(report);
  EXPECT_EQ(Find(report, ViolationKind::kStructure), nullptr) << FormatText(report);
  EXPECT_NE(Find(report, ViolationKind::kDynamics), nullptr) << FormatText(report);
}

TEST(RolloutCheck, AFallIsFound) {
  const VerifierSubject& subject = ValidSubject();
  const models::GroundMap ground(subject.scenario.environment);
  Segment segment = subject.plan.segments[0];
  segment.phases.resize(1);
  EXPECT_TRUE(RollOutSegment(segment, subject.robot, ground).follows());
  segment.phases[0].knots[0].v[3] = 1.5;
  const RolloutDrift drift = RollOutSegment(segment, subject.robot, ground);
  EXPECT_FALSE(drift.follows());
  EXPECT_TRUE(!drift.failure.empty() || drift.end_position > kRolloutPosition ||
              drift.end_orientation > kRolloutOrientation);
}

TEST(RolloutCheck, ACancelledOrRefusedRolloutIsReportedInOneLine) {
  const VerifierSubject& subject = ValidSubject();
  const models::GroundMap ground(subject.scenario.environment);
  RolloutCheckSettings settings;
  settings.cancellation = CancellationToken([calls = 0]() mutable { return ++calls <= 10; });
  const Segment& segment = subject.plan.segments[0];
  const RolloutDrift stopped = RollOutSegment(segment, subject.robot, ground, settings);
  EXPECT_FALSE(stopped.follows());
  EXPECT_NE(stopped.failure.find("ends at 0."), std::string::npos) << stopped.failure;
  Segment sunk = segment;
  sunk.phases[0].knots[0].q[6] -= 0.01;
  const RolloutDrift refused = RollOutSegment(sunk, subject.robot, ground);
  EXPECT_FALSE(refused.follows());
  EXPECT_NE(refused.failure, "");
  EXPECT_EQ(refused.failure.find('\n'), std::string::npos) << refused.failure;
}

/// The plinth ends between the feet. The foot over it bears on it, the other foot on the floor.
TEST(RolloutCheck, EachFootBearsOnTheGroundUnderIt) {
  const models::RobotModel& robot = ValidSubject().robot;
  models::Environment environment = ValidSubject().scenario.environment;
  models::Obstacle plinth = environment.obstacles[0];
  plinth.name = "plinth";
  plinth.shape = models::Shape::Box({1, 0.5, 0.03});
  plinth.X_WO.translation() << 0, 0.25, 0.015;
  environment.obstacles.push_back(plinth);
  const Segment segment = testing::Hop(robot, 0.03).Build();
  const RolloutDrift drift = RollOutSegment(segment, robot, models::GroundMap(environment));
  EXPECT_TRUE(drift.follows()) << drift.failure;
  EXPECT_LT(drift.worst_position, 2e-3);
  // Without the plinth the left foot bears on nothing.
  environment.obstacles.back().X_WO.translation().y() = 5;
  RolloutCheckSettings settings;
  settings.settling_time = 0.1;
  const models::GroundMap floor(environment);
  EXPECT_FALSE(RollOutSegment(segment, robot, floor, settings).follows());
}

TEST(VerificationReport, ListsRolloutsInTextAndJson) {
  VerificationReport report;
  EXPECT_EQ(FormatJson(report).find("rollout"), std::string::npos);
  report.rollouts.resize(2);
  report.rollouts[0].segment = 4;
  report.rollouts[0].drift.worst_position = 0.0125;
  report.rollouts[1].drift.failure = "ends at 1.000 s: Zeno";
  EXPECT_NE(FormatText(report).find("simulated segment 4"), std::string::npos);
  EXPECT_NE(FormatText(report).find("0.0125 m"), std::string::npos);
  EXPECT_NE(FormatText(report).find("ends at 1.000 s: Zeno\n"), std::string::npos);
  const nlohmann::json json = nlohmann::json::parse(FormatJson(report));
  ASSERT_EQ(json["rollout"].size(), 2u);
  EXPECT_EQ(json["rollout"][0]["segment"], 4);
  EXPECT_EQ(json["rollout"][0]["worst_position_m"], 0.0125);
  EXPECT_EQ(json["rollout"][1]["failure"], "ends at 1.000 s: Zeno");
}

}  // namespace
}  // namespace possibility::actions
