#include "dynamics/ode/ode_integrator.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <string>

namespace possibility::dynamics {
namespace {

using Eigen::VectorXd;
using State = const Eigen::Ref<const VectorXd>&;
using Output = Eigen::Ref<VectorXd>;

OdeSettings Accurate(double tolerance = 1e-12) {
  OdeSettings settings;
  settings.relative_tolerance = tolerance;
  settings.absolute_tolerance = tolerance;
  return settings;
}

/// x'' = -x from (1, 0): cos t.
OdeProblem Oscillator(double end_time) {
  OdeProblem problem;
  problem.rate = [](double, State x, Output rate) { rate << x[1], -x[0]; };
  problem.start = Eigen::Vector2d(1, 0);
  problem.end_time = end_time;
  return problem;
}

OdeProblem Watching(OdeProblem problem, std::vector<OdeGuard> guards, OdeGuardFunction values) {
  problem.guards = std::move(guards);
  problem.guard_values = std::move(values);
  return problem;
}

std::string ErrorOf(const OdeProblem& problem, const OdeSettings& settings = {}) {
  try {
    Integrate(problem, settings);
  } catch (const OdeError& error) {
    return error.what();
  }
  return "";
}

TEST(OdeIntegrator, DenseOutputIsAsAccurateAsTheIntegration) {
  const OdeSolution solution = Integrate(Oscillator(20), Accurate());
  EXPECT_EQ(solution.end, OdeEnd::kTime);
  EXPECT_EQ(solution.time, 20);
  EXPECT_EQ(solution.trajectory.end_time(), 20);
  double worst_state = 0, worst_rate = 0;
  for (int i = 0; i <= 2000; ++i) {
    const double t = 20 * i / 2000.0;
    const Eigen::Vector2d exact(std::cos(t), -std::sin(t));
    const Eigen::Vector2d exact_rate(-std::sin(t), -std::cos(t));
    worst_state = std::max(worst_state, (solution.trajectory.State(t) - exact).norm());
    worst_rate = std::max(worst_rate, (solution.trajectory.Rate(t) - exact_rate).norm());
  }
  const double at_the_end = (solution.state - Eigen::Vector2d(std::cos(20), -std::sin(20))).norm();
  EXPECT_LT(at_the_end, 1e-9);
  EXPECT_LT(worst_state, 1e-9);
  EXPECT_LT(worst_rate, 1e-7);
  EXPECT_EQ(solution.trajectory.State(20), solution.state);
}

TEST(OdeIntegrator, RandomLinearSystemsAgreeWithTheirEigenmodes) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int trial = 0; trial < 30; ++trial) {
    Eigen::Matrix4d basis;
    Eigen::Vector4d rates;
    for (double& x : basis.reshaped()) x = uniform(random);
    basis += 3 * Eigen::Matrix4d::Identity();
    for (double& x : rates) x = 3 * uniform(random) - 2;
    const Eigen::Matrix4d A = basis * rates.asDiagonal() * basis.inverse();
    OdeProblem problem;
    problem.rate = [&A](double, State x, Output rate) { rate = A * x; };
    problem.start = Eigen::Vector4d(1, -2, 0.5, 3);
    problem.end_time = 2;
    for (const OdeMethod method : {OdeMethod::kAdams, OdeMethod::kBdf}) {
      OdeSettings settings = Accurate(1e-10);
      settings.method = method;
      const OdeSolution solution = Integrate(problem, settings);
      for (const double t : {0.3, 1.1, 2.0}) {
        const Eigen::Vector4d growth = (rates * t).array().exp();
        const Eigen::Vector4d exact =
            basis * growth.asDiagonal() * (basis.inverse() * problem.start);
        EXPECT_LT((solution.trajectory.State(t) - exact).norm(), 1e-6 * (1 + exact.norm()));
      }
    }
  }
}

