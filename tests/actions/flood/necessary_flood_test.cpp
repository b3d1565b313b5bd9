// The flood whose "no" is a proof.

#include "actions/flood/necessary_flood.h"

#include <gtest/gtest.h>

#include <random>

#include "actions/conditions/exploration_pose.h"
#include "actions/flood/route_flood.h"
#include "actions/route/lattice_search.h"
#include "models/world/collision.h"
#include "models/world/ground_map.h"
#include "tests/actions/drchubo1.h"

namespace possibility::actions {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

void Add(const std::string& name, const Vector3d& low, const Vector3d& high, bool is_ground,
         models::Environment* environment) {
  models::Obstacle obstacle;
  obstacle.name = name;
  obstacle.shape = models::Shape::Box(high - low);
  obstacle.X_WO.translation() = (low + high) / 2;
  obstacle.is_ground = is_ground;
  environment->obstacles.push_back(obstacle);
}

models::Environment FloorOf(const Vector2d& low, const Vector2d& high) {
  models::Environment environment;
  environment.bounds = Eigen::AlignedBox2d(low, high);
  Add("floor", {low.x() - 1, low.y() - 1, -0.5}, {high.x() + 1, high.y() + 1, 0}, true,
      &environment);
  return environment;
}

class NecessaryFloodTest : public ::testing::Test {
 protected:
  FloodResult Flood(const models::Environment& environment, const PlanarPose& start,
                    const PlanarPose& goal) const {
    const models::GroundMap ground(environment);
    const World world{&environment, &ground};
    return FloodNecessary(model_, world, {0, start, 0}, {{0, goal, 0}}, 0.1);
  }

  const LocomotionModel& model_ = DrcHubo1Locomotion();
};

/// The pelvis must stay within the bounds, and there is no room for it beside the wall.
TEST_F(NecessaryFloodTest, AWallAsLongAsTheBoundsLeavesNoRoute) {
  std::mt19937 generator(5);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int trial = 0; trial < 12; ++trial) {
    // The bounds cut the cells at random places.
    const Vector2d low(-1.5 - 0.1 * unit(generator), -1 - 0.1 * unit(generator));
    const Vector2d high(1.5 + 0.1 * unit(generator), 1 + 0.1 * unit(generator));
    models::Environment environment = FloorOf(low, high);
    const double thickness = 0.05 + 0.2 * unit(generator);
    Add("wall", {-thickness / 2, low.y(), 0}, {thickness / 2, high.y(), 2.2}, false, &environment);
    const FloodResult flood = Flood(environment, {-1, 0, 0}, {1, 0, 0});
    EXPECT_FALSE(flood.route_may_exist) << trial;
    EXPECT_EQ(flood.barrier.closed_by, std::vector<std::string>{"wall"});
    EXPECT_LT(flood.barrier.closest.x(), 0);
    EXPECT_LT(flood.barrier.closest.x() + flood.barrier.distance - 1, 0.05);
    ASSERT_EQ(flood.barrier.reached.size(), 1u);
    for (const auto& outline : flood.barrier.reached[0].outlines) {
      for (const Vector2d& corner : outline) EXPECT_LT(corner.x(), 0) << trial;
    }
    // Now there is room for the pelvis, but for nothing else of the robot.
    environment.obstacles.back().shape.size.y() -= 0.5;
    EXPECT_TRUE(Flood(environment, {-1, 0, 0}, {1, 0, 0}).route_may_exist) << trial;
  }
}

