#include "actions/spatial/separating_planes.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "collocation/robot/point_functions.h"
#include "dynamics/tree/floating_motion.h"
#include "dynamics/tree/tree_kinematics.h"
#include "models/shapes/signed_distance.h"
#include "tests/actions/drchubo1.h"

namespace possibility::actions {
namespace {

using Eigen::VectorXd;

constexpr double kClearance = 0.01;  // m
constexpr double kAccuracy = 5e-5;   // m, of a distance

double DistanceOf(const VectorXd& q, int link, int other) {
  dynamics::TreeKinematics kinematics(DrcHubo1());
  kinematics.SetPosition(q);
  double distance = std::numeric_limits<double>::infinity();
  for (const models::PosedShape& a : DrcHubo1().links[link].shapes) {
    for (const models::PosedShape& b : DrcHubo1().links[other].shapes) {
      const models::PreparedShape first(a.shape);
      const models::PreparedShape second(b.shape);
      distance = std::min(
          distance,
          models::SignedDistance(first, first.CorePose(kinematics.X_WL()[link] * a.X_PS), second,
                                 second.CorePose(kinematics.X_WL()[other] * b.X_PS), 1e9));
    }
  }
  return distance;
}

/// By how much the points stay beyond their planes' least heights, m; the smallest.
double ReserveAt(const VectorXd& q, const std::vector<collocation::Separation>& planes) {
  static const auto model = dynamics::MultibodyModel::OnJoints(DrcHubo1());
  std::vector<collocation::PointOverPlane> pairs;
  for (const collocation::Separation& plane : planes) pairs.push_back(plane.pair);
  VectorXd heights(static_cast<Eigen::Index>(pairs.size()));
  HeightsOverPlanes(model, pairs)->Evaluate(dynamics::FromFloating(*model, q), &heights);
  double reserve = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < planes.size(); ++i) {
    reserve = std::min(reserve, heights[static_cast<Eigen::Index>(i)] - planes[i].height);
  }
  return reserve;
}

/// A walking posture, disturbed.
VectorXd SomePosture(std::mt19937* random) {
  static const NominalStance stance = SolveNominalStance(DrcHubo1(), DrcHubo1().GaitNamed("walk"));
  std::normal_distribution<double> noise(0, 0.15);
  VectorXd q = stance.q;
  for (double& joint : q.tail(DrcHubo1().num_joints())) joint += noise(*random);
  return q;
}

/// Links of different legs, and a hand beside a shank.
std::vector<std::pair<int, int>> Pairs() {
  const auto link = [](const char* name) {
    for (int i = 0; i < DrcHubo1().num_links(); ++i) {
      if (DrcHubo1().links[i].name == name) return i;
    }
    return -1;
  };
  return {{link("Body_LAR"), link("Body_RAR")},
          {link("Body_LKP"), link("Body_RKP")},
          {link("Body_TSY"), link("Body_LHP")},
          {link("Body_LKP"), link("Body_LWR")}};
}

TEST(SeparatingPlanes, ProveTheDistanceWhereTheyWereDrawn) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 100; ++trial) {
    const VectorXd q = SomePosture(&random);
    for (const auto& [link, other] : Pairs()) {
      const auto planes = SeparatingPlanes(DrcHubo1(), q, link, other, 1e9, kClearance, 0);
      EXPECT_NEAR(ReserveAt(q, planes), DistanceOf(q, link, other) - kClearance, kAccuracy);
    }
  }
}

TEST(SeparatingPlanes, AreSufficientInAnyOtherPosture) {
  std::mt19937 random(2);
  int proved = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const VectorXd drawn = SomePosture(&random);
    const VectorXd q = SomePosture(&random);
    for (const auto& [link, other] : Pairs()) {
      const auto planes = SeparatingPlanes(DrcHubo1(), drawn, link, other, 1e9, kClearance, 0);
      if (ReserveAt(q, planes) < 0) continue;
      ++proved;
      EXPECT_GT(DistanceOf(q, link, other), kClearance - kAccuracy);
    }
  }
  EXPECT_GT(proved, 200);
}

TEST(SeparatingPlanes, AreDrawnForNearShapesOnly) {
  std::mt19937 random(3);
  const auto [link, other] = Pairs().front();
  const VectorXd q = SomePosture(&random);
  const double distance = DistanceOf(q, link, other);
  EXPECT_TRUE(SeparatingPlanes(DrcHubo1(), q, link, other, distance - 0.001, 0, 0).empty());
  EXPECT_FALSE(SeparatingPlanes(DrcHubo1(), q, link, other, distance + 0.001, 0, 0).empty());
}

}  // namespace
}  // namespace possibility::actions
