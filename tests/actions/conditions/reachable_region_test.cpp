#include "actions/conditions/reachable_region.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "dynamics/tree/tree_kinematics.h"
#include "tests/actions/drchubo1.h"

namespace possibility::actions {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

Vector3d AnyDirection(std::mt19937* random) {
  std::normal_distribution<double> normal;
  return Vector3d(normal(*random), normal(*random), normal(*random)).normalized();
}

/// Contact points of DRC-HUBO1's patches in random postures, root frame.
class RandomPostures {
 public:
  explicit RandomPostures(unsigned seed) : random_(seed), kinematics_(DrcHubo1()) {}

  void Next() {
    const models::RobotModel& robot = DrcHubo1();
    Eigen::VectorXd q = Eigen::VectorXd::Zero(robot.nq());
    q[0] = 1;
    for (int j = 0; j < robot.num_joints(); ++j) {
      const models::Joint& joint = robot.joints[j];
      // Extreme places are at limits more often than not.
      const int corner = static_cast<int>(random_() % 4);
      q[7 + j] = corner == 0 ? joint.lower
                 : corner == 1
                     ? joint.upper
                     : std::uniform_real_distribution<double>(joint.lower, joint.upper)(random_);
    }
    kinematics_.SetPosition(q);
  }
  Vector3d Point(const models::ContactPatch& patch, std::size_t i) const {
    return kinematics_.Position(patch.link, patch.points[i]);
  }
  std::mt19937* random() { return &random_; }

 private:
  std::mt19937 random_;
  dynamics::TreeKinematics kinematics_;
};

TEST(SupportBound, IsAboveThatOfRandomPointsAndCloseToIt) {
  std::mt19937 random(1);
  for (int set = 0; set < 50; ++set) {
    std::vector<Vector3d> points;
    const Vector3d offset = 0.5 * AnyDirection(&random);
    for (int i = 0; i < 30; ++i) points.push_back(offset + AnyDirection(&random));
    const auto exact = [&](const Vector3d& d) {
      double most = -1e9;
      for (const Vector3d& p : points) most = std::max(most, d.dot(p));
      return most;
    };
    const SupportBound bound(exact);
    for (int i = 0; i < 500; ++i) {
      const Vector3d d = 3 * AnyDirection(&random);
      EXPECT_GE(bound(d), exact(d) - 1e-12);
      EXPECT_LE(bound(d), exact(d) + 3 * 0.06 * 1.5);  // half a cell times the farthest point
    }
  }
}

TEST(SupportBound, OfABallIsAtMostFourThousandthsTooLarge) {
  std::mt19937 random(2);
  const SupportBound bound([](const Vector3d& d) { return d.norm(); });
  for (int i = 0; i < 10000; ++i) {
    const double size = bound(AnyDirection(&random));
    EXPECT_GE(size, 1 - 1e-12);
    EXPECT_LE(size, 1.004);
  }
}

TEST(ReachableRegion, HoldsTheContactPointsOfEveryPosture) {
  std::vector<ReachableRegion> reaches;
  for (const models::ContactPatch& patch : DrcHubo1().contacts) {
    reaches.emplace_back(DrcHubo1(), patch);
  }
  RandomPostures postures(3);
  for (int i = 0; i < 3000; ++i) {
    postures.Next();
    const Vector3d d = AnyDirection(postures.random());
    for (std::size_t contact = 0; contact < reaches.size(); ++contact) {
      const models::ContactPatch& patch = DrcHubo1().contacts[contact];
      for (std::size_t k = 0; k < patch.points.size(); ++k) {
        ASSERT_LE(d.dot(postures.Point(patch, k)), reaches[contact].Support(d) + 1e-12)
            << patch.name;
      }
    }
  }
}

// Independent: places that random postures, improved joint by joint, really reach.
TEST(ReachableRegion, IsCloseToWhatTheJointsReallyReach) {
  const models::RobotModel& robot = DrcHubo1();
  std::mt19937 random(4);
  dynamics::TreeKinematics kinematics(robot);
  for (std::size_t contact = 0; contact < robot.contacts.size(); ++contact) {
    const models::ContactPatch& patch = robot.contacts[contact];
    const ReachableRegion reach(robot, patch);
    for (int i = 0; i < 20; ++i) {
      const Vector3d d = AnyDirection(&random);
      Eigen::VectorXd q = Eigen::VectorXd::Zero(robot.nq());
      q[0] = 1;
      const auto value = [&] {
        kinematics.SetPosition(q);
        double most = -1e9;
        for (const Vector3d& p : patch.points) {
          most = std::max(most, d.dot(kinematics.Position(patch.link, p)));
        }
        return most;
      };
      double best = -1e9;
      for (int start = 0; start < 8; ++start) {
        for (int j = 0; j < robot.num_joints(); ++j) {
          q[7 + j] = std::uniform_real_distribution<double>(robot.joints[j].lower,
                                                            robot.joints[j].upper)(random);
        }
        for (int round = 0; round < 4; ++round) {
          for (int link = patch.link; link > 0; link = robot.joints[link - 1].parent) {
            const models::Joint& joint = robot.joints[link - 1];
            double best_angle = q[6 + link];
            double best_here = value();
            for (int k = 0; k <= 40; ++k) {
              q[6 + link] = joint.lower + (joint.upper - joint.lower) * k / 40;
              const double here = value();
              if (here > best_here) {
                best_here = here;
                best_angle = q[6 + link];
              }
            }
            q[6 + link] = best_angle;
          }
        }
        best = std::max(best, value());
      }
      EXPECT_GE(reach.Support(d), best - 1e-12) << patch.name;
      EXPECT_LE(reach.Support(d), best + 0.04) << patch.name;
    }
  }
}

/// Ground of one box, anywhere and tilted anyhow below 45 degrees.
models::Environment OneBox(std::mt19937* random) {
  const auto any = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(*random);
  };
  models::Obstacle box;
  box.name = "box";
  box.is_ground = true;
  box.shape = models::Shape::Box({any(0.05, 0.6), any(0.05, 0.6), 0.1});
  box.X_WO = Eigen::Translation3d(any(-1, 1), any(-1, 1), any(-1.2, 0.3)) *
             Eigen::AngleAxisd(any(0, 0.7), Vector3d(any(-1, 1), any(-1, 1), 0).normalized());
  models::Environment environment;
  environment.obstacles.push_back(box);
  return environment;
}

