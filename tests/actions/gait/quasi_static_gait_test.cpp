#include "actions/gait/quasi_static_gait.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "actions/wholebody/support_polygon.h"
#include "tests/actions/drchubo1.h"

namespace possibility::actions {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

PlanarPose RandomPose(std::mt19937* generator, double extent) {
  std::uniform_real_distribution<double> unit(-1, 1);
  return {extent * unit(*generator), extent * unit(*generator), 3 * unit(*generator)};
}

class QuasiStaticGaitTest : public ::testing::TestWithParam<std::string> {
 protected:
  const LocomotionModel& model_ = DrcHubo1Locomotion();
  const LocomotionModel::GaitEntry& gait_ = *model_.gaits[model_.GaitIndex(GetParam())];
  const models::GaitParameters& parameters_ = gait_.stance.gait->parameters;
  const QuasiStaticGait motion_{*model_.robot, gait_.stance};
  std::mt19937 generator_{7};
};

TEST_P(QuasiStaticGaitTest, StridesStayWithinTheGaitsBounds) {
  for (int trial = 0; trial < 200; ++trial) {
    const PlanarPose from = RandomPose(&generator_, 2), to = RandomPose(&generator_, 2);
    const std::vector<PlanarPose> strides = PlanStrides(parameters_, from, to);
    for (size_t i = 0; i + 1 < strides.size(); ++i) {
      EXPECT_LE(StrideEffort(parameters_, strides[i].Inverse() * strides[i + 1]), 1 + 1e-6);
    }
    EXPECT_NEAR((strides.back().position() - to.position()).norm(), 0, 1e-12);
    EXPECT_NEAR(WrapAngle(strides.back().yaw - to.yaw), 0, 1e-12);
  }
}

/// At every knot, bearing contacts are where they stood, and v and a are the derivatives of q. The
/// robot is at rest between phases.
TEST_P(QuasiStaticGaitTest, DerivativesAreConsistentAndContactsStayInPlace) {
  WholeBodySolver solver(*model_.robot);
  const PlanarPose from = RandomPose(&generator_, 2);
  const PlanarPose to = from * PlanarPose{0.3, 0.1, 0.2};
  VectorXd guess = gait_.stance.q;
  guess.segment<2>(4) = from.position();
  constexpr double kStep = 1e-4;
  for (const MotionPhase& phase : motion_.Phases(PlanStrides(parameters_, from, to), 0.2, 1)) {
    std::vector<Vector3d> stood;
    for (double s : {0.0, 0.3, 0.5, 0.8, 1.0}) {
      const double t = std::clamp(s * phase.duration, 2 * kStep, phase.duration - 2 * kStep);
      const WholeBodyState before = solver.Solve(phase.task(t - kStep), guess);
      const WholeBodyState after = solver.Solve(phase.task(t + kStep), guess);
      const WholeBodyState now = solver.Solve(phase.task(t), guess);
      const int joints = model_.robot->num_joints();
      EXPECT_LT(((after.q - before.q).tail(joints + 3) / (2 * kStep) - now.v.tail(joints + 3))
                    .lpNorm<Eigen::Infinity>(),
                1e-5);
      EXPECT_LT(((after.v - before.v) / (2 * kStep) - now.a).lpNorm<Eigen::Infinity>(), 1e-4);
      for (size_t c = 0; c < phase.contacts.size(); ++c) {
        const models::ContactPatch& patch = model_.robot->contacts[phase.contacts[c]];
        const Vector3d p = solver.kinematics().Position(patch.link, patch.Centre());
        EXPECT_NEAR(p.z(), 0.2, 1e-9);
        if (stood.size() <= c) stood.push_back(p);
        EXPECT_LT((p - stood[c]).norm(), 1e-9);
      }
      guess = now.q;
    }
    const WholeBodyState end = solver.Solve(phase.task(phase.duration), guess);
    EXPECT_LT(end.v.norm(), 1e-9);
    EXPECT_LT(end.a.norm(), 1e-6);
    guess = end.q;
  }
}

TEST_P(QuasiStaticGaitTest, OneLimbSwingsAtATimeAndTheOthersSupportTheCentreOfMass) {
  WholeBodySolver solver(*model_.robot);
  const PlanarPose from = RandomPose(&generator_, 2);
  VectorXd guess = gait_.stance.q;
  guess.segment<2>(4) = from.position();
  const size_t limbs = gait_.stance.gait->limbs.size();
  for (const PlanarPose& d :
       {PlanarPose{parameters_.forward, 0, 0}, PlanarPose{0, parameters_.lateral, 0},
        PlanarPose{0, 0, parameters_.turn}}) {
    size_t swings = 0;
    for (const MotionPhase& phase : motion_.Phases({from, from * d}, 0, 1)) {
      ASSERT_GE(phase.contacts.size(), limbs - 1);
      swings += phase.contacts.size() == limbs - 1;
      guess = solver.Solve(phase.task(phase.duration / 2), guess).q;
      std::vector<Vector2d> points;
      for (int contact : phase.contacts) {
        const models::ContactPatch& patch = model_.robot->contacts[contact];
        for (const Vector3d& p : patch.points) {
          points.push_back(solver.kinematics().Position(patch.link, p).head<2>());
        }
      }
      EXPECT_GT(SupportPolygon(points).Margin(solver.kinematics().CentreOfMass().head<2>()), 0.01);
    }
    EXPECT_EQ(swings, limbs);
  }
}

/// This holds however little the centre of mass has to move for the first swing.
TEST_P(QuasiStaticGaitTest, BeginsAndEndsOnAllLimbs) {
  const size_t limbs = gait_.stance.gait->limbs.size();
  for (const PlanarPose& d :
       {PlanarPose{0, 0, 1e-3}, PlanarPose{0, 0, -1e-3}, PlanarPose{1e-3, 0, 0},
        PlanarPose{0, 1e-3, 0}, PlanarPose{0, 0, parameters_.turn}}) {
    const std::vector<MotionPhase> phases = motion_.Phases({{}, d}, 0, 1);
    EXPECT_EQ(phases.front().contacts.size(), limbs);
    EXPECT_EQ(phases.back().contacts.size(), limbs);
  }
}

// While one foot swings, the trunk's top is over the other one.
TEST(SwayingGaitTest, TheTrunkRollsOverTheFootThatBears) {
  const LocomotionModel& model = DrcHubo1Locomotion();
  const LocomotionModel::GaitEntry& walk = *model.gaits[model.GaitIndex("walk")];
  models::Gait swaying = *walk.stance.gait;
  swaying.parameters.sway = 0.1;
  NominalStance stance = walk.stance;
  stance.gait = &swaying;
  const QuasiStaticGait gait(*model.robot, stance);
  const PlanarPose from{0.3, -0.2, 0.7}, to = from * PlanarPose{0.2, 0.05, 0.1};
  WholeBodySolver solver(*model.robot);
  VectorXd guess = stance.q;
  guess.segment<2>(4) = from.position();
  constexpr double kStep = 1e-4;
  int swings = 0;
  for (const MotionPhase& phase : gait.Phases(PlanStrides(swaying.parameters, from, to), 0, 1)) {
    const double t = 0.4 * phase.duration;
    const WholeBodyState before = solver.Solve(phase.task(t - kStep), guess);
    const WholeBodyState after = solver.Solve(phase.task(t + kStep), guess);
    const WholeBodyState now = solver.Solve(phase.task(t), guess);
    EXPECT_LT(((after.v - before.v) / (2 * kStep) - now.a).lpNorm<Eigen::Infinity>(), 1e-4);
    guess = solver.Solve(phase.task(phase.duration), now.q).q;
    if (phase.contacts.size() == 2) continue;
    ++swings;
    const Vector3d up =
        Eigen::Quaterniond(guess[0], guess[1], guess[2], guess[3]) * Vector3d::UnitZ();
    const models::ContactPatch& patch = model.robot->contacts[phase.contacts.front()];
    const Vector3d foot = solver.kinematics().Position(patch.link, patch.Centre());
    const Vector2d left(-std::sin(to.yaw), std::cos(to.yaw));
    const double side = left.dot(Vector2d(foot.head<2>()) - to.position());
    EXPECT_NEAR(std::asin(up.head<2>().norm()), 0.1, 1e-9);
    EXPECT_GT(side * left.dot(Vector2d(up.head<2>())), 0);
  }
  EXPECT_GE(swings, 2);
  // Upright again at the end.
  EXPECT_NEAR(guess[1], 0, 1e-9);
  EXPECT_NEAR(guess[2], 0, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Gaits, QuasiStaticGaitTest, ::testing::Values("walk", "crawl"),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace possibility::actions
