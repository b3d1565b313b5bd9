#include "actions/checks/plan_torques.h"

#include <gtest/gtest.h>

#include <cmath>

#include "actions/verify/verification_report.h"
#include "dynamics/tree/multibody_dynamics.h"
#include "tests/actions/hop_plan.h"
#include "tests/actions/packed_subject.h"
#include "tests/actions/shipped_robots.h"
#include "tests/actions/standing_plan.h"

namespace possibility::actions {
namespace {

using testing::Find;
using testing::KnotsOf;
using testing::VerifierSubject;

/// Stands, hops and lands, in version 2.
const VerifierSubject& PackedHop() {
  static const VerifierSubject subject =
      testing::Refined(testing::HopPlan(POSSIBILITY_SOURCE_DIR "/models/drchubo1/drchubo1.yaml"));
  return subject;
}

VerifierSubject WithoutTorques(VerifierSubject subject) {
  for (Knot* knot : KnotsOf(&subject.plan)) knot->tau.resize(0);
  return subject;
}

TEST(PlanTorques, WhatIsLeftOutIsComputedToTheSameBits) {
  VerifierSubject subject = WithoutTorques(PackedHop());
  CompleteTorques(subject.robot, &subject.plan);
  VerifierSubject original = PackedHop();
  const std::vector<Knot*> knots = KnotsOf(&subject.plan);
  const std::vector<Knot*> expected = KnotsOf(&original.plan);
  ASSERT_EQ(knots.size(), expected.size());
  for (std::size_t k = 0; k < knots.size(); ++k) EXPECT_EQ(knots[k]->tau, expected[k]->tau) << k;
}

/// In flight they are those of our own inverse dynamics, which shares no code with Simbody.
TEST(PlanTorques, InFlightAreThoseOfInverseDynamics) {
  VerifierSubject subject = WithoutTorques(PackedHop());
  CompleteTorques(subject.robot, &subject.plan);
  dynamics::MultibodyDynamics dynamics(dynamics::MultibodyModel::Spatial(subject.robot));
  const Phase& flight = subject.plan.segments[0].phases[1];
  ASSERT_TRUE(flight.contacts.empty());
  for (const Knot& knot : flight.knots) {
    dynamics.SetState(knot.q, knot.v, knot.a);
    EXPECT_LT((knot.tau - dynamics.InverseDynamics().tail(knot.tau.size())).cwiseAbs().maxCoeff(),
              1e-8);
  }
}

TEST(PlanTorques, APlanWhoseTorquesAreComputedIsAccepted) {
  for (const std::string& robot : ShippedRobotNames()) {
    SCOPED_TRACE(robot);
    VerifierSubject subject = WithoutTorques(
        testing::Refined(testing::StandingPlan(RobotNamed(robot).robot().file.string())));
    EXPECT_NE(Find(Verified(subject), ViolationKind::kStructure), nullptr) << "without torques";
    CompleteTorques(subject.robot, &subject.plan);
    EXPECT_TRUE(Verified(subject).accepted()) << FormatText(Verified(subject));
  }
}

TEST(PlanTorques, AreLeftOutOnlyIfTheyFollow) {
  EXPECT_EQ(TorquesToPack(PackedHop().robot, PackedHop().plan), PackedTorques::kLeftOut);
  const auto choice_after = [](const std::function<void(Plan*)>& change) {
    Plan plan = PackedHop().plan;
    change(&plan);
    return TorquesToPack(PackedHop().robot, plan);
  };
  EXPECT_EQ(choice_after([](Plan* plan) { plan->version = 1; }), PackedTorques::kStored);
  for (const std::size_t phase : {0, 1, 2}) {
    EXPECT_EQ(choice_after(
                  [&](Plan* plan) { plan->segments[0].phases[phase].knots.back().tau[5] += 1e-3; }),
              PackedTorques::kStored);
    EXPECT_EQ(choice_after([&](Plan* plan) {
                plan->segments[0].phases[phase].knots[1].tau[0] = std::nan("");
              }),
              PackedTorques::kStored);
  }
  EXPECT_EQ(choice_after([](Plan* plan) { plan->segments[0].phases[0].contacts[0] = "tail"; }),
            PackedTorques::kStored);
  EXPECT_EQ(
      choice_after([](Plan* plan) { plan->segments[0].phases[1].knots[1].q[0] = std::nan(""); }),
      PackedTorques::kStored);
}

TEST(PlanTorques, OfAMotionThatIsNotTheRobotsAreNotComputed) {
  VerifierSubject subject = WithoutTorques(PackedHop());
  subject.plan.segments[0].phases[0].contacts[0] = "tail";
  subject.plan.segments[0].phases[1].knots[0].v.conservativeResize(3);
  CompleteTorques(subject.robot, &subject.plan);
  const std::vector<Phase>& phases = subject.plan.segments[0].phases;
  EXPECT_EQ(phases[0].knots[0].tau.size(), 0);
  EXPECT_EQ(phases[1].knots[1].tau.size(), 0);
  EXPECT_EQ(phases[2].knots[0].tau.size(), subject.robot.num_joints());
}

}  // namespace
}  // namespace possibility::actions