TEST(OdeIntegrator, ATimeDependentRateFromANegativeTimeIsIntegrated) {
  OdeProblem problem;
  problem.rate = [](double t, State, Output rate) { rate[0] = 3 * t * t; };
  problem.start = VectorXd::Constant(1, -8);
  problem.start_time = -2;
  problem.end_time = 3;
  const OdeSolution solution = Integrate(problem, Accurate());
  EXPECT_NEAR(solution.state[0], 27, 1e-8);
  EXPECT_EQ(solution.trajectory.start_time(), -2);
  EXPECT_NEAR(solution.trajectory.State(-1.5)[0], -3.375, 1e-8);
}

TEST(OdeIntegrator, StiffProblemNeedsFewStepsWithBdf) {
  // Prothero & Robinson: x = cos t is a solution for any stiffness.
  OdeProblem problem;
  problem.rate = [](double t, State x, Output rate) {
    rate[0] = -1e6 * (x[0] - std::cos(t)) - std::sin(t);
  };
  problem.start = VectorXd::Constant(1, 1.5);
  problem.end_time = 10;
  OdeSettings settings = Accurate(1e-8);
  settings.method = OdeMethod::kBdf;
  settings.max_steps = 5000;
  const OdeSolution solution = Integrate(problem, settings);
  EXPECT_NEAR(solution.state[0], std::cos(10), 1e-6);
  EXPECT_NEAR(solution.trajectory.State(5)[0], std::cos(5), 1e-6);
  EXPECT_LT(solution.statistics.steps, 2000);
  settings.method = OdeMethod::kAdams;
  EXPECT_NE(ErrorOf(problem, settings).find("steps taken"), std::string::npos);
}

/// Robertson's reaction until t = 40, with tolerances for it.
OdeSolution SolveRobertson(const OdeJacobian& jacobian) {
  OdeProblem problem;
  problem.rate = [](double, State y, Output rate) {
    rate[0] = -0.04 * y[0] + 1e4 * y[1] * y[2];
    rate[2] = 3e7 * y[1] * y[1];
    rate[1] = -rate[0] - rate[2];
  };
  problem.jacobian = jacobian;
  problem.start = Eigen::Vector3d(1, 0, 0);
  problem.end_time = 40;
  OdeSettings settings;
  settings.method = OdeMethod::kBdf;
  settings.relative_tolerance = 1e-9;
  settings.absolute_tolerances = Eigen::Vector3d(1e-10, 1e-14, 1e-10);
  return Integrate(problem, settings);
}

TEST(OdeIntegrator, AGivenJacobianSavesEvaluationsAndKeepsTheSolution) {
  const auto jacobian = [](double, State y, Eigen::Ref<Eigen::MatrixXd> J) {
    J.row(0) << -0.04, 1e4 * y[2], 1e4 * y[1];
    J.row(2) << 0, 6e7 * y[1], 0;
    J.row(1) = -J.row(0) - J.row(2);
  };
  const auto rough = [&](double t, State y, Eigen::Ref<Eigen::MatrixXd> J) {
    jacobian(t, y, J);
    J *= 1.02;
  };
  const OdeSolution by_differences = SolveRobertson({});
  for (const OdeSolution& solution : {SolveRobertson(jacobian), SolveRobertson(rough)}) {
    EXPECT_LT((solution.state - by_differences.state).norm(), 1e-8);
    EXPECT_GT(solution.statistics.jacobian_evaluations, 0);
  }
  EXPECT_LT(SolveRobertson(jacobian).statistics.rate_evaluations +
                2 * by_differences.statistics.jacobian_evaluations,
            by_differences.statistics.rate_evaluations);
}

