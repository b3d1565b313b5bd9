#include "actions/rollout/rollout_reference.h"

#include <gtest/gtest.h>

#include "actions/footsteps/footstep_motion.h"
#include "actions/footsteps/footstep_plan.h"
#include "dynamics/tree/tree_kinematics.h"
#include "tests/actions/footsteps/uneven_world.h"

namespace possibility::actions {
namespace {

using Eigen::Vector3d;

constexpr double kEdge = 0.3;  // m: x at which the upper level begins
constexpr double kUpper = 0.05;

/// Steps onto a level 5 cm higher, and the configuration at their start.
class StepOntoALevel {
 public:
  StepOntoALevel() {
    world_.Ground(-3, kEdge, 0).Ground(kEdge, 4, kUpper);
    const NominalStance& stance = WalkingHubo().gaits[0]->stance;
    FootstepSearch search(WalkingHubo(), 0, world_.Built(), UnevenWorld::StanceAt(0),
                          {UnevenWorld::StanceAt(0.8, kUpper)},
                          FootstepLimits::Of(DrcHubo1(), stance));
    while (search.Advance(100) == FootstepSearch::Status::kSearching) {
    }
    segment_.action = "walk";
    segment_.phases = FootstepMotion(DrcHubo1(), stance).Build({{0, 0, 0}, 0}, search.steps(), {});
  }

  /// Whether the right sole's foremost or hindmost points touch the upper level when they are at x.
  bool Touches(bool foremost, double x) const {
    const RolloutReference reference(segment_, DrcHubo1(), *world_.ground, {}, {});
    const models::RobotModel& robot = reference.model()->tree();
    Eigen::VectorXd q = reference.Configuration(0);
    dynamics::TreeKinematics kinematics(robot);
    kinematics.SetPosition(reference.TreeConfiguration(0));
    const Vector3d origin = segment_.phases.front().knots.front().q.segment<3>(4);
    for (const dynamics::RolloutContact& contact : reference.Contacts()) {
      const bool is_ahead = contact.point.p_L.x() > 0;
      if (contact.name.find("right_sole") != 0 || is_ahead != foremost) continue;
      if (std::abs(contact.offset + origin.z() - kUpper) > 1e-9) continue;
      const Vector3d p = origin + kinematics.Position(contact.point.link, contact.point.p_L);
      q[4] = reference.Configuration(0)[4] + x - p.x();
      return contact.lands(q);
    }
    ADD_FAILURE() << "the upper level is not used";
    return false;
  }

 private:
  UnevenWorld world_;
  Segment segment_;
};

TEST(RolloutReferenceTest, ASoleBearsOnAnEdgeThatItOverlaps) {
  const StepOntoALevel step;
  EXPECT_TRUE(step.Touches(true, kEdge + 0.005));
  EXPECT_TRUE(step.Touches(false, kEdge + 0.005));
  EXPECT_TRUE(step.Touches(false, kEdge - 0.005)) << "the rest of the sole is on the level";
  EXPECT_FALSE(step.Touches(false, kEdge - 0.02));
}

/// Toes that pass beside an edge with the sole behind them touch nothing.
TEST(RolloutReferenceTest, ASoleBesideAnEdgeDoesNotBearOnIt) {
  const StepOntoALevel step;
  EXPECT_FALSE(step.Touches(true, kEdge - 0.005));
  EXPECT_FALSE(step.Touches(true, kEdge - 0.02));
}

}  // namespace
}  // namespace possibility::actions
