#include "experiments/viewer/viewer_balance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "tests/actions/drchubo1.h"
#include "tests/actions/hop_plan.h"
#include "tests/actions/verify/walk_and_crawl.h"
#include "tests/dynamics/newton_euler.h"
#include "tests/experiments/sample_plan.h"

namespace possibility::experiments {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// Walking, transitions and crawling, then a hop.
std::vector<actions::Segment> Segments() {
  std::vector<actions::Segment> segments = actions::testing::WalkAndCrawl().plan.segments;
  segments.push_back(actions::testing::Hop(actions::DrcHubo1()).Build());
  return segments;
}

/// A knot with its balance, and the kinematics at it.
struct Sample {
  const actions::Knot& knot;
  BalanceState balance;
  dynamics::TreeKinematics* kinematics;
};

void VisitLoadedKnots(const std::function<void(const Sample&)>& visit) {
  const models::RobotModel& robot = actions::DrcHubo1();
  dynamics::TreeKinematics kinematics(robot);
  for (const actions::Segment& segment : Segments()) {
    for (const actions::Phase& phase : segment.phases) {
      if (phase.contacts.empty()) continue;
      const auto bearing = actions::BearingPatches(robot, phase);
      for (const actions::Knot& knot : phase.knots) {
        const CentroidalState whole = CentroidalStateAt(knot, &kinematics);
        visit({knot, BalanceStateAt(bearing, knot.forces, whole, kinematics), &kinematics});
      }
    }
  }
}

/// The zero moment point at height z of the whole robot's motion: the wrench on the root that the
/// Newton-Euler equations of all links ask for, without any contact.
Vector2d ZmpOfMotion(const Sample& sample, double z) {
  const VectorXd wrench = dynamics::NewtonEuler(*sample.kinematics, sample.knot.a).head<6>();
  const Vector3d moment = wrench.head<3>();
  const Vector3d force = wrench.tail<3>();
  const Vector3d root = sample.knot.q.segment<3>(4);
  return {root.x() - ((root.z() - z) * force.x() + moment.y()) / force.z(),
          root.y() + (moment.x() - (root.z() - z) * force.y()) / force.z()};
}

TEST(BalanceState, ZmpOfTheForcesIsThatOfTheWholeRobotsMotion) {
  int count = 0;
  VisitLoadedKnots([&](const Sample& sample) {
    const Vector3d& zmp = sample.balance.zmp;
    ASSERT_TRUE(zmp.allFinite()) << sample.knot.t;
    EXPECT_LT((zmp.head<2>() - ZmpOfMotion(sample, zmp.z())).norm(), 1e-5) << sample.knot.t;
    EXPECT_GT(sample.balance.margin, 0) << sample.knot.t;
    ++count;
  });
  EXPECT_GT(count, 100);
}

TEST(BalanceState, LoadsCarryTheWeightAndLiftTheCentreOfMass) {
  const double mass = actions::DrcHubo1().TotalMass();
  double greatest = 0;
  VisitLoadedKnots([&](const Sample& sample) {
    Eigen::MatrixXd J;
    sample.kinematics->CentreOfMassJacobian(&J);
    const double rise = (J * sample.knot.a + sample.kinematics->CentreOfMassBias()).z();
    greatest = std::max(greatest, std::abs(rise));
    EXPECT_NEAR(sample.knot.forces.row(2).sum(), mass * (dynamics::kGravity + rise), 1e-4 * mass);
  });
  EXPECT_GT(greatest, 0.5) << "the motion is too slow to tell";
}

/// The sample robot, its sole on the ground at the height z.
class SampleStance {
 public:
  explicit SampleStance(double z) : kinematics(robot) {
    VectorXd q = VectorXd::Zero(robot.nq());
    q[0] = 1;
    q[6] = z + 0.5;  // hip and sole: 0.2 m and 0.3 m farther down
    kinematics.SetPosition(q);
  }

  models::RobotModel robot = testing::SampleRobot();
  dynamics::TreeKinematics kinematics;
  std::vector<actions::BearingPatch> sole = {{0, {0, 1, 2, 3}}};
};

/// x'' = omega^2 (x - foot), by the classical Runge-Kutta method.
Vector2d Fallen(Vector2d x, Vector2d v, const Vector2d& foot, double omega, double duration) {
  constexpr int kSteps = 2000;
  const double h = duration / kSteps;
  const auto fall = [&](const Vector2d& at) -> Vector2d { return omega * omega * (at - foot); };
  for (int i = 0; i < kSteps; ++i) {
    const Vector2d a1 = fall(x);
    const Vector2d v2 = v + h / 2 * a1, a2 = fall(x + h / 2 * v);
    const Vector2d v3 = v + h / 2 * a2, a3 = fall(x + h / 2 * v2);
    const Vector2d v4 = v + h * a3, a4 = fall(x + h * v3);
    x += h / 6 * (v + 2 * v2 + 2 * v3 + v4);
    v += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
  }
  return x;
}

TEST(BalanceState, APendulumThatPutsItsFootOnTheCapturePointComesToRestThere) {
  const double ground = 0.3;
  const double height = 0.7;
  const SampleStance stance(ground);
  const Vector3d velocity(0.4, -0.25, 0.1);
  const CentroidalState whole{
      {0.5, 0.2, ground + height}, stance.robot.TotalMass() * velocity, Vector3d::Zero()};
  const Eigen::Matrix3Xd forces = Vector3d(0, 0, 5).replicate<1, 4>();
  const BalanceState state = BalanceStateAt(stance.sole, forces, whole, stance.kinematics);
  const double omega = std::sqrt(9.80665 / height);
  EXPECT_NEAR(state.zmp.z(), ground, 1e-12);
  EXPECT_NEAR(state.capture.x(), 0.5 + 0.4 / omega, 1e-12);
  const Vector2d rest =
      Fallen(whole.position.head<2>(), velocity.head<2>(), state.capture, omega, 10 / omega);
  EXPECT_LT((rest - state.capture).norm(), 1e-4);
}

TEST(BalanceState, WithoutLoadIsNotANumber) {
  const SampleStance stance(0);
  const CentroidalState whole{{0, 0, 1}, Vector3d::Zero(), Vector3d::Zero()};
  for (const bool flies : {true, false}) {
    const auto bearing = flies ? std::vector<actions::BearingPatch>() : stance.sole;
    const Eigen::Matrix3Xd forces = Eigen::Matrix3Xd::Zero(3, flies ? 0 : 4);
    const BalanceState state = BalanceStateAt(bearing, forces, whole, stance.kinematics);
    EXPECT_TRUE(std::isnan(state.zmp.x()));
    EXPECT_TRUE(std::isnan(state.margin));
    EXPECT_TRUE(std::isnan(state.capture.x()));
  }
}

}  // namespace
}  // namespace possibility::experiments