/// A chain of masses on stiff springs and dampers, x'' = -K x - D x', with its exact Jacobian.
OdeProblem StiffChain(std::mt19937* random, int masses, int positions) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  Eigen::MatrixXd root(masses, masses), speeds(masses, masses);
  for (double& entry : root.reshaped()) entry = uniform(*random);
  // Rates of positions need not be the velocities themselves.
  for (double& entry : speeds.reshaped()) entry = uniform(*random);
  const Eigen::MatrixXd K = 1e6 * root * root.transpose();
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(2 * masses, 2 * masses);
  J.topRightCorner(masses, masses) =
      Eigen::MatrixXd::Identity(masses, masses) + 0.1 * (speeds + speeds.transpose());
  J.bottomLeftCorner(masses, masses) = -K;
  J.bottomRightCorner(masses, masses) = -1e-2 * K;
  OdeProblem problem;
  problem.rate = [J](double, State x, Output rate) { rate = J * x; };
  problem.jacobian = [J](double, State, Eigen::Ref<Eigen::MatrixXd> out) { out = J; };
  problem.positions = positions;
  problem.start = VectorXd::LinSpaced(2 * masses, 0, 1);
  problem.end_time = 2;
  return problem;
}

TEST(OdeIntegrator, EliminatedPositionsGiveTheSameSolution) {
  OdeSettings settings = Accurate(1e-9);
  settings.method = OdeMethod::kBdf;
  for (int masses = 1; masses < 8; ++masses) {
    std::mt19937 random(masses), same(masses);
    const OdeSolution eliminated = Integrate(StiffChain(&random, masses, masses), settings);
    const OdeSolution whole = Integrate(StiffChain(&same, masses, 0), settings);
    EXPECT_LT((eliminated.state - whole.state).norm(), 1e-6 * (1 + whole.state.norm()));
    // The same iteration up to rounding: neither converges more slowly.
    EXPECT_NEAR(eliminated.statistics.rate_evaluations, whole.statistics.rate_evaluations,
                0.1 * whole.statistics.rate_evaluations);
  }
}

TEST(OdeIntegrator, PositionsThatDriveThemselvesAreRefused) {
  std::mt19937 random(1);
  OdeProblem problem = StiffChain(&random, 2, 2);
  problem.jacobian = [](double, State, Eigen::Ref<Eigen::MatrixXd> J) { J.setIdentity(); };
  OdeSettings settings;
  settings.method = OdeMethod::kBdf;
  EXPECT_THROW(Integrate(problem, settings), std::invalid_argument);
}

TEST(OdeIntegrator, AFailureOfTheJacobianReachesTheCaller) {
  const auto throws = [](double, State, Eigen::Ref<Eigen::MatrixXd>) {
    throw std::runtime_error("no Jacobian here");
  };
  EXPECT_THROW(SolveRobertson(throws), std::runtime_error);
  const auto not_finite = [](double, State, Eigen::Ref<Eigen::MatrixXd> J) {
    J.setConstant(std::numeric_limits<double>::quiet_NaN());
  };
  EXPECT_THROW(SolveRobertson(not_finite), OdeError);
}

TEST(OdeIntegrator, RobertsonKineticsAgreesWithPublishedValues) {
  // Hairer & Wanner, Solving ODEs II: reference values at t = 40.
  const OdeSolution solution = SolveRobertson({});
  EXPECT_NEAR(solution.state[0], 0.7158270688, 1e-8);
  EXPECT_NEAR(solution.state[1], 0.9185534765e-5, 1e-12);
  EXPECT_NEAR(solution.state.sum(), 1, 1e-12);
}

TEST(OdeIntegrator, GuardsFireInTheirDirectionOnly) {
  const auto value = [](double, State x, Output values) { values[0] = x[0]; };
  const double pi = std::numbers::pi;
  const auto crossing = [&](GuardDirection direction) {
    return Integrate(Watching(Oscillator(20), {{direction}}, value), Accurate());
  };
  EXPECT_NEAR(crossing(GuardDirection::kFalling).time, pi / 2, 1e-10);
  EXPECT_NEAR(crossing(GuardDirection::kRising).time, 3 * pi / 2, 1e-10);
  EXPECT_NEAR(crossing(GuardDirection::kBoth).time, pi / 2, 1e-10);
  const OdeSolution solution = crossing(GuardDirection::kFalling);
  EXPECT_EQ(solution.end, OdeEnd::kGuard);
  EXPECT_EQ(solution.guards, std::vector<int>{0});
  EXPECT_EQ(solution.trajectory.end_time(), solution.time);
  EXPECT_LE(solution.state[0], 0);
  EXPECT_GT(solution.state[0], -1e-14);
}

