#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>

#include "actions/footsteps/footstep_plan.h"
#include "actions/footsteps/planned_steps.h"
#include "actions/motion/motion_schedule.h"
#include "dynamics/tree/tree_kinematics.h"
#include "tests/actions/footsteps/uneven_world.h"
#include "tests/actions/standing_plan.h"

namespace possibility::actions {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Up and down again by `degrees`.
UnevenWorld Ridge(double degrees) {
  const double rise = 0.8 * std::tan(degrees * M_PI / 180);
  UnevenWorld world;
  world.Ground(-3, 0.3, 0)
      .Slope({0.3, 0}, {1.1, rise})
      .Ground(1.1, 1.7, rise)
      .Slope({1.7, rise}, {2.5, 0})
      .Ground(2.5, 6, 0);
  return world;
}

/// Steps over the ridge, and the motion of them.
class OverARidge {
 public:
  explicit OverARidge(double degrees) : world_(Ridge(degrees)) {
    world_.Built();
    search_.emplace(WalkingHubo(), 0, world_.world, start(), std::vector<GroundedStance>{goal()},
                    FootstepLimits::Of(DrcHubo1(), stance()));
    auto status = FootstepSearch::Status::kSearching;
    while (status == FootstepSearch::Status::kSearching) status = search_->Advance(100);
    is_found_ = status == FootstepSearch::Status::kFound;
  }

  static const NominalStance& stance() { return WalkingHubo().gaits[0]->stance; }
  static GroundedStance start() { return UnevenWorld::StanceAt(-0.4); }
  static GroundedStance goal() { return UnevenWorld::StanceAt(3.2); }
  bool is_found() const { return is_found_; }
  const std::vector<Footstep>& steps() const { return search_->steps(); }
  const UnevenWorld& world() const { return world_; }

  /// As a job plans it: steps beyond the robot are replaced.
  std::vector<Phase> Motion() const {
    PlanningContext context;
    context.model = &WalkingHubo();
    context.world = world_.world;
    context.space = std::make_shared<PelvisPoseSpace>(world_.environment.bounds,
                                                      world_.ground->levels(), 0.137);
    context.gaits = {
        std::make_shared<QuasiStaticAction>(WalkingHubo(), 0, world_.world, context.space, 0.25)};
    return PlannedSteps(context, 0).Motion({PointOf(start()), PointOf(goal())}, {});
  }

 private:
  static graph::Point PointOf(const GroundedStance& at) {
    return ToPoint(stance().RootPose(at.pose, at.z));
  }

