#include "dynamics/tree/multibody_points.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <stdexcept>

#include "dynamics/tree/multibody_dynamics.h"
#include "tests/dynamics/richardson.h"
#include "tests/dynamics/tree/multibody_cases.h"

namespace possibility::dynamics {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

std::vector<PointTerm> RandomWeights(std::mt19937* random, const MultibodyModel& model) {
  std::vector<PointTerm> terms(1 + (*random)() % 6);
  for (PointTerm& term : terms) {
    const ContactPoint point = RandomPoint(random, model);
    term.link = point.link;
    term.p_L = point.p_L;
    term.on_position = RandomVector(random, 3, 5);
  }
  return terms;
}

TEST(MultibodyPointsTest, PositionsAndJacobiansAreThoseOfTheDynamics) {
  std::mt19937 random(21);
  for (const ModelCase& c : Cases(200, 50)) {
    MultibodyPoints points(c.model);
    MultibodyDynamics dynamics(c.model);
    for (int i = 0; i < c.states; ++i) {
      const MotionState s = RandomMotionState(&random, *c.model);
      const ContactPoint point = RandomPoint(&random, *c.model);
      points.SetPosition(s.q);
      dynamics.SetState(s.q, s.v);
      ASSERT_EQ(points.Position(point), dynamics.Position(point)) << c.name;
      MatrixXd J(3, c.model->nv());
      dynamics.Jacobian(point, J);
      ASSERT_EQ(points.Jacobian(point), J) << c.name;
    }
  }
}

TEST(MultibodyPointsTest, HessiansAgreeWithDifferencesOfTheJacobians) {
  std::mt19937 random(22);
  for (const ModelCase& c : Cases(100, 20)) {
    // Rotations of a floating base do not commute, so differences of its Jacobian are not
    // symmetric: the next test is for them.
    if (c.model->base() == Base::kFloating) continue;
    MultibodyPoints points(c.model);
    MultibodyPoints probe(c.model);
    for (int i = 0; i < c.states; ++i) {
      const MotionState s = RandomMotionState(&random, *c.model);
      const std::vector<PointTerm> terms = RandomWeights(&random, *c.model);
      points.SetPosition(s.q);
      const auto gradient = [&](const VectorXd& d) {
        probe.SetPosition(c.model->Displaced(s.q, d));
        VectorXd sum = VectorXd::Zero(c.model->nv());
        for (const PointTerm& term : terms) {
          sum += probe.Jacobian({term.link, term.p_L}).transpose() * term.on_position;
        }
        return sum;
      };
      ASSERT_LT(RelativeError(points.Hessian(terms), RichardsonJacobian(gradient, c.model->nv())),
                1e-7)
          << c.name;
    }
  }
}

/// The dynamics find them by other formulas, together with those of velocities and accelerations.
TEST(MultibodyPointsTest, HessiansAreThoseOfTheDynamics) {
  std::mt19937 random(23);
  for (const ModelCase& c : Cases(200, 50)) {
    MultibodyPoints points(c.model);
    MultibodyDynamics dynamics(c.model);
    for (int i = 0; i < c.states; ++i) {
      const MotionState s = RandomMotionState(&random, *c.model);
      const std::vector<PointTerm> terms = RandomWeights(&random, *c.model);
      points.SetPosition(s.q);
      dynamics.SetState(s.q, s.v);
      ASSERT_LT(RelativeError(points.Hessian(terms),
                              dynamics.Hessian(VectorXd::Zero(c.model->nv()), terms).qq),
                1e-13)
          << c.name;
    }
  }
}

TEST(MultibodyPointsTest, BadInputIsRefused) {
  const ModelPtr model = MultibodyModel::Spatial(Hubo());
  MultibodyPoints points(model);
  VectorXd q = VectorXd::Zero(model->nq());
  q[0] = 1;
  points.SetPosition(q);
  const int links = model->tree().num_links();
  EXPECT_THROW(points.Position({links, Eigen::Vector3d::Zero()}), std::invalid_argument);
  EXPECT_THROW(points.Jacobian({-1, Eigen::Vector3d::Zero()}), std::invalid_argument);
  PointTerm term;
  term.p_L[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(points.Hessian({term}), std::invalid_argument);
  q[9] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(points.SetPosition(q), std::invalid_argument);
  EXPECT_THROW(points.SetPosition(VectorXd::Zero(3)), std::invalid_argument);
}

}  // namespace
}  // namespace possibility::dynamics