TEST(OdeIntegrator, TheFirstOfManyGuardsEndsTheIntegration) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> uniform(-0.99, 0.99);
  for (int trial = 0; trial < 100; ++trial) {
    Eigen::VectorXd levels(5);
    for (double& level : levels) level = uniform(random);
    const auto values = [&levels](double, State x, Output out) {
      out = (x[0] - levels.array()).matrix();
    };
    const OdeSolution solution =
        Integrate(Watching(Oscillator(10), std::vector<OdeGuard>(5), values), Accurate());
    Eigen::Index highest = 0;
    EXPECT_NEAR(solution.time, std::acos(levels.maxCoeff(&highest)), 1e-9);
    EXPECT_EQ(solution.guards.front(), highest);
  }
}

TEST(OdeIntegrator, TwoGuardsAtOnceAreBothReported) {
  const auto values = [](double t, State x, Output out) {
    out << x[0], std::numbers::pi / 2 - t, x[0] + 0.5;
  };
  const OdeSolution solution = Integrate(
      Watching(Oscillator(10), std::vector<OdeGuard>(3, {GuardDirection::kFalling}), values),
      Accurate(1e-12));
  EXPECT_EQ(solution.guards, (std::vector<int>{0, 1}));
  EXPECT_NEAR(solution.time, std::numbers::pi / 2, 1e-9);
}

TEST(OdeIntegrator, AGuardThatStartsAtZeroFiresAtItsNextCrossing) {
  // sin t falls at pi, not at 0 where it starts.
  const auto value = [](double, State x, Output out) { out[0] = -x[1]; };
  const OdeSolution solution =
      Integrate(Watching(Oscillator(10), {{GuardDirection::kFalling}}, value), Accurate());
  EXPECT_NEAR(solution.time, std::numbers::pi, 1e-10);
}

TEST(OdeIntegrator, AGuardThatLeavesZeroInItsDirectionFiresAtOnceIfSet) {
  const auto value = [](double, State x, Output out) { out[0] = x[1]; };  // -sin t
  OdeProblem problem = Watching(Oscillator(10), {{GuardDirection::kFalling}}, value);
  const OdeSolution at_once = Integrate(problem, Accurate());
  EXPECT_EQ(at_once.end, OdeEnd::kGuard);
  EXPECT_LT(at_once.time, 1e-10);
  EXPECT_LT((at_once.state - problem.start).norm(), 1e-10);
  problem.guards[0].fires_from_zero = false;
  EXPECT_NEAR(Integrate(problem, Accurate()).time, 2 * std::numbers::pi, 1e-10);
}

TEST(OdeIntegrator, AGuardWithinAZeroOfItsOwnFiresWhereItLeavesThat) {
  constexpr double kZero = 0.01;
  // From 0.004 inside, sin t falls through -kZero.
  const auto falls = [](double, State x, Output out) { out[0] = x[1] + 0.004; };
  OdeProblem problem = Watching(Oscillator(10), {{GuardDirection::kFalling}}, falls);
  problem.guards[0].zero = kZero;
  EXPECT_NEAR(Integrate(problem, Accurate()).time, std::asin(kZero + 0.004), 1e-10);
  // Once it has risen above kZero, it fires at zero.
  const auto rises = [](double, State x, Output out) { out[0] = -x[1] - 0.004; };
  problem.guard_values = rises;
  EXPECT_NEAR(Integrate(problem, Accurate()).time, std::numbers::pi - std::asin(0.004), 1e-10);
  problem.guards[0].fires_from_zero = false;
  problem.guard_values = falls;
  EXPECT_NEAR(Integrate(problem, Accurate()).time, 2 * std::numbers::pi + std::asin(0.004), 1e-10);
}

