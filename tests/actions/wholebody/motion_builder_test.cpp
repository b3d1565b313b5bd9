#include "actions/wholebody/motion_builder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "actions/gait/quasi_static_gait.h"
#include "actions/wholebody/motion_error.h"
#include "tests/actions/drchubo1.h"

namespace possibility::actions {
namespace {

using Eigen::Vector3d;

/// Standing at rest on both soles, whose ground is tilted by atan(slope) towards `heading`.
class StandingOnASlope : public ::testing::Test {
 protected:
  bool Holds(double slope, double heading, double friction = DrcHubo1().friction) {
    MotionPhase phase = QuasiStaticGait(DrcHubo1(), stance_).Standing({}, 0, 0.2);
    const Vector3d normal(slope * std::cos(heading), slope * std::sin(heading), 1);
    phase.normals.assign(phase.contacts.size(), normal.normalized());
    phase.friction.assign(phase.contacts.size(), friction);
    try {
      MotionBuilder(DrcHubo1()).Build({phase}, stance_.q);
      return true;
    } catch (const MotionError& error) {
      fault_ = error.what();
      return false;
    }
  }

  /// The steepest slope, from friction alone. All forces are vertical. `kept`: share of the weight
  /// that the points keep as their least load; it holds no tangential force.
  static double Steepest(double friction = DrcHubo1().friction) {
    const MotionSettings settings;
    const double usable = settings.friction_margin * friction;
    const double kept = 8 * settings.normal_reserve;
    double slope = usable;
    for (int i = 0; i < 50; ++i) slope = usable * (1 - kept * std::sqrt(1 + slope * slope));
    return slope;
  }

  std::string fault_;
  const NominalStance stance_ = SolveNominalStance(DrcHubo1(), DrcHubo1().GaitNamed("walk"));
};

/// An octagon in the circle of friction would miss 8 %.
TEST_F(StandingOnASlope, TakesAlmostAllUsableFrictionWhereverTheSlopeFaces) {
  constexpr int kHeadings = 24;
  for (int i = 0; i < kHeadings; ++i) {
    const double heading = 2 * std::numbers::pi * i / kHeadings;
    EXPECT_TRUE(Holds(0.975 * Steepest(), heading)) << heading << ": " << fault_;
    EXPECT_FALSE(Holds(1.005 * Steepest(), heading)) << heading;
  }
}

TEST_F(StandingOnASlope, TakesNoMoreFrictionThanItsGroundHas) {
  for (const double friction : {0.1, 0.25, 0.5}) {
    EXPECT_TRUE(Holds(0.975 * Steepest(friction), 0.3, friction)) << friction << ": " << fault_;
    EXPECT_FALSE(Holds(1.005 * Steepest(friction), 0.3, friction)) << friction;
  }
  EXPECT_NE(fault_.find("the contacts need a friction of"), std::string::npos) << fault_;
}

}  // namespace
}  // namespace possibility::actions
