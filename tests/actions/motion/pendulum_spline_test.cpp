#include "actions/motion/pendulum_spline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

namespace possibility::actions {
namespace {

using Eigen::VectorXd;

constexpr double kStiffness = 12;  // 1/s^2

/// What a spline is made of. The zero moment point may change in the first and the last quarter.
struct Problem {
  Problem(int steps, double duration) : Problem(VectorXd::LinSpaced(steps + 1, 0, duration)) {}

  explicit Problem(const VectorXd& knots)
      : times(knots), zmp(knots.size()), first(knots.size()), last(knots.size()) {
    const double quarter = duration() / 4;
    for (int i = 0; i <= steps(); ++i) {
      const double t = times[i];
      zmp[i] = 0;
      first[i] = t < quarter ? Bump(t, quarter).value : 0;
      last[i] = t > duration() - quarter ? Bump(t - duration() + quarter, quarter).value : 0;
    }
  }

  int steps() const { return static_cast<int>(zmp.size()) - 1; }
  double duration() const { return times[steps()]; }
  PendulumSpline Spline() const { return {times, zmp, from, to, kStiffness, first, last}; }

  VectorXd times;  // s
  double from = 0;
  double to = 0;
  VectorXd zmp, first, last;
};

class PendulumSplineTest : public ::testing::Test {
 protected:
  double Random() { return std::uniform_real_distribution<double>(-1, 1)(generator_); }

  /// Its steps differ by up to a factor of five.
  Problem RandomProblem() {
    VectorXd times(17 + generator_() % 100);
    times[0] = 0;
    for (Eigen::Index i = 1; i < times.size(); ++i) times[i] = times[i - 1] + 3 + 2 * Random();
    times *= (1.5 + Random()) / times[times.size() - 1];
    Problem problem(times);
    problem.from = Random();
    problem.to = Random();
    for (double& p : problem.zmp) p = Random();
    return problem;
  }

