// Forged versions of a dynamic walk. The forger adapts what the verifier compares.
#include <gtest/gtest.h>

#include <functional>
#include <set>

#include "actions/verify/verification_report.h"
#include "actions/verify/verifier.h"
#include "dynamics/contact/contact_forces.h"
#include "tests/actions/dynamic_gaits.h"
#include "tests/actions/packed_subject.h"
#include "tests/actions/standing_plan.h"

namespace possibility::actions {
namespace {

using Eigen::VectorXd;

/// `GetParam()`: the version of the plan's format.
class DynamicSabotage : public ::testing::TestWithParam<int> {
 protected:
  DynamicSabotage() {
    scenario_.goals = {{"walk", kEnd, 0, 0, 0}};
    plan_ = WalkTo({kEnd, 0, 0}, scenario_);
    if (GetParam() == 2) plan_ = RefinedPlan(plan_, DrcHubo1());
  }

  std::vector<Phase>& phases() { return plan_.segments.front().phases; }

  VerificationReport Report() const {
    return Verify(GetParam() == 2 ? testing::Repacked(DrcHubo1(), plan_) : plan_, DrcHubo1(),
                  scenario_);
  }

  /// Expects a rejection for one of these reasons.
  void ExpectRejected(const std::set<ViolationKind>& reasons) const {
    const VerificationReport report = Report();
    bool found = false;
    for (const Violation& violation : report.violations) found |= reasons.contains(violation.kind);
    EXPECT_TRUE(found) << FormatText(report);
  }

  /// Applies a change to every knot.
  void Change(const std::function<void(Knot*)>& change) {
    for (Phase& phase : phases()) {
      for (Knot& knot : phase.knots) change(&knot);
    }
  }

  /// Plays the motion `speed` times as fast.
  void PlayFaster(double speed) {
    Change([speed](Knot* knot) {
      knot->t /= speed;
      knot->v *= speed;
      knot->a *= speed * speed;
    });
  }

  /// Replaces torques and forces by those that realise the motion without any limits, where they
  /// exist.
  void ForgeForces() {
    models::RobotModel robot = DrcHubo1();
    for (models::Joint& joint : robot.joints) joint.mimic.reset();
    dynamics::MultibodyDynamics dynamics(dynamics::MultibodyModel::Spatial(robot));
    dynamics::ContactForceSettings settings;
    settings.friction_margin = 100;
    settings.torque_margin = 100;
    for (Phase& phase : phases()) {
      std::vector<dynamics::ContactPoint> points;
      for (const std::string& name : phase.contacts) {
        const models::ContactPatch& patch = robot.contacts[robot.ContactIndex(name)];
        for (const Eigen::Vector3d& p : patch.points) points.push_back({patch.link, p});
      }
      for (Knot& knot : phase.knots) {
        dynamics.SetState(knot.q, knot.v, knot.a);
        const auto forces = DistributeContactForces(&dynamics, points, settings);
        if (!forces) continue;
        knot.forces = forces->forces;
        knot.tau = forces->torques;
      }
    }
  }

  static constexpr double kEnd = 0.8;  // m
  models::Scenario scenario_ = testing::FlatScenario();
  Plan plan_;
};

TEST_P(DynamicSabotage, TheUntouchedWalkIsAccepted) {
  EXPECT_TRUE(Report().accepted()) << FormatText(Report());
}

TEST_P(DynamicSabotage, ForgedForcesOfTheTrueMotionAreAccepted) {
  ForgeForces();
  const VerificationReport report = Report();
  for (const Violation& violation : report.violations) {
    EXPECT_NE(violation.kind, ViolationKind::kDynamics) << FormatText(report);
  }
}

TEST_P(DynamicSabotage, AWalkPlayedFasterIsRejected) {
  PlayFaster(1.2);
  ExpectRejected({ViolationKind::kDynamics});
}

TEST_P(DynamicSabotage, AWalkPlayedFasterWithForgedForcesIsRejected) {
  PlayFaster(1.2);
  ForgeForces();
  ExpectRejected({ViolationKind::kDynamics, ViolationKind::kFriction, ViolationKind::kJointTorque,
                  ViolationKind::kJointSpeed});
}

TEST_P(DynamicSabotage, AZeroMomentPointOutsideTheSoleIsRejected) {
  // The whole robot is pulled aside in mid-swing, faster than the foot can press.
  Phase& swing = phases()[3];
  ASSERT_EQ(swing.contacts.size(), 1u);
  for (Knot& knot : swing.knots) knot.a[4] += 2.5;
  ForgeForces();
  ExpectRejected({ViolationKind::kDynamics, ViolationKind::kFriction});
}

TEST_P(DynamicSabotage, AShortenedPhaseIsRejected) {
  constexpr double kShare = 0.8;
  Phase& swing = phases()[3];
  const double start = swing.knots.front().t;
  const double saved = (1 - kShare) * (swing.knots.back().t - start);
  for (Knot& knot : swing.knots) {
    knot.t = start + kShare * (knot.t - start);
    knot.v /= kShare;
    knot.a /= kShare * kShare;
  }
  for (std::size_t i = 4; i < phases().size(); ++i) {
    for (Knot& knot : phases()[i].knots) knot.t -= saved;
  }
  ForgeForces();
  ExpectRejected({ViolationKind::kVelocityContinuity});
}

TEST_P(DynamicSabotage, ASwingFootThroughAKerbIsRejected) {
  models::Obstacle kerb;
  kerb.name = "kerb";
  kerb.shape = models::Shape::Box({0.02, 4, 0.06});
  // Higher than the foot is lifted.
  kerb.X_WO.translation() = Eigen::Vector3d(0.4, 0, 0.03);
  scenario_.environment.obstacles.push_back(kerb);
  ExpectRejected({ViolationKind::kPenetration});
}

INSTANTIATE_TEST_SUITE_P(Versions, DynamicSabotage, ::testing::Values(1, 2));

}  // namespace
}  // namespace possibility::actions