TEST(OdeIntegrator, ACrossingWithinTheFirstStepIsFound) {
  // A throw of 0.2 milliseconds, which is over before the first step at these tolerances ends.
  OdeProblem problem;
  problem.rate = [](double, State x, Output rate) { rate << x[1], -10; };
  problem.start = Eigen::Vector2d(0, 1e-3);
  problem.end_time = 1;
  const OdeSolution solution =
      Integrate(Watching(problem, {{GuardDirection::kFalling}},
                         [](double, State x, Output out) { out[0] = x[0]; }),
                Accurate(1e-4));
  EXPECT_EQ(solution.end, OdeEnd::kGuard);
  EXPECT_LT(solution.time, 0.01);
  EXPECT_LT(std::abs(solution.state[0]), 1e-11);
}

TEST(OdeIntegrator, AGuardThatStartsBelowZeroFiresAfterItHasRisen) {
  const auto value = [](double, State x, Output out) { out[0] = x[0] - 2 + x[1] * 1.9; };
  // cos t - 1.9 sin t - 2 starts at -1 and crosses twice per turn.
  const OdeSolution solution =
      Integrate(Watching(Oscillator(10), {{GuardDirection::kFalling}}, value), Accurate());
  const double amplitude = std::hypot(1, 1.9), shift = std::atan2(1.9, 1);
  EXPECT_NEAR(solution.time, std::acos(2 / amplitude) - shift + 2 * std::numbers::pi, 1e-9);
}

TEST(OdeIntegrator, AGuardThatStartsBelowZeroFiresAtOnceIfItStaysThereAndIsSetTo) {
  const auto value = [](double, State x, Output out) { out[0] = x[1] - 1e-4; };  // -sin t - 1e-4
  OdeProblem problem = Watching(Oscillator(10), {{GuardDirection::kFalling}}, value);
  EXPECT_GT(Integrate(problem, Accurate()).time, 3);
  problem.guards[0].beyond_is_zero = true;
  const OdeSolution at_once = Integrate(problem, Accurate());
  EXPECT_EQ(at_once.end, OdeEnd::kGuard);
  EXPECT_EQ(at_once.time, 0);
  EXPECT_EQ(at_once.state, problem.start);
}

TEST(OdeIntegrator, AGuardThatRisesFromBelowZeroAtOnceDoesNotFireThere) {
  const auto value = [](double, State x, Output out) { out[0] = -x[1] - 1e-30; };  // sin t - 1e-30
  OdeProblem problem = Watching(Oscillator(10), {{GuardDirection::kFalling}}, value);
  problem.guards[0].beyond_is_zero = true;
  OdeSettings settings = Accurate();
  settings.guard_zero = 0;
  EXPECT_NEAR(Integrate(problem, settings).time, std::numbers::pi, 1e-9);
}

TEST(OdeIntegrator, AGuardEvaluatedAloneGivesTheSameBytes) {
  const auto values = [](double t, State x, Output out) {
    out << x[0] - 0.3, x[1] + 0.2 * t, x[0] * x[1] - 0.4;
  };
  OdeProblem problem = Watching(
      Oscillator(10),
      {{GuardDirection::kFalling}, {GuardDirection::kRising}, {GuardDirection::kBoth}}, values);
  const OdeSolution all = Integrate(problem, Accurate());
  int calls = 0;
  problem.guard_value = [&](double t, State x, int guard) {
    ++calls;
    Eigen::VectorXd out(3);
    values(t, x, out);
    return out[guard];
  };
  const OdeSolution alone = Integrate(problem, Accurate());
  EXPECT_GT(calls, 0);
  EXPECT_EQ(alone.time, all.time);
  EXPECT_EQ(alone.state, all.state);
  EXPECT_EQ(alone.guards, all.guards);
  problem.guard_value = [](double, State, int) { return std::nan(""); };
  EXPECT_THROW(Integrate(problem, Accurate()), OdeError);
}

