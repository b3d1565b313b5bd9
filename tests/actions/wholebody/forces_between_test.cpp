#include "actions/wholebody/forces_between.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "actions/checks/forces_check.h"
#include "actions/evidence/verifier_state.h"
#include "actions/plan/interpolation.h"
#include "tests/actions/standing_plan.h"

namespace possibility::actions {
namespace {

using testing::ValidSubject;
using testing::VerifierSubject;

std::vector<dynamics::ContactPoint> ContactPointsOf(const models::RobotModel& robot,
                                                    const Phase& phase) {
  std::vector<dynamics::ContactPoint> points;
  for (const BearingPoint& point : BearingPoints(robot, phase)) {
    points.push_back({point.link, point.p_L});
  }
  return points;
}

/// By how much the verifier's forces between two knots leave cones and limits at most, in shares of
/// the weight and of the torque; 0: they do not.
double WorstOf(const VerifierSubject& subject, const Phase& phase, const Knot& from, const Knot& to,
               StateEvaluator* evaluator) {
  const models::RobotModel& robot = subject.robot;
  const double weight = robot.TotalMass() * dynamics::kGravity;
  const KnotInterpolant motion(from, to);
  double worst = 0;
  for (const double share : {0.25, 0.5, 0.75}) {
    const VerifierState state = evaluator->Evaluate(motion.At(from.t + share * (to.t - from.t)));
    const RealisedForces realised =
        RealiseForces(state, BearingPoints(robot, phase), robot, evaluator->dynamics());
    for (const auto& force : realised.forces.colwise()) {
      worst = std::max(worst, -force.z() / weight);
      worst = std::max(worst, (force.head<2>().norm() - robot.friction * force.z()) / weight);
    }
    for (int j = 0; j < robot.num_joints(); ++j) {
      worst = std::max(worst, std::abs(realised.torques[j]) / robot.joints[j].effort - 1);
    }
  }
  return worst;
}

/// Rates at the second knot that accelerations do not lead to make the quintic stray.
TEST(ForceFaultBetween, AgreesWithTheVerifiersForces) {
  const VerifierSubject& subject = ValidSubject();
  const Phase& phase = subject.plan.segments[0].phases[0];
  const std::vector<dynamics::ContactPoint> points = ContactPointsOf(subject.robot, phase);
  StateEvaluator evaluator(subject.robot);
  dynamics::MultibodyDynamics dynamics(UncoupledModel(subject.robot));
  std::mt19937 generator(5);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> exponent(-4, -1);
  std::uniform_int_distribution<std::size_t> index(1, phase.knots.size() - 1);
  int faults = 0;
  constexpr int kTrials = 400;
  for (int trial = 0; trial < kTrials; ++trial) {
    const std::size_t k = index(generator);
    const Knot& from = phase.knots[k - 1];
    Knot to = phase.knots[k];
    const double size = std::pow(10, exponent(generator));
    for (double& rate : to.v) rate += size * normal(generator);
    for (double& joint : to.q.tail(subject.robot.num_joints())) {
      joint += size * (to.t - from.t) * normal(generator);
    }
    const auto fault = ForceFaultBetween(subject.robot, points, from, to, 0, &dynamics);
    const double worst = WorstOf(subject, phase, from, to, &evaluator);
    EXPECT_EQ(fault.has_value(), worst > 5e-7)
        << worst << ": " << (fault ? fault->what() : "no fault");
    faults += fault.has_value();
  }
  EXPECT_GT(faults, kTrials / 10);
  EXPECT_LT(faults, kTrials * 9 / 10);
}

/// The pelvis moves ahead so quickly that heels or toes would have to pull on the way, but not at
/// its ends, where the only knots are.
TEST(ForceFaultBetween, IsFoundByTheBuilderIfAskedFor) {
  const VerifierSubject& subject = ValidSubject();
  const NominalStance stance = SolveNominalStance(subject.robot, subject.robot.GaitNamed("walk"));
  MotionSettings settings;
  settings.knot_spacing = 0.36;
  settings.minimum_intervals = 1;
  const auto build = [&](double ahead) {
    return MotionBuilder(subject.robot, settings)
        .Build({testing::PelvisShift(stance, Eigen::Vector3d(ahead, 0, 0), false, 0.36)}, stance.q);
  };
  const Phase unseen = build(0.04)[0];
  ASSERT_EQ(unseen.knots.size(), 2u);
  StateEvaluator evaluator(subject.robot);
  EXPECT_GT(WorstOf(subject, unseen, unseen.knots[0], unseen.knots[1], &evaluator), 1e-3);
  settings.tests_between_knots = true;
  EXPECT_EQ(build(0.01)[0].knots.size(), 2u);
  EXPECT_THROW(build(0.04), MotionError);  // nor with knots on the way
}

}  // namespace
}  // namespace possibility::actions