/// The route leads neither over the floor's corners nor under it.
TEST_F(NecessaryFloodTest, NoRouteLeadsAroundAFloorAsLongAsTheBounds) {
  const Vector2d low(-2.5, -2), high(2.5, 2);
  models::Environment environment;
  environment.bounds = Eigen::AlignedBox2d(low, high);
  Add("floor", {low.x(), low.y(), -0.5}, {high.x(), high.y(), 0}, true, &environment);
  Add("wall", {-0.1, low.y(), 0}, {0.1, high.y(), 2.2}, false, &environment);
  EXPECT_FALSE(Flood(environment, {-1.4, 0, 0}, {1.4, 0, 0}).route_may_exist);
  environment.obstacles.back().shape.size.z() -= 0.5;  // half of it at the foot
  EXPECT_TRUE(Flood(environment, {-1.4, 0, 0}, {1.4, 0, 0}).route_may_exist);
}

TEST_F(NecessaryFloodTest, StancesOnTheBoundsAreReached) {
  const models::Environment environment = FloorOf({-1, -1}, {1, 1});
  for (const double yaw : {0.0, 1.6, 3.1, -1.6}) {
    EXPECT_TRUE(Flood(environment, {-1, -1, yaw}, {1, 1, yaw}).route_may_exist);
    EXPECT_TRUE(Flood(environment, {1, 1, yaw}, {-1, 1, yaw}).route_may_exist);
  }
}

/// A flight of the pelvis alone, from stance to stance within the bounds, often along them.
std::vector<Isometry3d> RandomFlight(const Eigen::AlignedBox2d& bounds, const Isometry3d& start,
                                     const Isometry3d& goal, std::mt19937* generator) {
  std::uniform_real_distribution<double> unit(-1, 1);
  std::vector<Isometry3d> way = {start};
  for (int i = 0; i < 3; ++i) {
    Isometry3d X_WR = Isometry3d::Identity();
    X_WR.translation() << 1.2 * unit(*generator), 1.6 * unit(*generator),
        0.6 + 0.3 * unit(*generator);
    X_WR.translation().head<2>() =
        X_WR.translation().head<2>().cwiseMax(bounds.min()).cwiseMin(bounds.max());
    X_WR.linear() = Eigen::Quaterniond::UnitRandom().toRotationMatrix();
    way.push_back(X_WR);
  }
  way.push_back(goal);
  std::vector<Isometry3d> flight;
  for (size_t i = 0; i + 1 < way.size(); ++i) {
    constexpr int kSamples = 200;
    for (int k = 0; k <= kSamples; ++k) {
      flight.push_back(Interpolate(way[i], way[i + 1], static_cast<double>(k) / kSamples));
    }
  }
  return flight;
}

/// Walls and boxes that the pelvis passes with 15 mm to spare, however narrow the way is. Where the
/// pelvis has a way, there must be no proof.
TEST_F(NecessaryFloodTest, ARouteOfThePelvisIsNeverRuledOut) {
  std::mt19937 generator(6);
  std::srand(6);  // for Eigen's random orientations
  std::uniform_real_distribution<double> unit(0, 1);
  const models::Link& pelvis = DrcHubo1().links[DrcHubo1().pelvis_shape_link];
  const NominalStance& stance = model_.gaits[0]->stance;
  int kept = 0, proofs = 0;
  for (int trial = 0; trial < 12; ++trial) {
    const models::Environment floor = FloorOf({-1.5, -1.2}, {1.5, 1.2});
    const PlanarPose start{-1.2, 2 * unit(generator) - 1, 6 * unit(generator)};
    const PlanarPose goal{1.2, 2 * unit(generator) - 1, 6 * unit(generator)};
    const std::vector<Isometry3d> flight =
        RandomFlight(floor.bounds, stance.RootPose(start, 0), stance.RootPose(goal, 0), &generator);
    models::Environment environment = floor;
    models::Environment everything = floor;
    // A wall of bricks across the room, and boxes before and behind it.
    constexpr int kAcross = 12, kUp = 11, kBoxes = 60;
    for (int i = 0; i < kAcross * kUp + kBoxes; ++i) {
      const bool is_brick = i < kAcross * kUp;
      const Vector3d centre =
          is_brick
              ? Vector3d(0, -1.1 + 0.2 * (i % kAcross), 0.1 + 0.2 * (i / kAcross))
              : Vector3d(2 * unit(generator) - 1, 2.4 * unit(generator) - 1.2, 2 * unit(generator));
      const Vector3d half =
          is_brick ? Vector3d(0.05 + 0.1 * unit(generator), 0.1, 0.1)
                   : Vector3d(0.02 + 0.2 * unit(generator), 0.02 + 0.2 * unit(generator),
                              0.02 + 0.2 * unit(generator));
      models::Environment single;
      single.bounds = floor.bounds;
      Add("box", centre - half, centre + half, false, &single);
      everything.obstacles.push_back(single.obstacles.front());
      models::CollisionChecker checker(single);
      const bool is_free = std::all_of(flight.begin(), flight.end(), [&](const Isometry3d& X_WR) {
        return std::all_of(pelvis.shapes.begin(), pelvis.shapes.end(), [&](const auto& posed) {
          return checker.IsFree(models::PreparedShape(posed.shape), X_WR * posed.X_PS, 0.015);
        });
      });
      if (!is_free) continue;
      environment.obstacles.push_back(single.obstacles.front());
      ++kept;
    }
    EXPECT_TRUE(Flood(environment, start, goal).route_may_exist) << trial;
    proofs += !Flood(everything, start, goal).route_may_exist;
  }
  EXPECT_GT(kept, 1000);
  EXPECT_EQ(proofs, 12) << "with all its bricks the wall closes the room";
}

