// Verdicts from the store beside verdicts from nothing, in worlds that change at random.
#include "actions/verify/verdict_store.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "actions/verify/verification_report.h"
#include "tests/actions/verify/walk_and_crawl.h"

namespace possibility::actions {
namespace {

using testing::VerifierSubject;
using testing::WalkAndCrawl;

/// Everything of a report but the time it took.
nlohmann::json Findings(const VerificationReport& report) {
  nlohmann::json json = nlohmann::json::parse(FormatJson(report));
  json.erase("seconds");
  return json;
}

double Between(double low, double high, std::mt19937* generator) {
  return std::uniform_real_distribution<double>(low, high)(*generator);
}

/// The plan among boxes, on a floor of several pieces.
VerifierSubject AmongBoxes(std::mt19937* generator) {
  VerifierSubject subject = WalkAndCrawl();
  std::vector<models::Obstacle>& obstacles = subject.scenario.environment.obstacles;
  const models::Stance& start = subject.scenario.start;
  for (int i = 0; i < 8; ++i) {
    models::Obstacle box;
    box.name = fmt::format("box {}", i);
    box.shape = models::Shape::Box({0.2, 0.2, 1.2});
    const double angle = Between(0, 6.28, generator);
    box.X_WO.translation() = Eigen::Vector3d(start.x + 1.1 * std::cos(angle),
                                             start.y + 1.1 * std::sin(angle), start.z + 0.6);
    obstacles.push_back(box);
  }
  models::Obstacle slab;
  slab.name = "slab";
  slab.is_ground = true;
  slab.shape = models::Shape::Box({0.5, 0.5, 0.1});
  slab.X_WO.translation() = Eigen::Vector3d(start.x, start.y + 1, start.z - 0.05);
  obstacles.push_back(slab);
  return subject;
}

/// Moves one of them: by a little or a lot, near the plan or far away. Now and then the floor, too.
void MoveOne(VerifierSubject* subject, std::mt19937* generator) {
  std::vector<models::Obstacle>& obstacles = subject->scenario.environment.obstacles;
  if ((*generator)() % 8 == 0) {
    obstacles.front().X_WO.translation() +=
        Eigen::Vector3d(0.1, 0, Between(-2e-3, 1e-3, generator));
  }
  const std::size_t first = obstacles.size() - 9;
  models::Obstacle& moved = obstacles[first + (*generator)() % 9];
  const double by = std::exp(Between(std::log(1e-3), std::log(2), generator));
  const double angle = Between(0, 6.28, generator);
  moved.X_WO.translation() += Eigen::Vector3d(by * std::cos(angle), by * std::sin(angle), 0);
}

void ExpectSameVerdicts(int moves, bool simulates) {
  std::mt19937 generator(7);
  VerdictStore store;
  VerifierSettings from_nothing;
  from_nothing.simulates = simulates;
  VerifierSettings with_store = from_nothing;
  with_store.store = &store;
  VerifierSubject subject = AmongBoxes(&generator);
  int accepted = 0, kept = 0;
  for (int move = 0; move < moves; ++move) {
    const VerificationReport expected = testing::Verified(subject, from_nothing);
    const VerificationReport report = testing::Verified(subject, with_store);
    EXPECT_EQ(Findings(report), Findings(expected)) << "move " << move;
    accepted += report.accepted() ? 1 : 0;
    kept += report.kept_samples > 0 ? 1 : 0;
    if (!expected.accepted() && move % 2 == 0) subject = AmongBoxes(&generator);
    MoveOne(&subject, &generator);
  }
  EXPECT_GT(accepted, moves / 5);
  EXPECT_LT(accepted, moves);
  EXPECT_GT(kept, moves / 2);
}

TEST(VerdictStore, GivesTheVerdictsOfAVerificationFromNothing) { ExpectSameVerdicts(20, false); }

TEST(VerdictStoreLong, GivesTheVerdictsOfAVerificationFromNothing) {
  ExpectSameVerdicts(150, true);
}

TEST(VerdictStore, ThePlanAgainIsKeptAsAWhole) {
  VerdictStore store;
  VerifierSettings settings;
  settings.store = &store;
  const VerificationReport first = testing::Verified(WalkAndCrawl(), settings);
  ASSERT_TRUE(first.accepted()) << FormatText(first);
  EXPECT_EQ(first.kept_samples, 0);
  EXPECT_EQ(first.kept_rollouts, 0);
  const VerificationReport second = testing::Verified(WalkAndCrawl(), settings);
  EXPECT_EQ(second.kept_samples, second.samples);
  EXPECT_EQ(second.kept_rollouts, static_cast<int>(second.rollouts.size()));
  EXPECT_EQ(Findings(second), Findings(first));
}

TEST(VerdictStore, AnotherResolutionIsAnotherQuestion) {
  VerdictStore store;
  VerifierSettings settings;
  settings.simulates = false;
  settings.store = &store;
  testing::Verified(WalkAndCrawl(), settings);
  settings.resolution = 0.004;
  EXPECT_EQ(testing::Verified(WalkAndCrawl(), settings).kept_samples, 0);
}

TEST(VerdictStore, AChangedKnotIsJudgedAgain) {
  VerdictStore store;
  VerifierSettings settings;
  settings.simulates = false;
  settings.store = &store;
  testing::Verified(WalkAndCrawl(), settings);
  VerifierSubject forged = WalkAndCrawl();
  testing::MiddleKnot(&testing::FirstPhase(&forged)).tau[0] += 1;
  const VerificationReport report = testing::Verified(forged, settings);
  EXPECT_NE(testing::Find(report, ViolationKind::kDynamics), nullptr) << FormatText(report);
  EXPECT_GT(report.kept_samples, 0);
  EXPECT_LT(report.kept_samples, report.samples);
}

TEST(VerdictTable, ForgetsWhatHasNotBeenAskedForLongest) {
  const models::Environment nowhere;
  const models::GroundMap ground(nowhere);
  const models::LocalWorld world(nowhere, ground);
  VerdictTable<int> table(4000);
  const std::string often(100, 'a'), once(100, 'b');
  table.Add(often, {}, world, 1);
  table.Add(once, {}, world, 2);
  for (int i = 0; i < 100; ++i) {
    table.Add(fmt::format("{:100}", i), {}, world, i);
    ASSERT_EQ(table.Find(often, world), 1);
  }
  EXPECT_FALSE(table.Find(once, world));
}

}  // namespace
}  // namespace possibility::actions
