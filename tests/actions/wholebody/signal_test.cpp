#include "actions/wholebody/signal.h"

#include <gtest/gtest.h>

#include <cmath>

namespace possibility::actions {
namespace {

constexpr double kStep = 1e-5;

void ExpectDerivativesMatch(ScalarSignal (*profile)(double, double), double duration) {
  for (double t = 2 * kStep; t < duration - 2 * kStep; t += duration / 37) {
    const ScalarSignal s = profile(t, duration);
    const ScalarSignal before = profile(t - kStep, duration);
    const ScalarSignal after = profile(t + kStep, duration);
    EXPECT_NEAR(s.rate, (after.value - before.value) / (2 * kStep), 1e-7);
    EXPECT_NEAR(s.acceleration, (after.rate - before.rate) / (2 * kStep), 1e-6);
  }
}

TEST(SignalTest, DerivativesAreThoseOfTheValue) {
  ExpectDerivativesMatch(&RestToRest, 0.7);
  ExpectDerivativesMatch(&Bump, 0.7);
}

TEST(SignalTest, QuinticLeadsFromOneStateToAnother) {
  const ScalarSignal from = {0.3, -1.2, 4}, to = {-0.1, 0.7, -9};
  constexpr double kDuration = 0.4;
  const auto at = [&](double t) { return Quintic(from, to, t, kDuration); };
  for (const bool end : {false, true}) {
    const ScalarSignal s = at(end ? kDuration : 0);
    EXPECT_NEAR(s.value, (end ? to : from).value, 1e-14);
    EXPECT_NEAR(s.rate, (end ? to : from).rate, 1e-13);
    EXPECT_NEAR(s.acceleration, (end ? to : from).acceleration, 1e-12);
  }
  for (double t = 2 * kStep; t < kDuration; t += kDuration / 37) {
    EXPECT_NEAR(at(t).rate, (at(t + kStep).value - at(t - kStep).value) / (2 * kStep), 1e-6);
    EXPECT_NEAR(at(t).acceleration, (at(t + kStep).rate - at(t - kStep).rate) / (2 * kStep), 1e-5);
  }
}

constexpr double kEvennesses[] = {1, 1.5, 3, 8};

TEST(SignalTest, AnEvenWayGoesFromZeroToOneAtRest) {
  for (const double evenness : kEvennesses) {
    for (const double t : {0.0, 0.7}) {
      const ScalarSignal s = EvenRestToRest(t, 0.7, evenness);
      EXPECT_NEAR(s.value, t > 0 ? 1 : 0, 1e-14);
      EXPECT_NEAR(s.rate, 0, 1e-14);
      EXPECT_NEAR(s.acceleration, 0, 1e-13);
    }
    EXPECT_NEAR(EvenRestToRest(0.35, 0.7, evenness).value, 0.5, 1e-15);
  }
}

TEST(SignalTest, DerivativesOfAnEvenWayAreThoseOfItsValue) {
  for (const double evenness : kEvennesses) {
    const auto at = [&](double t) { return EvenRestToRest(t, 0.7, evenness); };
    for (double t = 2 * kStep; t < 0.7 - 2 * kStep; t += 0.7 / 37) {
      EXPECT_NEAR(at(t).rate, (at(t + kStep).value - at(t - kStep).value) / (2 * kStep), 1e-6);
      EXPECT_NEAR(at(t).acceleration, (at(t + kStep).rate - at(t - kStep).rate) / (2 * kStep),
                  1e-5);
    }
  }
}

TEST(SignalTest, TheSpeedOfAWayIsSpreadTheMoreEvenlyTheGreaterItsEvenness) {
  for (double t = 0; t <= 1; t += 0.01) {
    EXPECT_EQ(EvenRestToRest(t, 1, 1).value, RestToRest(t, 1).value);
    EXPECT_NEAR(EvenRestToRest(t, 1, 1 + 1e-12).value, RestToRest(t, 1).value, 1e-9);
  }
  double before = 1.875;  // of the quintic
  for (const double evenness : {1.5, 3.0, 8.0, 1000.0}) {
    const double peak = EvenRestToRest(0.5, 1, evenness).rate;
    EXPECT_LT(peak, before);
    before = peak;
  }
  EXPECT_NEAR(before, 1.5, 0.01);  // of the cubic 3 s^2 - 2 s^3
}

TEST(SignalTest, RestToRestGoesFromZeroToOneAtRest) {
  for (const double t : {0.0, 2.5}) {
    const ScalarSignal s = RestToRest(t, 2.5);
    EXPECT_DOUBLE_EQ(s.value, t > 0 ? 1 : 0);
    EXPECT_DOUBLE_EQ(s.rate, 0);
    EXPECT_DOUBLE_EQ(s.acceleration, 0);
  }
}

TEST(SignalTest, BumpIsOneInTheMiddleAndAtRestAtBothEnds) {
  EXPECT_DOUBLE_EQ(Bump(0.5, 1).value, 1);
  for (const double t : {0.0, 1.0}) {
    EXPECT_DOUBLE_EQ(Bump(t, 1).value, 0);
    EXPECT_DOUBLE_EQ(Bump(t, 1).rate, 0);
    EXPECT_DOUBLE_EQ(Bump(t, 1).acceleration, 0);
  }
}

TEST(SignalTest, DurationGivesThePeakAccelerationAskedFor) {
  const double duration = RestToRestDuration(0.13, 0.6);
  double peak = 0;
  for (double t = 0; t <= duration; t += duration / 10000) {
    peak = std::max(peak, std::abs(Blend(0, 0.13, RestToRest(t, duration)).acceleration));
  }
  EXPECT_NEAR(peak, 0.6, 1e-6);
}

}  // namespace
}  // namespace possibility::actions
