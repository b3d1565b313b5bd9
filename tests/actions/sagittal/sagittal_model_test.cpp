#include "actions/sagittal/sagittal_model.h"

#include <gtest/gtest.h>

#include "dynamics/tree/tree_kinematics.h"
#include "models/world/collision.h"
#include "tests/actions/drchubo1.h"

namespace possibility::actions {
namespace {

const SagittalModel& Sagittal() {
  static const NominalStance walk = SolveNominalStance(DrcHubo1(), DrcHubo1().GaitNamed("walk"));
  static const NominalStance crawl = SolveNominalStance(DrcHubo1(), DrcHubo1().GaitNamed("crawl"));
  static const SagittalModel model(DrcHubo1(), walk, crawl);
  return model;
}

bool Carries(int link, int other) {
  while (other > 0 && other != link) other = DrcHubo1().joints[other - 1].parent;
  return other == link;
}

/// Least distance between the links that a joint carries and those that carry it, m, with the
/// planar joint at `position` and the others as in `stance`.
double DistanceInLimb(const Eigen::VectorXd& stance, int joint, double position) {
  const models::RobotModel& robot = DrcHubo1();
  const int link = Sagittal().reduction().joints()[joint].left + 1;
  const auto is_in_limb = [link](int other) {
    return Carries(link, other) || Carries(other, link);
  };
  Eigen::VectorXd q = stance;
  q[3 + joint] = position;
  const models::CollisionChecker checker(robot, models::Environment());
  dynamics::TreeKinematics kinematics(robot);
  kinematics.SetPosition(Sagittal().reduction().ExpandConfiguration(q));
  double least = 1;
  for (const models::Proximity& pair : checker.SelfProximities(kinematics.X_WL(), 0.05)) {
    if (is_in_limb(pair.link) && is_in_limb(pair.other)) {
      least = std::min(least, pair.distance);
    }
  }
  return least;
}

TEST(SagittalModel, JointsKeepLinksOfTheirLimbApart) {
  const auto& planar = *Sagittal().planar();
  for (const Eigen::VectorXd& stance : {Sagittal().ready(), Sagittal().landed()}) {
    for (int joint = 0; joint < planar.num_joints(); ++joint) {
      for (const double limit : {Sagittal().lower()[joint], Sagittal().upper()[joint]}) {
        for (int i = 0; i <= 50; ++i) {
          const double position = stance[3 + joint] + (limit - stance[3 + joint]) * i / 50;
          EXPECT_GE(DistanceInLimb(stance, joint, position), kSelfClearance) << joint;
        }
      }
    }
  }
}

TEST(SagittalModel, JointsStopOnlyAtTheirLimitsOrWhereLinksAreClose) {
  const auto& planar = *Sagittal().planar();
  const auto is_close = [](int joint, double position) {
    return DistanceInLimb(Sagittal().ready(), joint, position) < kSelfClearance ||
           DistanceInLimb(Sagittal().landed(), joint, position) < kSelfClearance;
  };
  int stopped = 0;
  for (int joint = 0; joint < planar.num_joints(); ++joint) {
    if (Sagittal().lower()[joint] > planar.lower()[joint]) {
      EXPECT_TRUE(is_close(joint, Sagittal().lower()[joint] - 2e-3)) << joint;
      ++stopped;
    }
    if (Sagittal().upper()[joint] < planar.upper()[joint]) {
      EXPECT_TRUE(is_close(joint, Sagittal().upper()[joint] + 2e-3)) << joint;
      ++stopped;
    }
  }
  EXPECT_GT(stopped, 2);
}

}  // namespace
}  // namespace possibility::actions
