#include <gtest/gtest.h>

#include <cstdio>
#include <optional>
#include <random>
#include <vector>

#include "actions/footsteps/footstep_plan.h"
#include "actions/footsteps/planned_steps.h"
#include "actions/wholebody/motion_error.h"
#include "tests/actions/footsteps/random_terrain.h"

namespace possibility::actions {
namespace {

using Eigen::Isometry3d;

/// Walking on random terrain: what meets C_S must be possible, and what is possible must meet C_N.
class ConditionsOnTerrain {
 public:
  explicit ConditionsOnTerrain(unsigned seed) : terrain_(seed), random_(seed) {
    const models::Environment environment = terrain_.world().environment;
    terrain_.world().Built();
    terrain_.world().environment.bounds = environment.bounds;
    context_.model = &WalkingHubo();
    context_.world = world();
    context_.space =
        std::make_shared<PelvisPoseSpace>(environment.bounds, world().ground->levels(), 0.137);
    walk_ = std::make_shared<QuasiStaticAction>(WalkingHubo(), 0, world(), context_.space, 0.25);
    context_.gaits = {walk_};
  }

  /// Numbers of poses that meet C_S, and of those that meet C_N.
  std::pair<int, int> CompareConditions(int samples) {
    int sufficient = 0, necessary = 0;
    for (int i = 0; i < samples; ++i) {
      const graph::Point v = AnyPose(i % 2 == 0);
      const bool is_possible = walk_->CS(v);
      const bool may_be = walk_->CN(v);
      EXPECT_TRUE(may_be || !is_possible) << i;
      sufficient += is_possible ? 1 : 0;
      necessary += may_be ? 1 : 0;
    }
    return {sufficient, necessary};
  }

  /// Number of knots of steps over the terrain; 0 if there are none.
  int CompareMotion() {
    const graph::Point from = PointOf(UnevenWorld::StanceAt(-0.8));
    const graph::Point to = PointOf(UnevenWorld::StanceAt(terrain_.goal_x()));
    std::vector<Phase> motion;
    try {
      motion = PlannedSteps(context_, 0).Motion({from, to}, {});
    } catch (const MotionError&) {
      return 0;
    }
    int knots = 0;
    for (const Phase& phase : motion) {
      for (const Knot& knot : phase.knots) {
        const Eigen::Quaterniond turn(knot.q[0], knot.q[1], knot.q[2], knot.q[3]);
        EXPECT_TRUE(walk_->CN(ToPoint(Eigen::Translation3d(knot.q.segment<3>(4)) * turn)))
            << "at " << knot.t << " s";
        ++knots;
      }
    }
    return knots;
  }

 private:
  const World& world() { return terrain_.world().world; }

  static graph::Point PointOf(const GroundedStance& at) {
    return ToPoint(WalkingHubo().gaits[0]->stance.RootPose(at.pose, at.z));
  }

  double Uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }

  /// On the terrain: a nominal stance on one of its levels, or any pose of the pelvis.
  graph::Point AnyPose(bool is_stance) {
    const std::vector<double>& levels = world().ground->levels();
    const double x = Uniform(-1.5, terrain_.goal_x() + 0.5);
    GroundedStance stance = UnevenWorld::StanceAt(x, levels[random_() % levels.size()]);
    stance.pose.y = Uniform(-0.5, 0.5);
    stance.pose.yaw = Uniform(-3, 3);
    if (is_stance) return PointOf(stance);
    Isometry3d X_WR = WalkingHubo().gaits[0]->stance.RootPose(stance.pose, Uniform(-0.5, 1));
    X_WR.rotate(Eigen::AngleAxisd(Uniform(-1, 1), Eigen::Vector3d::UnitY()));
    return ToPoint(X_WR);
  }

  RandomTerrain terrain_;
  std::mt19937 random_;
  PlanningContext context_;
  std::shared_ptr<QuasiStaticAction> walk_;
};

/// Over terrains `first` to `last`.
void ExpectConditionsAgree(unsigned first, unsigned last) {
  int sufficient = 0, necessary = 0, walked = 0;
  for (unsigned seed = first; seed <= last; ++seed) {
    SCOPED_TRACE(seed);
    ConditionsOnTerrain terrain(seed);
    const auto [s, n] = terrain.CompareConditions(200);
    sufficient += s;
    necessary += n;
    walked += terrain.CompareMotion() > 0 ? 1 : 0;
  }
  std::printf("C_S %d, C_N %d of %u poses; steps over %d of %u terrains\n", sufficient, necessary,
              200 * (last - first + 1), walked, last - first + 1);
  EXPECT_GT(sufficient, 0);
  EXPECT_LT(sufficient, necessary);
  EXPECT_GT(2 * walked, static_cast<int>(last - first));
}

TEST(ConditionsOnRandomTerrain, PossibleIsBetweenSufficientAndNecessary) {
  ExpectConditionsAgree(1001, 1006);
}

TEST(ConditionsOnRandomTerrainLong, PossibleIsBetweenSufficientAndNecessary) {
  ExpectConditionsAgree(1007, 1506);
}

}  // namespace
}  // namespace possibility::actions