  UnevenWorld world_;
  std::optional<FootstepSearch> search_;
  bool is_found_ = false;
};

/// Of 15 degrees; planned once.
const OverARidge& SharedRidge() {
  static const OverARidge ridge(15);
  return ridge;
}
const std::vector<Phase>& SharedMotion() {
  static const std::vector<Phase> motion = SharedRidge().Motion();
  return motion;
}

TEST(Slope, FeetLieOnTheirGround) {
  const OverARidge& ridge = SharedRidge();
  ASSERT_TRUE(ridge.is_found());
  int on_slopes = 0;
  for (const Footstep& step : ridge.steps()) {
    const Eigen::Isometry3d X_WS = FrameOf(ridge.stance(), step.limb, step.to);
    on_slopes += step.to.IsLevel() ? 0 : 1;
    for (const Vector2d& p : ridge.stance().bearing_points[step.limb]) {
      const Vector3d there = X_WS * Vector3d(p.x(), p.y(), 0);
      const auto planes =
          ridge.world().ground->PlanesAt(there.head<2>(), there.z() - 1e-9, there.z() + 1e-9);
      ASSERT_EQ(planes.size(), 1u);
      EXPECT_GE(ridge.world().ground->Clearance(planes[0], there.head<2>()), 0.01 - 1e-6);
    }
  }
  EXPECT_GE(on_slopes, 4);
}

TEST(Slope, NobodyStandsWhereFrictionDoesNotHold) {
  EXPECT_TRUE(OverARidge(20).is_found());
  EXPECT_FALSE(OverARidge(32).is_found());  // the usable coefficient is 0.85 times 0.7
}

TEST(Slope, SolesAreFlatOnTheSlopeThroughoutTheMotion) {
  const OverARidge& ridge = SharedRidge();
  dynamics::TreeKinematics kinematics(DrcHubo1());
  for (const Phase& phase : SharedMotion()) {
    for (const Knot& knot : phase.knots) {
      kinematics.SetPosition(knot.q);
      for (const std::string& name : phase.contacts) {
        const auto patch =
            std::find_if(DrcHubo1().contacts.begin(), DrcHubo1().contacts.end(),
                         [&](const models::ContactPatch& contact) { return contact.name == name; });
        for (const Vector3d& p_L : patch->points) {
          const Vector3d p = kinematics.Position(patch->link, p_L);
          EXPECT_FALSE(
              ridge.world().ground->PlanesAt(p.head<2>(), p.z() - 1e-8, p.z() + 1e-8).empty());
        }
      }
    }
  }
}

// C_N must not say no where the robot can be.
TEST(Slope, TheWholeMotionMeetsTheNecessaryConditions) {
  const OverARidge& ridge = SharedRidge();
  const auto space = std::make_shared<PelvisPoseSpace>(ridge.world().environment.bounds,
                                                       ridge.world().ground->levels(), 0.137);
  const QuasiStaticAction walk(WalkingHubo(), 0, ridge.world().world, space, 0.25);
  for (const Phase& phase : SharedMotion()) {
    for (const Knot& knot : phase.knots) {
      const Eigen::Quaterniond turn(knot.q[0], knot.q[1], knot.q[2], knot.q[3]);
      EXPECT_TRUE(walk.CN(ToPoint(Eigen::Translation3d(knot.q.segment<3>(4)) * turn)))
          << "at " << knot.t << " s";
    }
  }
}

/// The plan of steps over the ridge, as the verifier reads it.
testing::VerifierSubject PlanOver(const OverARidge& ridge, const std::vector<Phase>& motion) {
  testing::VerifierSubject subject = testing::PlanWithoutMotion(DrcHubo1().file.string());
  subject.scenario.environment = ridge.world().environment;
  subject.scenario.start.x = ridge.start().pose.x;
  subject.scenario.goals[0].x = 3.2;
  subject.plan.segments.push_back({"walk", motion});
  subject.plan.schedule = ScheduleOfMotion(subject.robot, subject.plan.segments);
  return subject;
}

testing::VerifierSubject SharedPlan() { return PlanOver(SharedRidge(), SharedMotion()); }

void ExpectAccepted(const testing::VerifierSubject& subject) {
  for (const Violation& violation : testing::Verified(subject).violations) {
    ADD_FAILURE() << ToString(violation.kind) << ": " << violation.quantity << ", "
                  << violation.value << " (limit " << violation.limit << ") at " << violation.time;
  }
}

TEST(Slope, TheVerifierAcceptsTheMotion) { ExpectAccepted(SharedPlan()); }

/// The steepest one: the loads that every point bears at least leave too little friction to balance
/// with, unless they are less than elsewhere.
TEST(Slope, OneOfTwentyFiveDegreesIsCrossed) {
  const OverARidge ridge(25);
  ASSERT_TRUE(ridge.is_found());
  ExpectAccepted(PlanOver(ridge, ridge.Motion()));
}

TEST(Slope, TheVerifierWantsFrictionAlongTheSlope) {
  testing::VerifierSubject icy = SharedPlan();
  icy.robot.friction = 0.2;  // less than tan(15 degrees)
  EXPECT_NE(testing::Find(testing::Verified(icy), ViolationKind::kFriction), nullptr);
}

TEST(Slope, TheVerifierWantsTheGroundWhereTheFeetAre) {
  testing::VerifierSubject moved = SharedPlan();
  models::Obstacle& slope = moved.scenario.environment.obstacles[1];
  slope.X_WO.linear() =
      Eigen::AngleAxisd(0.01, Vector3d::UnitY()).toRotationMatrix() * slope.X_WO.linear();
  EXPECT_NE(testing::Find(testing::Verified(moved), ViolationKind::kContactGround), nullptr);
}

}  // namespace
}  // namespace possibility::actions
