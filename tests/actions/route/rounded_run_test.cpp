// Runs with rounded bends: quicker where there is room, and sharp where there is none.

#include "actions/route/rounded_run.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "actions/route/gait_run.h"
#include "actions/wholebody/motion_collision.h"
#include "dynamics/tree/tree_kinematics.h"
#include "tests/actions/drchubo1.h"

namespace possibility::actions {
namespace {

using Eigen::Vector3d;

models::Obstacle Box(const Vector3d& size, const Vector3d& middle, bool is_ground) {
  models::Obstacle box;
  box.name = is_ground ? "floor" : "pillar";
  box.shape = models::Shape::Box(size);
  box.X_WO.translation() = middle;
  box.is_ground = is_ground;
  return box;
}

/// Two ways of 2 m, the second to the left of the first, with a turn between them.
class RoundedRunTest : public ::testing::Test {
 protected:
  RoundedRunTest() {
    const int walk = DrcHubo1Locomotion().GaitIndex("walk");
    for (std::size_t i = 0; i + 1 < corners_.size(); ++i) {
      RouteLeg leg;
      leg.gait = walk;
      leg.from = corners_[i];
      leg.to = corners_[i + 1];
      route_.push_back(leg);
    }
  }

  void AddFloor(const Vector3d& size, const Vector3d& middle) {
    environment_.obstacles.push_back(Box(size, middle, true));
  }
  void AddWideFloor() { AddFloor({9, 9, 0.5}, {1, 1, -0.25}); }
  /// The corner of a wall inside the bend, `gap` from either way.
  void AddPillar(double gap) {
    environment_.obstacles.push_back(
        Box({2 - gap, 2 - gap, 2}, {1 - gap / 2, gap + (2 - gap) / 2, 1}, false));
  }

  using Motion = std::vector<std::vector<Phase>>;
  std::optional<Motion> Rounded() const {
    const models::CollisionChecker checker(DrcHubo1(), environment_);
    const models::GroundMap ground(environment_, DrcHubo1().friction);
    return RoundedFlow(DrcHubo1Locomotion(), {environment_, checker, ground}, route_, 0, Legs(), {},
                       {});
  }
  Motion Sharp() const {
    return FlowAlong(DrcHubo1Locomotion(), route_, 0, Legs(),
                     StraightLinesOf(DrcHubo1Locomotion(), route_, 0, Legs()), {}, {});
  }
  int Legs() const { return static_cast<int>(route_.size()); }

  static double Duration(const Motion& motion) {
    double duration = 0;
    for (const auto& leg : motion) duration += leg.back().knots.back().t;
    return duration;
  }

  /// How near the root comes to the corner, from above, m.
  double NearestToCorner(const Motion& motion) const {
    double nearest = 10;
    for (const auto& leg : motion) {
      for (const Phase& phase : leg) {
        for (const Knot& knot : phase.knots) {
          const Eigen::Vector2d place = knot.q.segment<2>(4);
          nearest = std::min(nearest, (place - corners_[1].position()).norm());
        }
      }
    }
    return nearest;
  }

  void ExpectEndsInStances(const Motion& motion) const {
    const NominalStance& stance = DrcHubo1Locomotion().gaits[route_.front().gait]->stance;
    const Knot& first = motion.front().front().knots.front();
    const Knot& last = motion.back().back().knots.back();
    const auto off = [&](const Knot& knot, const PlanarPose& pose) {
      return (knot.q.segment<3>(4) - stance.RootPose(pose, 0).translation()).norm();
    };
    EXPECT_LT(off(first, corners_.front()), 1e-6);
    EXPECT_LT(off(last, corners_.back()), 1e-6);
    EXPECT_LT(first.v.norm() + last.v.norm(), 1e-6);
  }

  bool HitsNothing(const Motion& motion) const {
    const models::CollisionChecker checker(DrcHubo1(), environment_);
    return std::all_of(motion.begin(), motion.end(), [&](const auto& leg) {
      return FirstHit(DrcHubo1(), environment_, checker, leg, {}).empty();
    });
  }

  std::vector<PlanarPose> corners_ = {{}, {2, 0, 0}, {2, 0, M_PI / 2}, {2, 2, M_PI / 2}};
  Route route_;
  models::Environment environment_;
};

TEST_F(RoundedRunTest, ABendWithRoomIsCutAndTakesLessTime) {
  AddWideFloor();
  const std::optional<Motion> rounded = Rounded();
  ASSERT_TRUE(rounded);
  EXPECT_EQ(static_cast<int>(rounded->size()), Legs());
  ExpectEndsInStances(*rounded);
  EXPECT_LT(Duration(*rounded), Duration(Sharp()) - 1);
  EXPECT_GT(NearestToCorner(*rounded), 0.15);
}

TEST_F(RoundedRunTest, BendsAreNarrowerWhereSomethingIsInTheWay) {
  AddWideFloor();
  const double wide = NearestToCorner(Rounded().value());
  AddPillar(0.5);
  const std::optional<Motion> narrow = Rounded();
  ASSERT_TRUE(narrow);
  EXPECT_TRUE(HitsNothing(*narrow));
  EXPECT_LT(NearestToCorner(*narrow), wide - 0.03);
}

TEST_F(RoundedRunTest, FeetStayOnTheGround) {
  // An L whose inner edges are 0.3 m from both ways.
  AddFloor({3.6, 0.6, 0.5}, {1, 0, -0.25});
  AddFloor({0.6, 3.6, 0.5}, {2, 1.2, -0.25});
  const std::optional<Motion> rounded = Rounded();
  ASSERT_TRUE(rounded);
  dynamics::TreeKinematics kinematics(DrcHubo1());
  for (const auto& leg : *rounded) {
    for (const Phase& phase : leg) {
      kinematics.SetPosition(phase.knots.front().q);
      for (const std::string& name : phase.contacts) {
        const models::ContactPatch& patch = DrcHubo1().contacts[DrcHubo1().ContactIndex(name)];
        for (const Vector3d& point : patch.points) {
          const Vector3d p = kinematics.X_WL()[patch.link] * point;
          const bool is_on_first = std::abs(p.y()) < 0.3 && p.x() < 2.8;
          const bool is_on_second = std::abs(p.x() - 2) < 0.3 && p.y() < 3;
          EXPECT_TRUE(is_on_first || is_on_second) << p.transpose();
        }
      }
    }
  }
}

TEST_F(RoundedRunTest, ThereIsNoneWithoutRoom) {
  AddWideFloor();
  AddPillar(0.1);
  EXPECT_FALSE(Rounded());
}

TEST_F(RoundedRunTest, ThereIsNoneOfASingleWay) {
  AddWideFloor();
  route_.resize(1);
  EXPECT_FALSE(Rounded());
}

TEST_F(RoundedRunTest, StopsWhenCancelled) {
  AddWideFloor();
  const models::CollisionChecker checker(DrcHubo1(), environment_);
  const models::GroundMap ground(environment_, DrcHubo1().friction);
  const CancellationToken cancellation([] { return false; });
  EXPECT_THROW(RoundedFlow(DrcHubo1Locomotion(), {environment_, checker, ground}, route_, 0, Legs(),
                           {}, cancellation),
               Cancelled);
}

}  // namespace
}  // namespace possibility::actions