/// Guards are looked at more rarely than steps are taken.
TEST(OdeIntegrator, GuardsCrossedInEarlierStepsFireAtTheirTime) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-0.9, 0.9);
  OdeSettings settings = Accurate();
  settings.max_step = 1;
  settings.guard_samples = 2;
  for (int trial = 0; trial < 100; ++trial) {
    const double level = uniform(random);
    const auto value = [level](double, State x, Output out) { out[0] = x[0] - level; };
    const OdeSolution solution =
        Integrate(Watching(Oscillator(10), {{GuardDirection::kFalling}}, value), settings);
    EXPECT_NEAR(solution.time, std::acos(level), 1e-9);
    EXPECT_NEAR(solution.state[0], level, 1e-9);
    EXPECT_EQ(solution.trajectory.end_time(), solution.time);
    EXPECT_EQ(solution.trajectory.StepTimes().back(), solution.time);
  }
}

/// Where a guard ends the motion, what would happen behind it does not matter.
TEST(OdeIntegrator, AStepThatFailsBehindAGuardIsNoFailure) {
  OdeSettings settings = Accurate();
  settings.max_step = 1;
  settings.guard_samples = 1;
  for (double level = 0.5; level > -0.5; level -= 0.01) {
    OdeProblem problem = Oscillator(10);
    problem.rate = [level](double, State x, Output rate) {
      if (x[0] < level - 0.1) throw std::runtime_error("behind the guard");
      rate << x[1], -x[0];
    };
    const auto value = [level](double, State x, Output out) { out[0] = x[0] - level; };
    const OdeSolution solution =
        Integrate(Watching(problem, {{GuardDirection::kFalling}}, value), settings);
    EXPECT_EQ(solution.end, OdeEnd::kGuard);
    EXPECT_NEAR(solution.time, std::acos(level), 1e-9);
    EXPECT_THROW(Integrate(problem, settings), std::runtime_error);
  }
}

TEST(OdeIntegrator, GuardThatStaysZeroNeverFires) {
  const auto value = [](double, State, Output out) { out[0] = 0; };
  EXPECT_EQ(Integrate(Watching(Oscillator(3), {{GuardDirection::kBoth}}, value)).end,
            OdeEnd::kTime);
}

TEST(OdeIntegrator, CancellationEndsTheIntegration) {
  int asked = 0;
  OdeSettings settings = Accurate();
  settings.cancellation = CancellationToken([&asked] { return ++asked <= 10; });
  const OdeSolution solution = Integrate(Oscillator(1000), settings);
  EXPECT_EQ(solution.end, OdeEnd::kCancelled);
  EXPECT_EQ(solution.statistics.steps, 10);
  EXPECT_EQ(solution.trajectory.end_time(), solution.time);
  EXPECT_NEAR(solution.state[0], std::cos(solution.time), 1e-9);
  settings.cancellation = CancellationToken([] { return false; });
  EXPECT_EQ(Integrate(Oscillator(1000), settings).time, 0);
}

TEST(OdeIntegrator, MaximumStepsNameTheTimeReached) {
  OdeSettings settings = Accurate();
  settings.max_steps = 20;
  try {
    Integrate(Oscillator(1000), settings);
    FAIL() << "20 steps cannot be enough";
  } catch (const OdeError& error) {
    EXPECT_GT(error.time(), 0);
    EXPECT_LT(error.time(), 100);
    EXPECT_NE(std::string(error.what()).find("20 steps taken before t = 1000"), std::string::npos)
        << error.what();
  }
}

