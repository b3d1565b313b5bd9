// Soundness of C_S (conservative) and C_N (optimistic), against generated motion and the verifier.

#include "tests/actions/planner/soundness.h"

#include <gtest/gtest.h>

#include <utility>

#include "tests/actions/drchubo1.h"

namespace possibility::actions {
namespace {

RouteLeg RandomTransition(std::mt19937* generator) {
  RouteLeg leg;
  leg.transition = 0;
  leg.from = RandomStance(generator, 2.5);
  leg.to = leg.from * DrcHubo1Locomotion().transitions[0].displacement;
  leg.backwards = (*generator)() % 2 == 0;
  if (leg.backwards) std::swap(leg.from, leg.to);
  return leg;
}

TEST(SoundnessTest, SufficientWalkingVerifies) {
  ExpectSufficientLegsVerify(DrcHubo1Locomotion(), 10, 1,
                             [](auto* g) { return RandomExtension(g, 0); });
}
TEST(SoundnessTest, SufficientCrawlingVerifies) {
  ExpectSufficientLegsVerify(DrcHubo1Locomotion(), 10, 2,
                             [](auto* g) { return RandomExtension(g, 1); });
}
TEST(SoundnessTest, SufficientTransitionsVerify) {
  ExpectSufficientLegsVerify(DrcHubo1Locomotion(), 6, 3,
                             [](auto* g) { return RandomTransition(g); });
}
TEST(SoundnessTest, RoutesOfSufficientLegsVerify) {
  ExpectSufficientRoutesVerify(DrcHubo1Locomotion(), 4, 5, 0);
  ExpectSufficientRoutesVerify(DrcHubo1Locomotion(), 4, 6, 1);
}
TEST(SoundnessTest, VerifiedLegsMeetNecessaryConditions) {
  ExpectVerifiedLegsMeetNecessaryConditions(DrcHubo1Locomotion(), 5, 4);
}

TEST(SoundnessLong, FiveHundredSufficientWalkingEdgesVerify) {
  ExpectSufficientLegsVerify(DrcHubo1Locomotion(), 500, 11,
                             [](auto* g) { return RandomExtension(g, 0); });
}
TEST(SoundnessLong, FiveHundredSufficientCrawlingEdgesVerify) {
  ExpectSufficientLegsVerify(DrcHubo1Locomotion(), 500, 12,
                             [](auto* g) { return RandomExtension(g, 1); });
}
TEST(SoundnessLong, FiveHundredSufficientTransitionsVerify) {
  ExpectSufficientLegsVerify(DrcHubo1Locomotion(), 500, 13,
                             [](auto* g) { return RandomTransition(g); });
}
TEST(SoundnessLong, FiveHundredWalkingRoutesVerify) {
  ExpectSufficientRoutesVerify(DrcHubo1Locomotion(), 500, 15, 0);
}
TEST(SoundnessLong, FiveHundredCrawlingRoutesVerify) {
  ExpectSufficientRoutesVerify(DrcHubo1Locomotion(), 500, 16, 1);
}
TEST(SoundnessLong, VerifiedLegsMeetNecessaryConditions) {
  ExpectVerifiedLegsMeetNecessaryConditions(DrcHubo1Locomotion(), 200, 14);
}

}  // namespace
}  // namespace possibility::actions
