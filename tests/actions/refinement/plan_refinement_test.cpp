#include "actions/refinement/plan_refinement.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "actions/checks/plan_torques.h"
#include "actions/plan/interpolation.h"
#include "actions/plan/packed_writer.h"
#include "actions/plan/plan_reader.h"
#include "actions/plan/plan_rounding.h"
#include "actions/plan/plan_writer.h"
#include "actions/refinement/unsupported_motion.h"
#include "actions/verify/verification_report.h"
#include "dynamics/tree/multibody_dynamics.h"
#include "models/input/input_error.h"
#include "tests/actions/drchubo1.h"
#include "tests/actions/hop_plan.h"
#include "tests/actions/shipped_robots.h"
#include "tests/actions/standing_plan.h"

namespace possibility::actions {
namespace {

using testing::Find;
using testing::VerifierSubject;

const VerifierSubject& Hopping() {
  static const VerifierSubject subject = [] {
    VerifierSubject hop = testing::HopPlan(POSSIBILITY_SOURCE_DIR "/models/drchubo1/drchubo1.yaml");
    // Coarse enough that the quintics stray in flight.
    Phase& flight = hop.plan.segments[0].phases[1];
    std::vector<Knot> knots;
    for (std::size_t k = 0; k < flight.knots.size(); k += 4) knots.push_back(flight.knots[k]);
    flight.knots = std::move(knots);
    return hop;
  }();
  return subject;
}

const VerifierSubject& RefinedHop() {
  static const VerifierSubject subject = [] {
    VerifierSubject hop = Hopping();
    hop.plan = RefinedPlan(hop.plan, hop.robot);
    return hop;
  }();
  return subject;
}

/// The largest force or torque on the root of a flying robot between knots, of the weight (x 1 m),
/// by our own inverse dynamics instead of Simbody's.
double LeftInFlight(const VerifierSubject& subject) {
  const models::RobotModel& robot = subject.robot;
  dynamics::MultibodyDynamics dynamics(dynamics::MultibodyModel::Spatial(robot));
  const Phase& flight = subject.plan.segments[0].phases[1];
  double most = 0;
  for (std::size_t k = 0; k + 1 < flight.knots.size(); ++k) {
    const KnotInterpolant interpolant(flight.knots[k], flight.knots[k + 1]);
    for (double s = 0.05; s < 1; s += 0.05) {
      const Knot knot = interpolant.At(interpolant.start() + s * interpolant.duration());
      dynamics.SetState(knot.q, knot.v, knot.a);
      most = std::max(most, dynamics.InverseDynamics().head<6>().cwiseAbs().maxCoeff());
    }
  }
  return most / (robot.TotalMass() * dynamics::kGravity);
}

std::filesystem::path TemporaryFile(const std::string& name) {
  return std::filesystem::temp_directory_path() /
         ("refinement_" + std::to_string(::getpid()) + name);
}

TEST(UnsupportedMotions, AreThoseThatTheContactsLeaveFree) {
  const VerifierSubject& subject = testing::ValidSubject();
  StateEvaluator evaluator(subject.robot);
  Phase phase = subject.plan.segments[0].phases[0];
  const VerifierState state = evaluator.Evaluate(phase.knots[3]);
  const auto free_with = [&](const std::vector<std::string>& contacts) {
    phase.contacts = contacts;
    return UnsupportedMotions(state, BearingPoints(subject.robot, phase));
  };
  EXPECT_EQ(free_with({}).cols(), 6);
  EXPECT_EQ(free_with({"left_sole[2]"}).cols(), 3);
  EXPECT_EQ(free_with({"left_sole[0,3]"}).cols(), 1);
  EXPECT_EQ(free_with({"left_sole[0,3]", "right_sole[0,3]"}).cols(), 1);
  EXPECT_EQ(free_with({"left_sole"}).cols(), 0);

  // About a line of points, none of them moves.
  const auto turn = free_with({"left_sole[0,3]"});
  for (const BearingPoint& point : BearingPoints(subject.robot, phase)) {
    const Eigen::Vector3d arm = state.Position(point) - state.X_WL[0].translation();
    const Eigen::Vector3d omega = turn.col(0).head<3>();
    EXPECT_LT((turn.col(0).tail<3>() + omega.cross(arm)).norm(), 1e-12);
  }
}

TEST(RefinedPlan, ObeysTheDynamicsInFlightBetweenKnots) {
  EXPECT_GT(LeftInFlight(Hopping()), 1e-6) << "nothing to refine";
  EXPECT_LT(LeftInFlight(RefinedHop()), 1e-6);
}

TEST(RefinedPlan, IsAcceptedAndWithoutRefinementItIsNot) {
  const VerificationReport report = Verified(RefinedHop());
  EXPECT_TRUE(report.accepted()) << FormatText(report);
  VerifierSubject claimed = Hopping();
  EXPECT_TRUE(Verified(claimed).accepted());
  claimed.plan.version = 2;
  const VerificationReport refused = Verified(claimed);
  ASSERT_NE(Find(refused, ViolationKind::kDynamics), nullptr) << FormatText(refused);
}

TEST(RefinedPlan, MovesByMillionthsAndComesBack) {
  const std::vector<Phase>& phases = RefinedHop().plan.segments[0].phases;
  const std::vector<Phase>& planned = Hopping().plan.segments[0].phases;
  for (const std::size_t i : {0, 2}) {
    ASSERT_EQ(phases[i].knots.size(), planned[i].knots.size());
    for (std::size_t k = 0; k < phases[i].knots.size(); ++k) {
      EXPECT_LT((phases[i].knots[k].q - planned[i].knots[k].q).cwiseAbs().maxCoeff(), 1e-5);
    }
  }
  EXPECT_GE(phases[1].knots.size(), planned[1].knots.size());
  EXPECT_LT((phases[2].knots.back().q - planned[2].knots.back().q).cwiseAbs().maxCoeff(), 2e-9);
  for (std::size_t i = 1; i < phases.size(); ++i) {
    EXPECT_LT((phases[i].knots[0].q - phases[i - 1].knots.back().q).cwiseAbs().maxCoeff(), 1e-9);
  }
}

TEST(RefinedPlan, ReadsBackToTheSameBits) {
  const std::filesystem::path file = TemporaryFile(".zip");
  const Plan& plan = RefinedHop().plan;
  WritePackedPlan(plan, file, PackedTorques::kLeftOut);
  Plan read = ReadPlan(file);
  CompleteTorques(RefinedHop().robot, &read);
  std::filesystem::remove(file);
  for (std::size_t i = 0; i < plan.segments[0].phases.size(); ++i) {
    const Phase& expected = plan.segments[0].phases[i];
    const Phase& phase = read.segments[0].phases[i];
    ASSERT_EQ(phase.knots.size(), expected.knots.size());
    for (std::size_t k = 0; k < phase.knots.size(); ++k) {
      EXPECT_EQ(phase.knots[k].q, expected.knots[k].q);
      EXPECT_EQ(phase.knots[k].v, expected.knots[k].v);
      EXPECT_EQ(phase.knots[k].a, expected.knots[k].a);
      EXPECT_EQ(phase.knots[k].tau, expected.knots[k].tau);
      EXPECT_EQ(phase.knots[k].forces, expected.knots[k].forces);
    }
  }
}

TEST(RefinedPlan, IsStillAPlanOfVersion1) {
  const std::filesystem::path file = TemporaryFile(".json");
  VerifierSubject subject = RefinedHop();
  WritePlan(subject.plan, file);
  subject.plan = ReadPlan(file);
  std::filesystem::remove(file);
  EXPECT_EQ(subject.plan.version, 1);
  const VerificationReport report = Verified(subject);
  EXPECT_TRUE(report.accepted()) << FormatText(report);
}

TEST(RefinedPlan, OfVersion2StaysAsItIs) {
  const Plan again = RefinedPlan(RefinedHop().plan, RefinedHop().robot);
  EXPECT_EQ(again.segments[0].phases[1].knots[2].q,
            RefinedHop().plan.segments[0].phases[1].knots[2].q);
}

TEST(RefinedPlan, EveryRobotsStandingPlanIsAccepted) {
  for (const std::string& robot : ShippedRobotNames()) {
    SCOPED_TRACE(robot);
    VerifierSubject subject = testing::StandingPlan(RobotNamed(robot).robot().file.string());
    subject.plan = RefinedPlan(subject.plan, subject.robot);
    const VerificationReport report = Verified(subject);
    EXPECT_TRUE(report.accepted()) << FormatText(report);
  }
}

TEST(RefinedPlan, RefusesWhatDoesNotFitTheRobot) {
  VerifierSubject subject = testing::ValidSubject();
  Phase& phase = subject.plan.segments[0].phases[0];
  Plan plan = subject.plan;
  phase.contacts[0] = "tail";
  EXPECT_THROW(RefinedPlan(subject.plan, subject.robot), InputError);
  plan.segments[0].phases[0].knots[1].v.conservativeResize(3);
  EXPECT_THROW(RefinedPlan(plan, subject.robot), std::invalid_argument);
}

}  // namespace
}  // namespace possibility::actions