TEST(OdeIntegrator, MaximumStepIsObeyed) {
  OdeSettings settings;
  settings.max_step = 0.01;
  const std::vector<double> times = Integrate(Oscillator(1), settings).trajectory.StepTimes();
  ASSERT_GT(times.size(), 100);
  for (size_t i = 1; i < times.size(); ++i) EXPECT_LE(times[i] - times[i - 1], 0.01 + 1e-12);
}

TEST(OdeIntegrator, ARateThatIsNotFiniteIsNamedWithItsComponent) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  OdeProblem problem = Oscillator(10);
  problem.rate = [nan](double t, State x, Output rate) { rate << x[1], t > 1 ? nan : -x[0]; };
  try {
    Integrate(problem, Accurate());
    FAIL() << "integrated NaN";
  } catch (const OdeError& error) {
    EXPECT_EQ(error.component(), 1);
    EXPECT_NEAR(error.time(), 1, 0.1);
    EXPECT_NE(std::string(error.what()).find("component 1 is not finite"), std::string::npos)
        << error.what();
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
  }
  problem.rate = [nan](double, State, Output rate) { rate << nan, 0; };
  EXPECT_NE(ErrorOf(problem).find("component 0 is not finite"), std::string::npos);
}

TEST(OdeIntegrator, ARateThatIsNotFiniteOutsideItsDomainIsIntegrated) {
  // x' = -sqrt(x) reaches 0 at t = 2 and is NaN below. A shorter step stays in the domain.
  OdeProblem problem;
  problem.rate = [](double, State x, Output rate) { rate[0] = -std::sqrt(x[0]); };
  problem.start = VectorXd::Constant(1, 1);
  problem.end_time = 1.999;
  EXPECT_NEAR(Integrate(problem, Accurate(1e-10)).state[0], 0.25e-6, 1e-8);
}

TEST(OdeIntegrator, AGuardThatIsNotFiniteIsNamed) {
  const auto value = [](double t, State, Output out) { out[0] = t > 0.5 ? NAN : 1; };
  EXPECT_NE(ErrorOf(Watching(Oscillator(1), {OdeGuard()}, value)).find("guard 0 is not finite"),
            std::string::npos);
}

TEST(OdeIntegrator, FiniteTimeBlowUpEndsInAnError) {
  OdeProblem problem;
  problem.rate = [](double, State x, Output rate) { rate << 1, x[1] * x[1]; };
  problem.start = Eigen::Vector2d(0, 1);
  problem.end_time = 2;
  try {
    Integrate(problem, Accurate());
    FAIL() << "integrated through infinity";
  } catch (const OdeError& error) {
    EXPECT_NEAR(error.time(), 1, 1e-3) << error.what();
    EXPECT_EQ(error.component(), 1) << error.what();
  }
}

struct Unusual {
  int value;
};

TEST(OdeIntegrator, ExceptionsPassThrough) {
  for (const OdeMethod method : {OdeMethod::kAdams, OdeMethod::kBdf}) {
    OdeSettings settings;
    settings.method = method;
    OdeProblem problem = Oscillator(10);
    problem.rate = [](double t, State x, Output rate) {
      if (t > 2) throw Unusual{42};
      rate << x[1], -x[0];
    };
    try {
      Integrate(problem, settings);
      FAIL() << "the exception was lost";
    } catch (const Unusual& unusual) {
      EXPECT_EQ(unusual.value, 42);
    }
  }
  const auto guard = [](double t, State, Output values) {
    if (t > 1) throw Unusual{7};
    values[0] = 1;
  };
  EXPECT_THROW(Integrate(Watching(Oscillator(3), {OdeGuard()}, guard)), Unusual);
  OdeSettings settings;
  settings.cancellation = CancellationToken([]() -> bool { throw Unusual{8}; });
  EXPECT_THROW(Integrate(Oscillator(3), settings), Unusual);
}

