// The known optima of the suite, from formulas, and from simulation where only switching times are
// known.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "experiments/problems/regression_problems.h"

namespace possibility::experiments {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kDigits = 1e-12;

double Known(const std::string& name, int which = 0) {
  for (const RegressionProblem& problem : RegressionProblems()) {
    if (problem.name == name) return problem.optima.at(which).objective;
  }
  ADD_FAILURE() << "no problem " << name;
  return 0;
}

/// Between a and b, where f has different signs.
double RootBetween(double a, double b, const std::function<double(double)>& f) {
  const bool rises = f(b) > 0;
  for (int i = 0; i < 200; ++i) {
    const double middle = (a + b) / 2;
    ((f(middle) > 0) == rises ? b : a) = middle;
  }
  return (a + b) / 2;
}

TEST(KnownOptima, OfTheCalculusOfVariations) {
  const double a = 0.5, b = 0.9;
  EXPECT_NEAR(Known("great_circle"),
              std::acos(std::sin(a) * std::sin(b) + std::cos(a) * std::cos(b) * std::cos(2)),
              kDigits);
  const double c = RootBetween(0.6, 1, [](double r) { return r * std::cosh(0.5 / r) - 1; });
  EXPECT_NEAR(Known("soap_film"), kPi * c * (1 + c * std::sinh(1 / c)), kDigits);
  EXPECT_NEAR(Known("dido"), -kPi / 8, kDigits);
  EXPECT_NEAR(Known("slide_to_a_wall"), std::sqrt(kPi * 2 / 9.80665), kDigits);
}

TEST(KnownOptima, OfRefractionBySnellsLaw) {
  const double x = RootBetween(0, 2, [](double at) {
    return 0.6 * at / std::hypot(at, 1) - (2 - at) / std::hypot(2 - at, 1);
  });
  EXPECT_NEAR(Known("refraction"), std::hypot(x, 1) + std::hypot(2 - x, 1) / 0.6, kDigits);
}

/// The tangent of the heading is s + t.
TEST(KnownOptima, OfZermelosShip) {
  const auto end_of = [](double s) { return std::sqrt(std::pow(std::hypot(1, s) - 1.86, 2) - 1); };
  const auto x_at_end = [&](double s) {
    const double e = end_of(s);
    const auto integral = [](double q) { return 0.5 * (q * std::hypot(1, q) - std::asinh(q)); };
    return 3.66 + integral(e) - integral(s) + (1.86 - std::hypot(1, s)) * (e - s);
  };
  const double s = RootBetween(-5, -3, x_at_end);
  EXPECT_NEAR(Known("zermelo"), end_of(s) - s, kDigits);
}

TEST(KnownOptima, OfTheWayRoundADisc) {
  const double distance = std::hypot(1, 0.2);
  const double tangent = std::sqrt(distance * distance - 0.25);
  const double arc = kPi - 2 * std::atan(0.2) - 2 * std::acos(0.5 / distance);
  EXPECT_NEAR(Known("round_a_disc"), 2 * tangent + 0.5 * arc, kDigits);
}

TEST(KnownOptima, OfLinearSystems) {
  const auto segment = [](double a, double b, double t) {
    return ((a * a + b * b) * std::cosh(t) - 2 * a * b) / std::sinh(t);
  };
  EXPECT_NEAR(Known("interior_point"), segment(1, 0.9, 0.75) + segment(0.9, 0.75, 0.25), kDigits);
  EXPECT_NEAR(Known("hager"), std::tanh(1) / 2, kDigits);
}

/// u = 4 t until 3/8 s, then a straight line, such that the end is met.
TEST(KnownOptima, OfALimitedRate) {
  const double t = 0.375, u = 4 * t, rest = 2 - t;
  const double speed = u * t / 2, place = u * t * t / 6;  // at the corner
  const double slope = -2 * (speed + u * rest) / (rest * rest);
  EXPECT_NEAR(place + speed * rest + u * rest * rest / 2 + slope * std::pow(rest, 3) / 6, 1,
              kDigits);
  const double end = u + slope * rest;
  EXPECT_NEAR(Known("limited_rate"), u * u * t / 3 + rest * (u * u + u * end + end * end) / 3,
              kDigits);
}

TEST(KnownOptima, OfSwitchedSecondOrderSystems) {
  EXPECT_NEAR(Known("oscillator"), std::acos(7.0 / 8) + std::acos(0.25), kDigits);
  EXPECT_NEAR(Known("least_fuel"), 3 - std::sqrt(5), kDigits);
}

/// The integral of (x + v t + a t^2 / 2)^2.
double SquareOfParabola(double x, double v, double a, double t) {
  return x * x * t + x * v * t * t + (v * v + x * a) * std::pow(t, 3) / 3 +
         v * a * std::pow(t, 4) / 4 + a * a * std::pow(t, 5) / 20;
}

/// Switches at x = -C v |v|. Each arc is the one before, smaller by r in speed.
TEST(KnownOptima, OfFullersProblem) {
  const double C = std::sqrt((std::sqrt(33) - 1) / 24);
  const double w = 1 / std::sqrt(1 + 2 * C);
  const double r = std::sqrt((0.5 - C) / (0.5 + C));
  const double first = SquareOfParabola(0, 1, -1, 1 + w);
  const double second = SquareOfParabola(C * w * w, -w, 1, w + w * r);
  EXPECT_NEAR(Known("fuller"), first + second / (1 - std::pow(r, 5)), kDigits);
}

/// u = -1 until the costate allows x'' = x, which ends at rest.
TEST(KnownOptima, OfTheSingularRegulator) {
  const auto place = [](double t) { return t - t * t / 2; };
  const double t =
      RootBetween(1.1, 1.9, [&](double s) { return 1 - s + place(s) * std::tanh(5 - s); });
  const double amplitude = place(t) / std::cosh(5 - t);
  const double arc = SquareOfParabola(0, 1, -1, t) + (1 - std::pow(1 - t, 3)) / 3;
  const double rest = amplitude * amplitude * std::sinh(2 * (5 - t)) / 2;
  EXPECT_NEAR(Known("singular_regulator"), (arc + rest) / 2, kDigits);
}

/// tan(angle) = k (1 - 2 t).
TEST(KnownOptima, OfTheFastestInsertion) {
  const double k = RootBetween(0.1, 10, [](double q) {
    return 5 / (4 * q * q) * (q * std::hypot(1, q) - std::asinh(q)) - 1;
  });
  EXPECT_NEAR(Known("fastest_insertion"), -5 * std::asinh(k) / k, kDigits);
}

TEST(KnownOptima, OfAThrow) {
  const double v = 3, g = 9.80665;
  EXPECT_NEAR(Known("longest_throw"), -v / g * std::sqrt(v * v + 2 * g * 0.2), kDigits);
}

/// Free fall for t, then full thrust until the speed is zero: at height zero.
TEST(KnownOptima, OfTheMoonLander) {
  const double exhaust = 2.349, flow = 1.227 / exhaust;
  const auto burn = [&](double speed) {
    return RootBetween(0.1, 1.6,
                       [&](double s) { return speed - s - exhaust * std::log(1 - flow * s); });
  };
  const auto height = [&](double t) {
    const double v = -0.783 - t, s = burn(v), share = 1 - flow * s;
    return 1 - 0.783 * t - t * t / 2 + v * s - s * s / 2 +
           exhaust * (share * std::log(share) / flow + s);
  };
  const double t = RootBetween(0, 0.4, height);
  EXPECT_NEAR(Known("moon_lander"), 1.227 * burn(-0.783 - t), kDigits);
}

template <std::size_t N>
using State = std::array<double, N>;

/// Runge and Kutta's rule of order 4 with steps of about 1 ms.
template <std::size_t N, typename Rates>
State<N> Simulate(State<N> y, double duration, const Rates& rates) {
  const int steps = static_cast<int>(duration * 1000) + 1;
  const double h = duration / steps;
  const auto moved = [](State<N> at, double s, const State<N>& rate) {
    for (std::size_t i = 0; i < N; ++i) at[i] += s * rate[i];
    return at;
  };
  for (int step = 0; step < steps; ++step) {
    const State<N> k1 = rates(y), k2 = rates(moved(y, h / 2, k1));
    const State<N> k3 = rates(moved(y, h / 2, k2)), k4 = rates(moved(y, h, k3));
    for (std::size_t i = 0; i < N; ++i) y[i] += h / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
  }
  return y;
}

struct Arc {
  double until;
  std::array<double, 3> controls;
};

template <std::size_t N, typename Rates>
State<N> SimulateArcs(State<N> y, const std::vector<Arc>& arcs, const Rates& rates) {
  double time = 0;
  for (const Arc& arc : arcs) {
    y = Simulate(y, arc.until - time, [&](const State<N>& at) { return rates(at, arc.controls); });
    time = arc.until;
  }
  return y;
}

State<4> TwoLinkRates(const State<4>& y, const std::array<double, 3>& u) {
  const double s = std::sin(y[2]), c = std::cos(y[2]), d = 31.0 / 36 + 9.0 / 4 * s * s;
  const double a = s * (9.0 / 4 * c * y[0] * y[0] + 2 * y[1] * y[1]) + 4.0 / 3 * (u[0] - u[1]) -
                   3.0 / 2 * c * u[1];
  const double b = -(s * (7.0 / 2 * y[0] * y[0] + 9.0 / 4 * c * y[1] * y[1]) - 7.0 / 3 * u[1] +
                     3.0 / 2 * c * (u[0] - u[1]));
  return {a / d, b / d, y[1] - y[0], y[0]};
}

TEST(KnownOptima, OfTheTwoLinkArmByItsSwitchingTimes) {
  const std::vector<Arc> best = {{0.9431403548644, {1, 1}},
                                 {1.4911399712748, {1, -1}},
                                 {2.6275450667618, {-1, -1}},
                                 {Known("two_link_arm"), {-1, 1}}};
  const std::vector<Arc> other = {{0.3732945139848, {1, -1}},
                                  {1.6041726753372, {1, 1}},
                                  {2.2718946812862, {-1, 1}},
                                  {Known("two_link_arm", 1), {-1, -1}}};
  for (const auto& arcs : {best, other}) {
    const State<4> end = SimulateArcs(State<4>{0, 0, 0.5, 0}, arcs, TwoLinkRates);
    EXPECT_NEAR(end[0], 0, 1e-9);
    EXPECT_NEAR(end[1], 0, 1e-9);
    EXPECT_NEAR(end[2], 0.5, 1e-9);
    EXPECT_NEAR(end[3], 0.522, 1e-9);
  }
}

/// The second half is the first one backwards, so at half time only the heading moves.
TEST(KnownOptima, OfTheRobotArmByItsSwitchingTimes) {
  const auto rates = [](const State<6>& y, const std::array<double, 3>& u) {
    const double inertia = (std::pow(5 - y[0], 3) + std::pow(y[0], 3)) / 3;
    const double s = std::sin(y[2]);
    return State<6>{y[3], y[4], y[5], u[0] / 5, u[1] / (inertia * s * s), u[2] / inertia};
  };
  const double duration = Known("robot_arm");
  const std::vector<Arc> arcs = {
      {duration / 4, {-1, 1, -1}}, {2.7960432100102, {1, 1, -1}}, {duration / 2, {1, 1, 1}}};
  const State<6> middle = SimulateArcs(State<6>{4.5, 0, kPi / 4}, arcs, rates);
  EXPECT_NEAR(middle[1], kPi / 3, 1e-9);
  EXPECT_NEAR(middle[3], 0, 1e-9);
  EXPECT_NEAR(middle[5], 0, 1e-9);
}

}  // namespace
}  // namespace possibility::experiments
