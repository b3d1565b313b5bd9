#include "dynamics/rollout/hybrid_rollout.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>
#include <string>

#include "tests/dynamics/rollout/compass_gait.h"

namespace possibility::dynamics {
namespace {

using Eigen::VectorXd;
using State = const Eigen::Ref<const VectorXd>&;
using Output = Eigen::Ref<VectorXd>;

constexpr double kG = 9.81;

HybridSettings AccurateHybrid(double tolerance = 1e-12) {
  HybridSettings settings;
  settings.integration.relative_tolerance = tolerance;
  settings.integration.absolute_tolerance = tolerance;
  return settings;
}

/// A mode that is its own successor. `reset` gives the state after the event.
std::shared_ptr<HybridMode> Looping(std::string name, OdeRate rate, OdeGuard guard,
                                    OdeGuardFunction values,
                                    std::function<VectorXd(const VectorXd&)> reset) {
  auto mode = std::make_shared<HybridMode>();
  mode->name = std::move(name);
  mode->rate = std::move(rate);
  mode->guards = {guard};
  mode->guard_names = {"guard"};
  mode->guard_values = std::move(values);
  std::weak_ptr<const HybridMode> self = mode;
  mode->reset = [reset, self](const HybridEvent& event) {
    return HybridTransition{self.lock(), reset(event.before), ""};
  };
  return mode;
}

std::shared_ptr<HybridMode> BouncingBall(double restitution) {
  return Looping(
      "flight", [](double, State x, Output rate) { rate << x[1], -kG; }, {GuardDirection::kFalling},
      [](double, State x, Output values) { values[0] = x[0]; },
      [restitution](const VectorXd& x) -> VectorXd {
        return Eigen::Vector2d(0, -restitution * x[1]);
      });
}

TEST(HybridRollout, BouncingBallAgreesWithItsClosedForm) {
  for (const double restitution : {0.5, 0.8, 1.0}) {
    const double height = 1.3, fall = std::sqrt(2 * height / kG);
    HybridSettings settings = AccurateHybrid();
    settings.end_at_zeno = true;
    const HybridRollout rollout =
        RollOut(BouncingBall(restitution), Eigen::Vector2d(height, 0), 0, 3, settings);
    ASSERT_GE(rollout.events.size(), 3);
    double bounce = fall, factor = 1;
    for (size_t i = 0; i < rollout.events.size() && rollout.events[i].time < 2.9; ++i) {
      EXPECT_NEAR(rollout.events[i].time, bounce, 1e-8) << "bounce " << i;
      EXPECT_NEAR(rollout.events[i].before[1], -kG * fall * factor, 1e-8);
      EXPECT_NEAR(rollout.events[i].after[1], kG * fall * factor * restitution, 1e-8);
      factor *= restitution;
      const double apex = bounce + fall * factor;
      if (apex < rollout.time) {
        EXPECT_NEAR(rollout.State(apex)[0], height * factor * factor, 1e-8);
        EXPECT_NEAR(rollout.State(apex)[1], 0, 1e-8);
      }
      bounce += 2 * fall * factor;
      if (factor < 1e-3) break;
    }
  }
}

TEST(HybridRollout, ZenoBehaviourIsAnErrorOrEndsTheRollout) {
  const double restitution = 0.5, fall = std::sqrt(2 / kG);
  const double accumulation = fall * (1 + restitution) / (1 - restitution);
  const auto ball = BouncingBall(restitution);
  HybridSettings settings = AccurateHybrid();
  settings.zeno_events = 10;
  settings.zeno_time = 1e-3;
  try {
    RollOut(ball, Eigen::Vector2d(1, 0), 0, 5, settings);
    FAIL() << "Zeno behaviour was integrated through";
  } catch (const OdeError& error) {
    EXPECT_NEAR(error.time(), accumulation, 1e-3);
    EXPECT_NE(std::string(error.what()).find("10 events within 0.001 s"), std::string::npos)
        << error.what();
    EXPECT_NE(std::string(error.what()).find("guard in mode 'flight'"), std::string::npos);
  }
  settings.end_at_zeno = true;
  const HybridRollout rollout = RollOut(ball, Eigen::Vector2d(1, 0), 0, 5, settings);
  EXPECT_EQ(rollout.end, HybridEnd::kZeno);
  EXPECT_NEAR(rollout.time, accumulation, 1e-3);
  EXPECT_LT(rollout.state.norm(), 1e-2);
}

TEST(HybridRollout, ABallAtRestDoesNotFallThroughTheGround) {
  HybridSettings settings = AccurateHybrid();
  settings.end_at_zeno = true;
  const HybridRollout rollout = RollOut(BouncingBall(0.5), Eigen::Vector2d(0, 0), 0, 1, settings);
  EXPECT_EQ(rollout.end, HybridEnd::kZeno);
  EXPECT_LT(rollout.time, 1e-3);
  EXPECT_GT(rollout.state[0], -1e-9);
}

TEST(HybridRollout, RimlessWheelAgreesWithItsClosedForm) {
  // McGeer 1990: each impact multiplies the rate by cos(2 alpha).
  const double length = 0.7, alpha = std::numbers::pi / 8, slope = 0.12;
  const auto wheel = Looping(
      "spoke", [=](double, State x, Output rate) { rate << x[1], kG / length * std::sin(x[0]); },
      {GuardDirection::kRising},
      [=](double, State x, Output values) { values[0] = x[0] - slope - alpha; },
      [=](const VectorXd& x) -> VectorXd {
        return Eigen::Vector2d(slope - alpha, std::cos(2 * alpha) * x[1]);
      });
  const double gain = 4 * kG / length * std::sin(alpha) * std::sin(slope);
  const double fixed_point = std::sqrt(gain) / std::tan(2 * alpha);
  double square = 2.25;  // of the rate after the last impact
  const HybridRollout rollout =
      RollOut(wheel, Eigen::Vector2d(slope - alpha, std::sqrt(square)), 0, 20, AccurateHybrid());
  ASSERT_GT(rollout.events.size(), 20);
  for (const HybridEvent& event : rollout.events) {
    square = std::pow(std::cos(2 * alpha), 2) * (square + gain);
    EXPECT_NEAR(event.after[1], std::sqrt(square), 1e-8);
  }
  EXPECT_NEAR(rollout.events.back().after[1], fixed_point, 1e-8);
}

/// Garcia, Chatterjee, Ruina & Coleman 1998, equations 1 to 5. State: lean of the stance leg, angle
/// between the legs, their rates. Time is in units of sqrt(leg / gravity).
std::shared_ptr<HybridMode> SimplestWalker(double slope) {
  return Looping(
      "step",
      [=](double, State x, Output rate) {
        const double lean = std::sin(x[0] - slope);
        rate << x[2], x[3], lean, lean + (x[2] * x[2] - std::cos(x[0] - slope)) * std::sin(x[1]);
      },
      {GuardDirection::kRising, false},
      [](double, State x, Output values) { values[0] = x[1] - 2 * x[0]; },
      [](const VectorXd& x) -> VectorXd {
        const double c = std::cos(2 * x[0]);
        return Eigen::Vector4d(-x[0], -2 * x[0], c * x[2], c * (1 - c) * x[2]);
      });
}

VectorXd AfterOneStep(const std::shared_ptr<HybridMode>& walker, const Eigen::Vector2d& start) {
  Eigen::Vector4d x;
  x << start[0], 2 * start[0], start[1], (1 - std::cos(2 * start[0])) * start[1];
  const HybridRollout rollout = RollOut(walker, x, 0, 5, AccurateHybrid());
  EXPECT_FALSE(rollout.events.empty());
  return rollout.events.front().after;
}

/// Greatest |eigenvalue|: half the trace plus or minus the root of its square less the determinant.
double SpectralRadius(const Eigen::Matrix2d& map) {
  const double half = (map(0, 0) + map(1, 1)) / 2;
  const double determinant = map(0, 0) * map(1, 1) - map(0, 1) * map(1, 0);
  const double square = half * half - determinant;
  return square < 0 ? std::sqrt(determinant) : std::abs(half) + std::sqrt(square);
}

TEST(HybridRollout, SimplestWalkerHasItsPublishedLimitCycles) {
  const auto walker = SimplestWalker(0.009);
  const auto step = [&walker](const Eigen::Vector2d& z) -> Eigen::Vector2d {
    const VectorXd after = AfterOneStep(walker, z);
    return {after[0], after[2]};
  };
  // Long (stable) and short (unstable) period-one gaits, published to ten digits.
  for (const Eigen::Vector2d& published : {Eigen::Vector2d(0.20031090049483, -0.19983247291764),
                                           Eigen::Vector2d(0.19393736960624, -0.20386692731962)}) {
    EXPECT_LT((step(published) - published).norm(), 1e-8);
    Eigen::Matrix2d map;
    for (int i = 0; i < 2; ++i) {
      const Eigen::Vector2d h = 1e-6 * Eigen::Vector2d::Unit(i);
      map.col(i) = (step(published + h) - step(published - h)) / 2e-6;
    }
    const double growth = SpectralRadius(map);
    // From Bhounsule 2014, to the digits compared: -0.1901 +- 0.5576 i and 4.0039.
    EXPECT_NEAR(growth, published[0] > 0.2 ? std::hypot(0.1900996, 0.5575993) : 4.0038652, 1e-4);
  }
}

TEST(HybridRollout, CompassGaitOfLightFeetIsTheSimplestWalker) {
  CompassGait gait;
  gait.leg_mass = 1e-9;
  gait.hip_mass = 1;
  gait.foot_to_mass = 0;
  gait.mass_to_hip = 1;
  gait.gravity = 1;
  gait.slope = 0.009;
  const double lean = 0.20031090049483, rate = -0.19983247291764;
  Eigen::Vector4d x;
  x << gait.slope - lean, gait.slope + lean, -rate, -rate * std::cos(2 * lean);
  const HybridRollout rollout = RollOut(gait.Mode(), x, 0, 5, AccurateHybrid());
  ASSERT_FALSE(rollout.events.empty());
  EXPECT_LT((rollout.events.front().after - x).norm(), 1e-7);
}

TEST(HybridRollout, CompassGaitSettlesOnALimitCycle) {
  const CompassGait gait;
  const HybridRollout rollout =
      RollOut(gait.Mode(), CompassGait::NearLimitCycle(), 0, 60, AccurateHybrid());
  ASSERT_GT(rollout.events.size(), 60);
  const HybridEvent& last = rollout.events.back();
  const HybridEvent& previous = rollout.events[rollout.events.size() - 2];
  EXPECT_LT((last.after - previous.after).norm(), 1e-7);
  // The impact takes what the slope gives. Between impacts no energy is lost.
  const double energy = gait.Energy(previous.after);
  EXPECT_NEAR(gait.Energy(last.before), energy, 1e-9 * energy);
  const double step = 2 * gait.leg() * std::sin((last.after[1] - last.after[0]) / 2);
  const double weight = gait.gravity * (2 * gait.leg_mass + gait.hip_mass);
  Eigen::VectorXd at_rest = last.after;
  at_rest.tail<2>().setZero();
  const double kinetic_after = gait.Energy(last.after) - gait.Energy(at_rest);
  at_rest.head<2>() = last.before.head<2>();
  const double kinetic_before = gait.Energy(last.before) - gait.Energy(at_rest);
  EXPECT_NEAR(kinetic_before - kinetic_after, weight * step * std::sin(gait.slope), 1e-6);
}

TEST(HybridRollout, DoublePendulumConservesEnergy) {
  // Two point masses of 1 kg on rods of 1 m, like the compass gait's stance without its hip mass.
  CompassGait gait;
  const auto mode = std::make_shared<HybridMode>(HybridMode{
      "swing", [gait](double, State x, Output rate) { gait.Rate(x, rate); }, {}, {}, {}, {}});
  for (const double lean : {1.0, 2.0, 3.0}) {
    Eigen::Vector4d x;
    x << lean, 2 - lean, 0.5, -3;
    const HybridRollout rollout = RollOut(mode, x, 0, 5, AccurateHybrid(1e-10));
    const double scale = std::abs(gait.Energy(x)) + 9.81 * 20;
    double worst = 0;
    for (int i = 0; i <= 500; ++i) {
      worst = std::max(worst, std::abs(gait.Energy(rollout.State(i * 0.01)) - gait.Energy(x)));
    }
    EXPECT_LT(worst, 1e-7 * scale) << rollout.statistics.steps << " steps";
  }
}

TEST(HybridRollout, ModesAreMadeAtRunTimeAndMayChangeSize) {
  // Mode k has k + 1 states, all of which grow at rate 1; it lasts a second.
  std::function<std::shared_ptr<const HybridMode>(int)> make =
      [&make](int k) -> std::shared_ptr<const HybridMode> {
    auto mode = std::make_shared<HybridMode>();
    mode->name = "size " + std::to_string(k + 1);
    mode->rate = [](double, State, Output rate) { rate.setOnes(); };
    mode->guards = {{GuardDirection::kRising}};
    mode->guard_names = {"full"};
    mode->guard_values = [](double, State x, Output values) { values[0] = x[0] - 1; };
    mode->reset = [&make, k](const HybridEvent& event) {
      EXPECT_EQ(event.segment, k);
      HybridTransition next;
      if (k == 4) {
        next.reason = "five are enough";
      } else {
        next.mode = make(k + 1);
        next.state = VectorXd::Zero(k + 2);
      }
      return next;
    };
    return mode;
  };
  const HybridRollout rollout = RollOut(make(0), VectorXd::Zero(1), 0, 100);
  EXPECT_EQ(rollout.end, HybridEnd::kReset);
  EXPECT_EQ(rollout.reason, "five are enough");
  ASSERT_EQ(rollout.segments.size(), 5);
  EXPECT_NEAR(rollout.time, 5, 1e-9);
  EXPECT_EQ(rollout.State(3.5).size(), 4);
  EXPECT_NEAR(rollout.State(3.5)[2], 0.5, 1e-9);
  EXPECT_EQ(rollout.SegmentAt(2.5).mode->name, "size 3");
  EXPECT_THROW(rollout.State(5.1), std::invalid_argument);
}

TEST(HybridRollout, AGuardThatKeepsTheModeFiresOncePerCrossing) {
  auto mode = Looping(
      "swing", [](double, State x, Output rate) { rate << x[1], -x[0]; }, {GuardDirection::kBoth},
      [](double, State x, Output values) { values[0] = x[0]; },
      [](const VectorXd& x) { return x; });
  const HybridRollout rollout = RollOut(mode, Eigen::Vector2d(1, 0), 0, 20, AccurateHybrid());
  ASSERT_EQ(rollout.events.size(), 6);
  for (int i = 0; i < 6; ++i) {
    EXPECT_NEAR(rollout.events[i].time, (i + 0.5) * std::numbers::pi, 1e-9);
  }
}

TEST(HybridRollout, TheEndTimeOrCancellationEndsTheRollout) {
  HybridSettings settings = AccurateHybrid();
  const HybridRollout whole = RollOut(BouncingBall(1), Eigen::Vector2d(1, 0), 0, 2, settings);
  EXPECT_EQ(whole.end, HybridEnd::kTime);
  EXPECT_EQ(whole.time, 2);
  int asked = 0;
  settings.integration.cancellation = CancellationToken([&asked] { return ++asked <= 60; });
  const HybridRollout stopped = RollOut(BouncingBall(1), Eigen::Vector2d(1, 0), 0, 1e6, settings);
  EXPECT_EQ(stopped.end, HybridEnd::kCancelled);
  EXPECT_EQ(stopped.statistics.steps, 60);
}

TEST(HybridRollout, InconsistentModesAreRejected) {
  EXPECT_THROW(RollOut(nullptr, VectorXd::Zero(1), 0, 1), std::invalid_argument);
  auto nameless = BouncingBall(1);
  nameless->guard_names.clear();
  EXPECT_THROW(RollOut(nameless, Eigen::Vector2d(1, 0), 0, 1), std::invalid_argument);
  auto endless = BouncingBall(1);
  endless->reset = nullptr;
  EXPECT_THROW(RollOut(endless, Eigen::Vector2d(1, 0), 0, 1), std::invalid_argument);
}

TEST(HybridRollout, ExceptionsOfTheResetPassThrough) {
  auto mode = BouncingBall(1);
  mode->reset = [](const HybridEvent&) -> HybridTransition { throw 3; };
  EXPECT_THROW(RollOut(mode, Eigen::Vector2d(1, 0), 0, 1), int);
}

}  // namespace
}  // namespace possibility::dynamics