  static constexpr int kTrials = 50;
  std::mt19937 generator_{3};
};

TEST_F(PendulumSplineTest, EndsAreAtTheGivenValuesAndAtRest) {
  for (int trial = 0; trial < kTrials; ++trial) {
    const Problem problem = RandomProblem();
    const PendulumSpline spline = problem.Spline();
    EXPECT_NEAR(spline.At(0).value, problem.from, 1e-12);
    EXPECT_NEAR(spline.At(0).rate, 0, 1e-10);
    EXPECT_NEAR(spline.At(problem.duration()).value, problem.to, 1e-12);
    EXPECT_NEAR(spline.At(problem.duration()).rate, 0, 1e-10);
  }
}

TEST_F(PendulumSplineTest, CurvatureAtKnotsIsThatOfThePendulum) {
  constexpr double kShort = 1e-7;
  for (int trial = 0; trial < kTrials; ++trial) {
    const Problem problem = RandomProblem();
    const PendulumSpline spline = problem.Spline();
    for (int i = 1; i < problem.steps(); ++i) {
      if (problem.first[i] != 0 || problem.last[i] != 0) continue;
      const double t = problem.times[i];
      const double curvature =
          (spline.At(t + kShort).rate - spline.At(t - kShort).rate) / (2 * kShort);
      EXPECT_NEAR(curvature, kStiffness * (spline.At(t).value - problem.zmp[i]), 1e-3);
      EXPECT_NEAR(spline.Zmp(i), problem.zmp[i], 1e-12);
    }
  }
}

TEST_F(PendulumSplineTest, ZeroMomentPointChangesByAMultipleOfEachBump) {
  for (int trial = 0; trial < kTrials; ++trial) {
    const Problem problem = RandomProblem();
    const PendulumSpline spline = problem.Spline();
    for (const VectorXd& bump : {problem.first, problem.last}) {
      Eigen::Index peak = 0;
      bump.maxCoeff(&peak);
      const auto change = [&](Eigen::Index i) {
        return spline.Zmp(static_cast<int>(i)) - problem.zmp[i];
      };
      const double share = change(peak) / bump[peak];
      for (Eigen::Index i = 0; i < bump.size(); ++i) {
        if (bump[i] == 0) continue;
        EXPECT_NEAR(change(i), share * bump[i], 1e-9 * (1 + std::abs(share)));
      }
    }
  }
}

TEST_F(PendulumSplineTest, RateAndAccelerationAreTheDerivativesOfTheValue) {
  constexpr double kShort = 1e-5;
  for (int trial = 0; trial < kTrials; ++trial) {
    const Problem problem = RandomProblem();
    const PendulumSpline spline = problem.Spline();
    for (int i = 0; i < problem.steps(); ++i) {
      const double share = 0.5 + 0.4 * Random();
      const double t = (1 - share) * problem.times[i] + share * problem.times[i + 1];
      const ScalarSignal before = spline.At(t - kShort);
      const ScalarSignal after = spline.At(t + kShort);
      const ScalarSignal now = spline.At(t);
      EXPECT_NEAR(now.rate, (after.value - before.value) / (2 * kShort), 1e-6);
      EXPECT_NEAR(now.acceleration, (after.rate - before.rate) / (2 * kShort), 1e-6);
    }
  }
}

TEST_F(PendulumSplineTest, ValueRateAndAccelerationAreContinuousAcrossKnots) {
  constexpr double kShort = 1e-10;
  for (int trial = 0; trial < kTrials; ++trial) {
    const Problem problem = RandomProblem();
    const PendulumSpline spline = problem.Spline();
    for (int i = 1; i < problem.steps(); ++i) {
      const ScalarSignal before = spline.At(problem.times[i] - kShort);
      const ScalarSignal after = spline.At(problem.times[i] + kShort);
      EXPECT_NEAR(before.value, after.value, 1e-8);
      EXPECT_NEAR(before.rate, after.rate, 1e-7);
      EXPECT_NEAR(before.acceleration, after.acceleration, 1e-5);
    }
  }
}

TEST_F(PendulumSplineTest, StaysWhereItIsOverAConstantZeroMomentPoint) {
  Problem problem(50, 2);
  problem.from = problem.to = 0.7;
  problem.zmp.setConstant(0.7);
  const PendulumSpline spline = problem.Spline();
  for (double t = 0; t <= problem.duration(); t += 0.01) {
    EXPECT_NEAR(spline.At(t).value, 0.7, 1e-13);
    EXPECT_NEAR(spline.At(t).rate, 0, 1e-12);
    EXPECT_NEAR(spline.At(t).acceleration, 0, 1e-11);
  }
}

TEST_F(PendulumSplineTest, MovesWithItsProblem) {
  for (int trial = 0; trial < kTrials; ++trial) {
    const Problem problem = RandomProblem();
    Problem moved = problem;
    const double shift = Random();
    moved.zmp.array() += shift;
    moved.from += shift;
    moved.to += shift;
    const PendulumSpline spline = problem.Spline();
    const PendulumSpline moved_spline = moved.Spline();
    for (int i = 0; i < 20; ++i) {
      const double t = problem.duration() * i / 20;
      EXPECT_NEAR(moved_spline.At(t).value, spline.At(t).value + shift, 1e-11);
    }
  }
}

TEST_F(PendulumSplineTest, IsTheSameBackwardsInTime) {
  for (int trial = 0; trial < kTrials; ++trial) {
    const Problem problem = RandomProblem();
    Problem mirrored = problem;
    mirrored.times = problem.duration() - problem.times.reverse().array();
    mirrored.zmp = problem.zmp.reverse();
    mirrored.first = problem.last.reverse();
    mirrored.last = problem.first.reverse();
    std::swap(mirrored.from, mirrored.to);
    const PendulumSpline spline = problem.Spline();
    const PendulumSpline mirrored_spline = mirrored.Spline();
    for (int i = 0; i < 20; ++i) {
      const double t = problem.duration() * i / 20;
      EXPECT_NEAR(mirrored_spline.At(problem.duration() - t).value, spline.At(t).value, 1e-10);
    }
  }
}

/// The zero moment point of a known motion from rest to rest.
double ErrorOfKnownMotion(int steps) {
  Problem problem(steps, 1.6);
  const auto known = [&](double t) { return Blend(0.2, 0.9, RestToRest(t, problem.duration())); };
  problem.from = 0.2;
  problem.to = 0.9;
  for (int i = 0; i <= steps; ++i) {
    const ScalarSignal c = known(problem.times[i]);
    problem.zmp[i] = c.value - c.acceleration / kStiffness;
  }
  const PendulumSpline spline = problem.Spline();
  double error = 0;
  for (double t = 0; t < problem.duration(); t += 0.003) {
    error = std::max(error, std::abs(spline.At(t).value - known(t).value));
  }
  return error;
}

TEST_F(PendulumSplineTest, ConvergesToAKnownMotionWithTheSquareOfTheStep) {
  EXPECT_LT(ErrorOfKnownMotion(80), 1e-3);
  for (const int steps : {40, 80, 160}) {
    EXPECT_GT(std::log2(ErrorOfKnownMotion(steps) / ErrorOfKnownMotion(2 * steps)), 1.9) << steps;
  }
}

/// Distance of the spline over a constant zero moment point, in the middle half, from the
/// pendulum's closed form A cosh + B sinh through the ends of that half.
double ErrorOfFall(int steps) {
  constexpr double kPoint = 0.3;
  Problem problem(steps, 2);
  problem.from = 0;
  problem.to = 0.8;
  for (int i = 0; i <= steps; ++i) {
    const double t = problem.times[i];
    problem.zmp[i] = t < 1 ? Blend(0, kPoint, RestToRest(t, 0.5)).value
                           : Blend(kPoint, 0.8, RestToRest(t - 1.5, 0.5)).value;
  }
  const PendulumSpline spline = problem.Spline();
  const double root = std::sqrt(kStiffness);
  const double a = spline.At(0.5).value - kPoint;
  const double b = (spline.At(1.5).value - kPoint - a * std::cosh(root)) / std::sinh(root);
  double error = 0;
  for (double t = 0.5; t <= 1.5; t += 0.01) {
    const double fall = root * (t - 0.5);
    const double closed_form = kPoint + a * std::cosh(fall) + b * std::sinh(fall);
    error = std::max(error, std::abs(spline.At(t).value - closed_form));
  }
  return error;
}

TEST_F(PendulumSplineTest, ConvergesToThePendulumsClosedFormWithTheSquareOfTheStep) {
  EXPECT_LT(ErrorOfFall(80), 1e-3);
  for (const int steps : {40, 80, 160}) {
    EXPECT_GT(std::log2(ErrorOfFall(steps) / ErrorOfFall(2 * steps)), 1.9) << steps;
  }
}

}  // namespace
}  // namespace possibility::actions
