#pragma once

#include <gtest/gtest.h>

#include <random>

#include "actions/verify/verification_report.h"
#include "tests/actions/planner/leg_scene.h"
#include "tests/actions/random_scene.h"

namespace possibility::actions {

inline RouteLeg RandomExtension(std::mt19937* generator, int gait) {
  std::uniform_real_distribution<double> unit(-1, 1);
  RouteLeg leg;
  leg.gait = gait;
  leg.from = RandomStance(generator, 2.5);
  leg.to = leg.from *
           PlanarPose{0.5 * unit(*generator), 0.25 * unit(*generator), 0.5 * unit(*generator)};
  return leg;
}

/// Turns `count` random legs that meet C_S into motion. Each must verify and meet C_N.
template <typename MakeLeg>
void ExpectSufficientLegsVerify(const LocomotionModel& model, int count, unsigned seed,
                                const MakeLeg& make_leg) {
  std::mt19937 generator(seed);
  int verified = 0;
  while (verified < count) {
    const LegScene scene(model, RandomEnvironment(&generator, 12));
    for (int attempt = 0; attempt < 200 && verified < count; ++attempt) {
      const RouteLeg leg = make_leg(&generator);
      const QuasiStaticAction& action = scene.action(EndGait(model, leg));
      const graph::Edge edge = LegEdge(model, leg);
      if (!action.CS(edge)) continue;
      EXPECT_TRUE(action.CN(edge));
      const VerificationReport report = scene.VerifyLeg(leg);
      ASSERT_TRUE(report.accepted()) << FormatText(report);
      ++verified;
    }
  }
}

/// Random routes of one gait, each of two to five legs end to end that meet C_S. The robot flows
/// through bends, where it may leave the volumes of the legs. Each route must have a motion, and it
/// must verify.
inline void ExpectSufficientRoutesVerify(const LocomotionModel& model, int count, unsigned seed,
                                         int gait) {
  std::mt19937 generator(seed);
  int verified = 0;
  while (verified < count) {
    const LegScene scene(model, RandomEnvironment(&generator, 12));
    for (int attempt = 0; attempt < 50 && verified < count; ++attempt) {
      const std::size_t legs = 2 + generator() % 4;
      Route route;
      for (int i = 0; i < 40 && route.size() < legs; ++i) {
        RouteLeg leg = RandomExtension(&generator, gait);
        if (!route.empty()) {
          const PlanarPose way = leg.from.Inverse() * leg.to;
          leg.from = route.back().to;
          leg.to = leg.from * way;
        }
        if (scene.action(gait).CS(LegEdge(model, leg))) route.push_back(leg);
      }
      if (route.size() < legs) continue;
      const VerificationReport report = scene.VerifyRoute(route);
      ASSERT_TRUE(report.accepted()) << FormatText(report);
      ++verified;
    }
  }
}

/// Random legs, whether or not they meet C_S. Those that verify must meet C_N. Obstacles are close,
/// so that C_S often refuses what is possible.
inline void ExpectVerifiedLegsMeetNecessaryConditions(const LocomotionModel& model, int count,
                                                      unsigned seed) {
  std::mt19937 generator(seed);
  int verified = 0, beyond_sufficient = 0;
  while (verified < count || beyond_sufficient == 0) {
    const LegScene scene(model, RandomEnvironment(&generator, 40));
    for (int attempt = 0; attempt < 20; ++attempt) {
      const RouteLeg leg =
          RandomExtension(&generator, attempt % static_cast<int>(model.gaits.size()));
      if (!scene.VerifyLeg(leg).accepted()) continue;
      ++verified;
      const QuasiStaticAction& action = scene.action(EndGait(model, leg));
      const graph::Edge edge = LegEdge(model, leg);
      EXPECT_TRUE(action.CN(edge));
      EXPECT_TRUE(action.CN(edge.from));
      EXPECT_TRUE(action.CN(edge.to));
      beyond_sufficient += !action.CS(edge);
    }
  }
}

}  // namespace possibility::actions
