#include "actions/spatial/beam_clearance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "actions/spatial/spatial_problem.h"
#include "tests/actions/spatial/walk_by_collocation.h"
#include "tests/message_of.h"

namespace possibility::actions {
namespace {

/// One step and the other foot beside it, over a beam.
SpatialProblem StepWithBeam(const Beam& beam) {
  static const WalkByCollocation walk(0.4, 0.4);
  SpatialSettings settings = walk.settings.problem;
  settings.beam = beam;
  return StateSpatialProblem(DrcHubo1(), *walk.stance.gait, walk.schedule, walk.stance.q, walk.to,
                             settings);
}

/// The parts that have a plane in an interval.
std::vector<std::string> PartsWithPlanes(const SpatialProblem& stated, int interval) {
  std::vector<std::string> parts;
  const std::string what = "turn before ";
  for (const auto& control : stated.phases[interval].phase->controls()) {
    if (control.name.starts_with(what)) parts.push_back(control.name.substr(what.size()));
  }
  std::sort(parts.begin(), parts.end());
  return parts;
}

constexpr Beam kThin{.begin = 0.18, .end = 0.2, .height = 0.05};

TEST(BeamClearance, ShanksHavePlanesThroughoutAndFeetWhereTheySwingOver) {
  const SpatialProblem stated = StepWithBeam(kThin);
  ASSERT_EQ(stated.phases.size(), 5u);
  const std::vector<std::string> shanks = {"shank of LKP", "shank of RKP"};
  for (const int standing : {0, 2, 4}) EXPECT_EQ(PartsWithPlanes(stated, standing), shanks);
  std::vector<std::string> swinging = PartsWithPlanes(stated, 1);
  const std::vector<std::string> other = PartsWithPlanes(stated, 3);
  ASSERT_EQ(swinging.size(), 3u);
  ASSERT_EQ(other.size(), 3u);
  EXPECT_NE(swinging.front(), other.front());
  for (const auto& parts : {swinging, other}) EXPECT_TRUE(parts.front().starts_with("foot of"));
}

TEST(BeamClearance, FeetThatDoNotCrossTheBeamHaveNoPlane) {
  const SpatialProblem stated = StepWithBeam({.begin = 0.6, .end = 0.7, .height = 0.2});
  for (int k = 0; k < 5; ++k) EXPECT_EQ(PartsWithPlanes(stated, k).size(), 2u) << k;
}

TEST(BeamClearance, AFootOnTheBeamIsRefused) {
  EXPECT_NE(MessageOf([] {
              StepWithBeam({.begin = 0.4, .end = 0.5, .height = 0.2});
            }).find("_sole bears on it at 0.430 m"),
            std::string::npos);
}

}  // namespace
}  // namespace possibility::actions
