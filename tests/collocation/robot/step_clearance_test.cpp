#include "collocation/robot/step_clearance.h"

#include <gtest/gtest.h>

#include <random>
#include <stdexcept>

#include "collocation/robot/point_functions.h"
#include "tests/collocation/robot/exact_derivatives.h"
#include "tests/dynamics/random_robot.h"

namespace possibility::collocation {
namespace {

using dynamics::ContactPoint;
using Eigen::VectorXd;

TEST(StepClearance, IsFlatOutsideTheStep) {
  const SmoothStep step{1, 2, 0.3};
  for (const double x : {-7.0, 0.0, 1.0}) EXPECT_EQ(step.Value(x), 0) << x;
  for (const double x : {2.0, 3.0, 70.0}) EXPECT_NEAR(step.Value(x), 0.3, 1e-15) << x;
  for (const double x : {0.0, 1.0, 2.0, 5.0}) {
    EXPECT_EQ(step.Slope(x), 0) << x;
    EXPECT_EQ(step.Curvature(x), 0) << x;
  }
  EXPECT_NEAR(step.Value(1.5), 0.15, 1e-15);
}

TEST(StepClearance, RisesOrFallsMonotonically) {
  for (const double height : {0.2, -0.2}) {
    const SmoothStep step{-0.1, 0.4, height};
    for (double x = -0.2; x < 0.5; x += 0.01) {
      EXPECT_GE((step.Value(x + 0.01) - step.Value(x)) * height, 0) << x;
    }
  }
}

TEST(StepClearance, IsTheHeightAboveTheStep) {
  std::mt19937 random(1);
  const auto model = dynamics::MultibodyModel::Planar(dynamics::RandomPlanarTree(&random, 4));
  const std::vector<ContactPoint> points = {{1, {0.1, 0, 0.2}}, {3, {-0.2, 0, 0.1}}};
  const SmoothStep step{-0.3, 0.3, 0.5};
  const auto clearance = StepClearance(model, points, step);
  const auto positions = PointPositions(model, points);
  for (int trial = 0; trial < 50; ++trial) {
    const VectorXd q = dynamics::RandomVector(&random, model->nv(), 1);
    VectorXd y(2), p(4);
    clearance->Evaluate(q, &y);
    positions->Evaluate(q, &p);
    EXPECT_EQ(y[0], p[1] - step.Value(p[0]));
    EXPECT_EQ(y[1], p[3] - step.Value(p[2]));
  }
}

TEST(StepClearance, DerivativesAgreeWithDifferences) {
  std::mt19937 random(2);
  for (int trial = 0; trial < 30; ++trial) {
    const auto model =
        dynamics::MultibodyModel::Planar(dynamics::RandomPlanarTree(&random, 1 + trial % 6));
    const int links = model->tree().num_links();
    const std::vector<ContactPoint> points = {{links - 1, dynamics::RandomVector(&random, 3, 0.3)},
                                              {0, dynamics::RandomVector(&random, 3, 0.3)}};
    // The step is so wide that no point comes near its ends, where the third derivative jumps.
    const auto clearance = StepClearance(model, points, {-20, 20, trial % 2 == 0 ? 8.0 : -8.0});
    ExpectExactDerivatives(clearance.get(), dynamics::RandomVector(&random, model->nv(), 1.5),
                           dynamics::RandomVector(&random, 2, 1));
  }
}

TEST(StepClearance, RefusesAStepOfNoLengthAndASpatialModel) {
  std::mt19937 random(3);
  const auto model = dynamics::MultibodyModel::Planar(dynamics::RandomPlanarTree(&random, 2));
  EXPECT_THROW(StepClearance(model, {}, {1, 1, 0.1}), std::invalid_argument);
  const auto spatial = dynamics::MultibodyModel::OnJoints(dynamics::RandomTree(&random, 2));
  EXPECT_THROW(StepClearance(spatial, {}, {1, 2, 0.1}), std::invalid_argument);
}

}  // namespace
}  // namespace possibility::collocation
