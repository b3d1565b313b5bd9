#include "actions/route/route_polish.h"

#include <gtest/gtest.h>

#include "actions/conditions/exploration_pose.h"
#include "models/world/ground_map.h"
#include "tests/actions/drchubo1.h"

namespace possibility::actions {
namespace {

/// Walking on a floor with a pillar in its middle, by a needlessly long route.
class RoutePolishTest : public ::testing::Test {
 protected:
  RoutePolishTest() {
    environment_.bounds = Eigen::AlignedBox2d(Eigen::Vector2d(-4, -4), Eigen::Vector2d(4, 4));
    Add({10, 10, 0.5}, -0.25, true);
    Add({0.5, 0.5, 2}, 1, false);
    ground_ = std::make_unique<models::GroundMap>(environment_);
    world_ = {&environment_, ground_.get()};
    const auto space =
        std::make_shared<PelvisPoseSpace>(environment_.bounds, ground_->levels(), 0.137);
    for (int gait = 0; gait < 2; ++gait) {
      gaits_.push_back(
          std::make_shared<QuasiStaticAction>(DrcHubo1Locomotion(), gait, world_, space, 0.25));
    }
    const PlanarPose places[] = {{-2, 0, 0}, {-2, -3, 0}, {2, -3, 0}, {2, 0, 0}};
    for (int i = 0; i < 3; ++i) {
      RouteLeg leg;
      leg.from = places[i];
      leg.to = places[i + 1];
      route_.push_back(leg);
    }
  }

  void Add(const Eigen::Vector3d& size, double z, bool is_ground) {
    models::Obstacle obstacle;
    obstacle.shape = models::Shape::Box(size);
    obstacle.X_WO.translation().z() = z;
    obstacle.is_ground = is_ground;
    environment_.obstacles.push_back(obstacle);
  }

  RouteSpace space() const { return {&DrcHubo1Locomotion(), &gaits_, &manoeuvres_}; }
  double Expected(const Route& route) const {
    return ExpectedDuration(DrcHubo1Locomotion(), route);
  }

  models::Environment environment_;
  std::unique_ptr<models::GroundMap> ground_;
  World world_;
  std::vector<std::shared_ptr<QuasiStaticAction>> gaits_;
  std::vector<std::shared_ptr<SearchedManoeuvre>> manoeuvres_;
  Route route_;
};

TEST_F(RoutePolishTest, BecomesQuickerAndKeepsItsEndsAndConditions) {
  RoutePolish polish(space(), route_, 1);
  while (polish.Try(500, {})) {
  }
  const Route& route = polish.route();
  EXPECT_LT(Expected(route), 0.8 * Expected(route_));
  EXPECT_EQ(route.front().from.position(), route_.front().from.position());
  EXPECT_EQ(route.back().to.position(), route_.back().to.position());
  for (std::size_t i = 0; i < route.size(); ++i) {
    EXPECT_TRUE(gaits_[0]->CS(LegEdge(DrcHubo1Locomotion(), route[i])));
    if (i > 0) {
      EXPECT_EQ(route[i].from.position(), route[i - 1].to.position());
    }
  }
}

TEST_F(RoutePolishTest, OneSeedGivesOneRoute) {
  RoutePolish one(space(), route_, 7), again(space(), route_, 7), other(space(), route_, 8);
  for (RoutePolish* polish : {&one, &again, &other}) polish->Try(1000, {});
  EXPECT_EQ(Expected(one.route()), Expected(again.route()));
  EXPECT_NE(Expected(one.route()), Expected(other.route()));
}

TEST_F(RoutePolishTest, ChangesNothingOnceCancelled) {
  RoutePolish polish(space(), route_, 1);
  EXPECT_FALSE(polish.Try(1000, CancellationToken([] { return false; })));
  EXPECT_EQ(Expected(polish.route()), Expected(route_));
}

}  // namespace
}  // namespace possibility::actions
