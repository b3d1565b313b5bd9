// Available and needed dimensions where the floods answer "no".

#include <gtest/gtest.h>

#include <algorithm>

#include "actions/flood/flood_oracle.h"
#include "actions/flood/passage_gauge.h"
#include "actions/flood/passage_search.h"
#include "actions/planner/passage_explanation.h"
#include "actions/planner/plan_explanation.h"
#include "models/world/ground_map.h"
#include "tests/actions/drchubo1.h"
#include "tests/actions/gap.h"

namespace possibility::actions {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

void Add(const std::string& name, const Vector3d& low, const Vector3d& high,
         models::Environment* environment) {
  models::Obstacle obstacle;
  obstacle.name = name;
  obstacle.shape = models::Shape::Box(high - low);
  obstacle.X_WO.translation() = (low + high) / 2;
  environment->obstacles.push_back(obstacle);
}

/// A floor of 5 m x 4 m.
models::Environment EmptyRoom() {
  models::Environment environment;
  environment.bounds = Eigen::AlignedBox2d(Vector2d(-2.5, -2), Vector2d(2.5, 2));
  environment.obstacles = {Floor(0, 0, 6, 5, 0)};
  return environment;
}

/// A wall across the room with a door. The door's middle is at y = 0.4.
models::Environment Door(double width) {
  models::Environment environment = EmptyRoom();
  Add("left", {-0.1, 0.4 + width / 2, 0}, {0.1, 2.5, 2.2}, &environment);
  Add("right", {-0.1, -2.5, 0}, {0.1, 0.4 - width / 2, 2.2}, &environment);
  return environment;
}

class PassageTest : public ::testing::Test {
 protected:
  std::optional<NarrowPassage> Search(const models::Environment& environment,
                                      const std::vector<FloodManoeuvre>& manoeuvres = {}) {
    const models::GroundMap ground(environment);
    const World world{&environment, &ground};
    return SearchPassage(DrcHubo1Locomotion(), world, {0, {-1.6, -0.5, 0}, 0},
                         {{0, {1.6, -0.5, 0}, 0}}, 0.1, manoeuvres, {});
  }
  static const PassageNeed& NeedOf(const std::string& action, const NarrowPassage& passage) {
    const auto need = std::find_if(passage.needs.begin(), passage.needs.end(),
                                   [&](const PassageNeed& n) { return n.action == action; });
    if (need == passage.needs.end()) throw std::runtime_error("no need of " + action);
    return *need;
  }
};

/// The narrowest width that a gait fits through, over all headings, forward or sideways.
double Narrowest(int gait) {
  double narrowest = 10;
  for (const StrideClass strides : {StrideClass::kStraight, StrideClass::kSideways}) {
    for (double yaw = 0; yaw < 3.2; yaw += 0.01) {
      double widest = 0;
      for (const Eigen::AlignedBox3d& box :
           DrcHubo1Locomotion().gaits[gait]->volumes.sweep(strides)) {
        const Vector2d size = box.sizes().head<2>();
        widest = std::max(widest,
                          std::abs(std::sin(yaw)) * size.x() + std::abs(std::cos(yaw)) * size.y());
      }
      narrowest = std::min(narrowest, widest);
    }
  }
  return narrowest;
}

TEST_F(PassageTest, ADoorIsReportedWithItsWidthAndTheWidthNeeded) {
  for (const double width : {0.45, 0.5, 0.55}) {
    const std::optional<NarrowPassage> passage = Search(Door(width));
    ASSERT_TRUE(passage.has_value()) << width;
    EXPECT_NEAR(passage->place.x(), 0, 0.15);
    EXPECT_NEAR(passage->place.y(), 0.4, width / 2);
    EXPECT_EQ(passage->between, (std::vector<std::string>{"left", "right"}));
    const PassageNeed& walk = NeedOf("walk", *passage);
    EXPECT_EQ(walk.dimension, PassageDimension::kWidth);
    EXPECT_NEAR(walk.available, width, 0.01);
    EXPECT_NEAR(walk.needed, Narrowest(0), 0.01);
    EXPECT_LE(passage->missing, walk.needed - walk.available + 1e-9);
    EXPECT_GT(passage->missing, 0);
  }
}

TEST_F(PassageTest, ALowBarIsReportedWithItsHeightAndTheHeightNeeded) {
  models::Environment environment = EmptyRoom();
  Add("beam", {-0.1, -2.5, 0.62}, {0.1, 2.5, 2.2}, &environment);
  const std::optional<NarrowPassage> passage = Search(environment);
  ASSERT_TRUE(passage.has_value());
  const PassageNeed& crawl = NeedOf("crawl", *passage);
  EXPECT_EQ(crawl.dimension, PassageDimension::kHeight);
  EXPECT_NEAR(crawl.available, 0.62, 0.005);
  double top = 0;
  for (const auto& box : DrcHubo1Locomotion().gaits[1]->volumes.sweep(StrideClass::kStraight))
    top = std::max(top, box.max().z());
  EXPECT_NEAR(crawl.needed, top, 1e-9);
  EXPECT_EQ(passage->between, std::vector<std::string>{"beam"});
}

TEST_F(PassageTest, AGapIsReportedWithItsWidthAndTheReachOfTheLeap) {
  static constexpr double kFarthest = 1.1;
  const double gap = WidestGap(kFarthest) + 0.25;
  models::Environment environment = EmptyRoom();
  environment.obstacles = {Floor(-2 - gap / 2, 0, 4, 5, 0), Floor(2 + gap / 2, 0, 4, 5, 0)};
  const std::vector<FloodManoeuvre> leap = {
      {0, 1,
       [](double rise) {
         return rise == 0 ? std::optional(LandingRange{{Vector2d::Zero(), Vector2d(kFarthest, 0)}})
                          : std::nullopt;
       },
       "leap"}};
  const std::optional<NarrowPassage> passage = Search(environment, leap);
  ASSERT_TRUE(passage.has_value());
  EXPECT_EQ(passage->between, std::vector<std::string>{"no ground"});
  const PassageNeed& need = NeedOf("leap", *passage);
  EXPECT_EQ(need.dimension, PassageDimension::kGap);
  EXPECT_NEAR(need.available, gap, 0.03);
  EXPECT_NEAR(need.needed, WidestGap(kFarthest), 1e-9);
}

TEST_F(PassageTest, ASolidWallHasNoPassage) {
  models::Environment environment = EmptyRoom();
  Add("wall", {-0.1, -2.5, 0}, {0.1, 2.5, 2.2}, &environment);
  EXPECT_FALSE(Search(environment).has_value());
}

/// The passage of the way that the floods leave open, where they cannot answer "no".
TEST_F(PassageTest, AnUnknownAnswerNamesTheNarrowestPassage) {
  const models::Environment environment = Door(Narrowest(0) + 0.02);
  const models::GroundMap ground(environment);
  const World world{&environment, &ground};
  const std::vector<std::shared_ptr<Manoeuvre>> none;
  FloodOracle oracle(DrcHubo1Locomotion(), world, none, 0.1, {});
  EXPECT_EQ(oracle.Ask({0, {-1.6, -0.5, 0}, 0}, {{0, {1.6, -0.5, 0}, 0}}),
            graph::RouteOracleAnswer::kUnknown);
  ASSERT_TRUE(oracle.passage().has_value());
  EXPECT_EQ(oracle.passage()->between, (std::vector<std::string>{"left", "right"}));
  EXPECT_LT(oracle.passage()->missing, 0.01) << "there is room";
  EXPECT_FALSE(oracle.has_barrier());
  const std::vector<GroundedStance> way = oracle.way();
  ASSERT_GE(way.size(), 2U);
  EXPECT_LT(way.front().pose.x, -1);
  EXPECT_GT(way.back().pose.x, 1);
  const auto beyond = std::find_if(way.begin(), way.end(),
                                   [](const GroundedStance& stance) { return stance.pose.x > 0; });
  EXPECT_NEAR(beyond->pose.y, 0.4, 0.2) << "leads through the door";
}

TEST(PassageExplanationTest, NamesTheAvailableAndTheNeededDimensions) {
  NarrowPassage passage{.place = {5, 0.1}, .missing = 0.12, .between = {"left", "right"}};
  passage.needs = {{"walk", PassageDimension::kWidth, 0.74, 0.86},
                   {"crawl", PassageDimension::kHeight, 0.7, 0.82}};
  EXPECT_EQ(ExplainPassage(true, passage),
            " The narrowest place on the way is at (5.00, 0.10), between left, right: 0.74 m wide, "
            "0.86 needed by 'walk'; 0.70 m high, 0.82 needed by 'crawl'.");
  passage.between = {"no ground"};
  passage.needs = {{"jump", PassageDimension::kGap, 1, 0.46}};
  EXPECT_EQ(ExplainPassage(false, passage),
            " No barrier was found; the narrowest place on the way is at (5.00, 0.10): 1.00 m "
            "without ground, 'jump' reaches over 0.46.");
  EXPECT_EQ(ExplainPassage(true, std::nullopt), "");
}

}  // namespace
}  // namespace possibility::actions