TEST(OdeIntegrator, AnIntervalOfNoOrVeryShortTimeEndsAtItsEnd) {
  const OdeSolution solution = Integrate(Oscillator(0));
  EXPECT_EQ(solution.end, OdeEnd::kTime);
  EXPECT_EQ(solution.state, Eigen::Vector2d(1, 0));
  EXPECT_EQ(solution.trajectory.State(0), Eigen::Vector2d(1, 0));
  OdeProblem rounding = Oscillator(1 + 1e-16);
  rounding.start_time = 1;
  EXPECT_EQ(Integrate(rounding).time, rounding.end_time);
  rounding.end_time = std::nextafter(1.0, 2.0);
  EXPECT_EQ(Integrate(rounding).time, rounding.end_time);
  EXPECT_EQ(Integrate(rounding).trajectory.end_time(), rounding.end_time);
  rounding.end_time = 1 + 1e-13;
  EXPECT_EQ(Integrate(rounding).time, rounding.end_time);
}

TEST(OdeIntegrator, InvalidArgumentsAreRefused) {
  const auto rejected = [](auto change) {
    OdeProblem problem = Oscillator(1);
    OdeSettings settings;
    change(problem, settings);
    EXPECT_THROW(Integrate(problem, settings), std::invalid_argument);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  rejected([](OdeProblem& p, OdeSettings&) { p.rate = nullptr; });
  rejected([](OdeProblem& p, OdeSettings&) { p.start.resize(0); });
  rejected([&](OdeProblem& p, OdeSettings&) { p.start[1] = nan; });
  rejected([](OdeProblem& p, OdeSettings&) { p.end_time = -1; });
  rejected([&](OdeProblem& p, OdeSettings&) { p.end_time = nan; });
  rejected([](OdeProblem& p, OdeSettings&) { p.end_time = INFINITY; });
  rejected([](OdeProblem& p, OdeSettings&) { p.guards.resize(1); });
  rejected([](OdeProblem& p, OdeSettings&) { p.positions = -1; });
  rejected([](OdeProblem& p, OdeSettings&) { p.positions = 3; });
  rejected([](OdeProblem&, OdeSettings& s) { s.relative_tolerance = 0; });
  rejected([](OdeProblem&, OdeSettings& s) { s.relative_tolerance = 1; });
  rejected([&](OdeProblem&, OdeSettings& s) { s.absolute_tolerance = nan; });
  rejected([](OdeProblem&, OdeSettings& s) { s.absolute_tolerances = VectorXd::Ones(3); });
  rejected([](OdeProblem&, OdeSettings& s) { s.absolute_tolerances = VectorXd::Zero(2); });
  rejected([](OdeProblem& p, OdeSettings&) {
    p = Watching(p, {{}}, [](double, State x, Output out) { out[0] = x[0]; });
    p.guards[0].zero = -1;
  });
  rejected([](OdeProblem&, OdeSettings& s) { s.max_step = 0; });
  rejected([](OdeProblem&, OdeSettings& s) { s.max_steps = 0; });
  rejected([](OdeProblem&, OdeSettings& s) { s.guard_samples = 0; });
  rejected([](OdeProblem&, OdeSettings& s) { s.simultaneous = -1; });
  rejected([&](OdeProblem&, OdeSettings& s) { s.guard_zero = nan; });
  EXPECT_THROW(Integrate(Oscillator(1)).trajectory.State(1.1), std::invalid_argument);
  EXPECT_THROW(Integrate(Oscillator(1)).trajectory.State(-0.1), std::invalid_argument);
}

TEST(OdeIntegrator, TheSameProblemGivesTheSameBytes) {
  const OdeSolution first = Integrate(Oscillator(30)), second = Integrate(Oscillator(30));
  EXPECT_EQ(first.state, second.state);
  EXPECT_EQ(first.trajectory.StepTimes(), second.trajectory.StepTimes());
}

}  // namespace
}  // namespace possibility::dynamics