/// Walls with gaps of random width. Where a search finds a route, there must be no proof.
TEST_F(NecessaryFloodTest, ARouteThatASearchFindsIsNeverRuledOut) {
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> unit(0, 1);
  int routes = 0, proofs = 0;
  for (int trial = 0; trial < 30; ++trial) {
    const Eigen::AlignedBox2d bounds(Vector2d(-2, -1.5), Vector2d(2, 1.5));
    models::Environment environment = FloorOf(bounds.min(), bounds.max());
    for (const double x : {-0.6, 0.6}) {
      const double gap = std::max(0.0, 3 * unit(generator) - 0.5);
      const double middle = 1.6 * unit(generator) - 0.8;
      const double low = middle - gap / 2, high = middle + gap / 2;
      if (low > -1.5) Add("right", {x - 0.05, -1.5, 0}, {x + 0.05, low, 2}, false, &environment);
      if (high < 1.5) Add("left", {x - 0.05, high, 0}, {x + 0.05, 1.5, 2}, false, &environment);
    }
    const models::GroundMap ground(environment);
    const World world{&environment, &ground};
    const auto space = std::make_shared<PelvisPoseSpace>(bounds, ground.levels(), 0.137);
    std::vector<std::shared_ptr<QuasiStaticAction>> gaits;
    for (int gait = 0; gait < 2; ++gait) {
      gaits.push_back(std::make_shared<QuasiStaticAction>(model_, gait, world, space, 0.25));
    }
    const std::vector<std::shared_ptr<SearchedManoeuvre>> manoeuvres;
    const GroundedStance start{0, {-1.5, 0, 0}, 0}, goal{0, {1.5, 0, 0}, 0};
    LatticeSearch search({&model_, &gaits, &manoeuvres}, start, {goal},
                         {.step = 0.2, .headings = 8});
    std::vector<graph::PathEdge> route;
    if (search.Advance(100000, {}) == LatticeSearch::Status::kFound) route = search.Route();
    const bool found =
        !route.empty() && std::all_of(route.begin(), route.end(), [&](const auto& e) {
          return bounds.contains(Vector2d(e.points.to.template head<2>()));
        });
    const bool may_exist = FloodNecessary(model_, world, start, {goal}, 0.1).route_may_exist;
    EXPECT_TRUE(may_exist || !found) << trial;
    routes += found;
    proofs += !may_exist;
  }
  EXPECT_GT(routes, 3);
  EXPECT_GT(proofs, 3);
}

}  // namespace
}  // namespace possibility::actions
