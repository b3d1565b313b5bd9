#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "actions/footsteps/footstep_plan.h"
#include "actions/planner/planner.h"
#include "tests/actions/footsteps/uneven_world.h"

namespace possibility::actions {
namespace {

/// A floor, random ground, and a floor again. Ground: strips and boards at random heights, tilted
/// or not, with gaps between them.
class RandomTerrain {
 public:
  explicit RandomTerrain(unsigned seed) : random_(seed) {
    world_.Ground(-3, 0, 0);
    const double length = Uniform(0.8, 2);
    const double roughness = Uniform(0, 0.14);
    const double tilt = random_() % 2 == 0 ? 0 : Uniform(0, 0.3);
    for (double x = 0; x < length;) {
      const double size = Uniform(0.25, 0.5);
      if (random_() % 2 == 0) {
        AddStrip(x, size, roughness, tilt);
      } else {
        AddBoards(x, size, roughness, tilt);
      }
      x += size + (random_() % 3 == 0 ? Uniform(0, 0.12) : 0);
      end_ = x;
    }
    world_.Ground(end_, end_ + 2.5, 0);
    world_.environment.bounds = {Eigen::Vector2d(-2, -0.8), Eigen::Vector2d(end_ + 2, 0.8)};
  }

  double goal_x() const { return end_ + 0.8; }
  UnevenWorld& world() { return world_; }

  models::Scenario Scenario() const {
    models::Scenario scenario = ShippedScenario("crack");
    scenario.environment = world_.environment;
    scenario.start.x = -0.8;
    scenario.start.y = 0;
    scenario.goals[0].x = goal_x();
    scenario.goals[0].y = 0;
    return scenario;
  }

 private:
  double Uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }

  void AddStrip(double x, double size, double roughness, double tilt) {
    Add({size, 1.6, 0.1}, {x + size / 2, 0, Uniform(-roughness, roughness) - 0.05}, tilt);
  }
  void AddBoards(double x, double size, double roughness, double tilt) {
    for (const double y : {-0.22, 0.22}) {
      Add({size, 0.42, 0.06}, {x + size / 2, y, Uniform(-roughness, roughness) - 0.03}, tilt);
    }
  }
  void Add(const Eigen::Vector3d& size, const Eigen::Vector3d& position, double tilt) {
    world_.Add(size, position, true);
    const Eigen::Vector3d axis = Eigen::Vector3d(Uniform(-1, 1), Uniform(-1, 1), 0).normalized();
    world_.environment.obstacles.back().X_WO.linear() =
        Eigen::AngleAxisd(Uniform(0, tilt), axis).toRotationMatrix();
  }

  std::mt19937 random_;
  UnevenWorld world_;
  double end_ = 0;
};

/// Searches footsteps with an effort of minutes.
bool BruteForceFindsSteps(RandomTerrain* terrain) {
  const models::Environment environment = terrain->world().environment;
  UnevenWorld& world = terrain->world();
  world.Built();
  world.environment.bounds = environment.bounds;
  FootstepSearch search(WalkingHubo(), 0, world.world, UnevenWorld::StanceAt(-0.8),
                        {UnevenWorld::StanceAt(terrain->goal_x())},
                        FootstepLimits::Of(DrcHubo1(), WalkingHubo().gaits[0]->stance));
  search.most_states = 100000;
  auto status = FootstepSearch::Status::kSearching;
  while (status == FootstepSearch::Status::kSearching) status = search.Advance(1000);
  return status == FootstepSearch::Status::kFound;
}

/// Plans on a terrain; counts what was found.
struct Tally {
  int found = 0;
  int none = 0;
  int none_confirmed = 0;
  int none_despite_steps = 0;  ///< steps exist, but no motion was made of them

  void Plan(unsigned seed, bool confirms) {
    RandomTerrain terrain(seed);
    PlanRequest request;
    request.library = DrcHubo1Library();
    request.time_limit = 60;
    const PlanResult result = PlanTraversal(DrcHubo1(), terrain.Scenario(), request);
    if (result.status == PlanStatus::kFound) {
      EXPECT_TRUE(result.verification.accepted()) << "terrain " << seed;
      ++found;
      return;
    }
    EXPECT_NE(result.status, PlanStatus::kTimeLimit) << "terrain " << seed;
    ++none;
    if (!confirms) return;
    ++(BruteForceFindsSteps(&terrain) ? none_despite_steps : none_confirmed);
  }
};

TEST(RandomTerrain, IsWalkedOrRefusedWithoutATimeLimit) {
  Tally tally;
  for (unsigned seed = 1; seed <= 3; ++seed) tally.Plan(seed, false);
  EXPECT_GT(tally.found, 0);
}

TEST(RandomTerrainLong, IsWalkedOrRefusedAndBruteForceAgrees) {
  Tally tally;
  for (unsigned seed = 1; seed <= 200; ++seed) tally.Plan(seed, tally.none < 20);
  RecordProperty("found", tally.found);
  RecordProperty("none", tally.none);
  std::printf("found %d, none %d; of these, steps do not exist on %d and do on %d\n", tally.found,
              tally.none, tally.none_confirmed, tally.none_despite_steps);
  EXPECT_GT(tally.found, 100);
  EXPECT_LE(tally.none_despite_steps, tally.none_confirmed);
}

}  // namespace
}  // namespace possibility::actions