TEST(ReachableRegion, MeetsGroundWhereverAPostureTouchesIt) {
  RandomPostures postures(5);
  const models::ContactPatch& sole = DrcHubo1().contacts[0];
  const ReachableRegion reach(DrcHubo1(), sole);
  int no = 0;
  for (int i = 0; i < 1000; ++i) {
    const models::Environment environment = OneBox(postures.random());
    const models::GroundMap ground(environment);
    postures.Next();
    // The root is put where a point of the sole touches the ground's centre.
    const Vector3d top = environment.obstacles[0].X_WO * Vector3d(0, 0, 0.05);
    Isometry3d X_WR(Eigen::AngleAxisd(0.3 * (i % 10), AnyDirection(postures.random())));
    X_WR.translation() = top - X_WR.linear() * postures.Point(sole, i % sole.points.size());
    EXPECT_TRUE(reach.MeetsGround(ground, X_WR)) << i;
    X_WR.translation() += Vector3d(0, 0, 0.4 * (1 + i % 3));
    no += reach.MeetsGround(ground, X_WR) ? 0 : 1;
  }
  EXPECT_GT(no, 300);
}

TEST(ReachableRegion, SaysNoAboveGroundThatTheStretchedLegDoesNotReach) {
  const models::ContactPatch& sole = DrcHubo1().contacts[0];
  const ReachableRegion reach(DrcHubo1(), sole);
  models::Obstacle floor;
  floor.is_ground = true;
  floor.shape = models::Shape::Box({8, 8, 0.2});
  models::Environment environment;
  environment.obstacles.push_back(floor);
  const models::GroundMap ground(environment);
  const double stretched = reach.Support(-Vector3d::UnitZ());
  EXPECT_GT(stretched, 0.7);
  EXPECT_LT(stretched, ChainLength(DrcHubo1(), sole));
  for (const double beyond : {-0.01, 0.01}) {
    const Isometry3d X_WR(Eigen::Translation3d(0, 0, 0.1 + stretched + beyond));
    EXPECT_EQ(reach.MeetsGround(ground, X_WR), beyond < 0);
  }
}

}  // namespace
}  // namespace possibility::actions
