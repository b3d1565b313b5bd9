#include "dynamics/tree/multibody_dynamics.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <limits>
#include <random>
#include <stdexcept>
#include <utility>

#include "dynamics/sagittal/sagittal_reduction.h"
#include "dynamics/simbody/simbody_dynamics.h"
#include "models/robot/robot_yaml.h"
#include "tests/dynamics/random_robot.h"
#include "tests/dynamics/richardson.h"
#include "tests/dynamics/tree/multibody_cases.h"
#include "tests/message_of.h"

namespace possibility::dynamics {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kDerivativeTolerance = 1e-7;

/// Derivatives of f(dq, dv), both tangents of size nv, with respect to the one and the other.
template <typename Function>
std::pair<MatrixXd, MatrixXd> StateDifferences(const Function& f, int nv) {
  const VectorXd zero = VectorXd::Zero(nv);
  return {RichardsonJacobian([&](const VectorXd& d) { return f(d, zero); }, nv),
          RichardsonJacobian([&](const VectorXd& d) { return f(zero, d); }, nv, 0.1)};
}

TEST(MultibodyDynamicsTest, InverseDynamicsDerivativesAgreeWithDifferences) {
  std::mt19937 random(1);
  for (const ModelCase& c : Cases(1000, 20)) {
    MultibodyDynamics dynamics(c.model);
    MultibodyDynamics probe(c.model);
    const int nv = c.model->nv();
    for (int i = 0; i < c.states; ++i) {
      const MotionState s = RandomMotionState(&random, *c.model);
      const auto forces = [&](const VectorXd& dq, const VectorXd& dv, const VectorXd& da) {
        probe.SetState(c.model->Displaced(s.q, dq), s.v + dv, s.a + da);
        return VectorXd(probe.InverseDynamics());
      };
      const VectorXd zero = VectorXd::Zero(nv);
      dynamics.SetState(s.q, s.v, s.a);
      const InverseDynamicsDerivatives& D = dynamics.Differentiate();
      const MatrixXd dq =
          RichardsonJacobian([&](const VectorXd& d) { return forces(d, zero, zero); }, nv);
      const MatrixXd dv =
          RichardsonJacobian([&](const VectorXd& d) { return forces(zero, d, zero); }, nv, 0.1);
      const MatrixXd da =
          RichardsonJacobian([&](const VectorXd& d) { return forces(zero, zero, d); }, nv, 1.0);
      ASSERT_LT(RelativeError(D.forces, forces(zero, zero, zero)), 1e-13) << c.name;
      ASSERT_LT(RelativeError(D.dq, dq), kDerivativeTolerance) << c.name << ", state " << i;
      ASSERT_LT(RelativeError(D.dv, dv), kDerivativeTolerance) << c.name << ", state " << i;
      ASSERT_LT(RelativeError(D.da, da), kDerivativeTolerance) << c.name << ", state " << i;
    }
  }
}

TEST(MultibodyDynamicsTest, MassMatrixIsSymmetricPositiveDefiniteAndTheDerivativeInA) {
  std::mt19937 random(2);
  for (const ModelCase& c : Cases(1000, 50)) {
    MultibodyDynamics dynamics(c.model);
    for (int i = 0; i < c.states; ++i) {
      const MotionState s = RandomMotionState(&random, *c.model);
      dynamics.SetState(s.q, s.v, s.a);
      const MatrixXd M = dynamics.MassMatrix();
      ASSERT_LT(RelativeError(M, M.transpose()), 1e-14);
      ASSERT_EQ(Eigen::LLT<MatrixXd>(M).info(), Eigen::Success) << c.name;
      ASSERT_LT(RelativeError(dynamics.Differentiate().da, M), 1e-13) << c.name;
      const VectorXd forces = dynamics.InverseDynamics();
      dynamics.SetAcceleration(VectorXd::Zero(c.model->nv()));
      ASSERT_LT(RelativeError(dynamics.InverseDynamics() + M * s.a, forces), 1e-12) << c.name;
    }
  }
}

TEST(MultibodyDynamicsTest, AgreesWithSimbody) {
  std::mt19937 random(3);
  for (const ModelCase& c : Cases(300, 10)) {
    if (!c.model->is_identity()) continue;
    MultibodyDynamics dynamics(c.model);
    SimbodyDynamics simbody(c.model->tree());
    for (int i = 0; i < c.states; ++i) {
      const MotionState s = RandomMotionState(&random, *c.model);
      dynamics.SetState(s.q, s.v, s.a);
      simbody.SetState(s.q, s.v);
      ASSERT_LT(RelativeError(dynamics.InverseDynamics(), simbody.InverseDynamics(s.a)), 1e-11);
      ASSERT_LT(RelativeError(dynamics.MassMatrix(), simbody.MassMatrix()), 1e-11);
      const ContactPoint point = RandomPoint(&random, *c.model);
      ASSERT_LT((dynamics.Velocity(point) - simbody.PointVelocity(point.link, point.p_L)).norm(),
                1e-11);
      const Vector3d acceleration = simbody.PointBias(point.link, point.p_L) +
                                    simbody.PointJacobian(point.link, point.p_L) * s.a;
      ASSERT_LT(RelativeError(dynamics.Acceleration(point), acceleration), 1e-11);
      ASSERT_LT((dynamics.Centroidal().position - simbody.CentreOfMass()).norm(), 1e-12);
      ASSERT_LT(RelativeError(dynamics.Centroidal().momentum.tail(3),
                              c.model->tree().TotalMass() * simbody.CentreOfMassVelocity()),
                1e-11);
    }
  }
}

/// Takes minutes: the differenced function is computed by another engine.
TEST(MultibodyDynamicsLong, DerivativesAgreeWithDifferencesThroughSimbody) {
  std::mt19937 random(10);
  for (const ModelCase& c : Cases(1000, 20)) {
    if (!c.model->is_identity()) continue;
    MultibodyDynamics dynamics(c.model);
    SimbodyDynamics simbody(c.model->tree());
    const int nv = c.model->nv();
    for (int i = 0; i < c.states; ++i) {
      const MotionState s = RandomMotionState(&random, *c.model);
      dynamics.SetState(s.q, s.v, s.a);
      const InverseDynamicsDerivatives& D = dynamics.Differentiate();
      const auto forces = [&](const VectorXd& dq, const VectorXd& dv) {
        simbody.SetState(c.model->Displaced(s.q, dq), s.v + dv);
        return simbody.InverseDynamics(s.a);
      };
      const auto [dq, dv] = StateDifferences(forces, nv);
      ASSERT_LT(RelativeError(D.dq, dq), kDerivativeTolerance) << c.name << ", state " << i;
      ASSERT_LT(RelativeError(D.dv, dv), kDerivativeTolerance) << c.name << ", state " << i;
    }
  }
}

TEST(MultibodyDynamicsTest, PointDerivativesAgreeWithDifferences) {
  std::mt19937 random(4);
  for (const ModelCase& c : Cases(200, 20)) {
    MultibodyDynamics dynamics(c.model);
    MultibodyDynamics probe(c.model);
    const int nv = c.model->nv();
    for (int i = 0; i < c.states; ++i) {
      const MotionState s = RandomMotionState(&random, *c.model);
      const ContactPoint point = RandomPoint(&random, *c.model);
      dynamics.SetState(s.q, s.v, s.a);
      const PointDerivatives D = dynamics.DifferentiatePoint(point);
      // Position, velocity and acceleration of the point, one below the other.
      const auto motion = [&](const VectorXd& dq, const VectorXd& dv) {
        probe.SetState(c.model->Displaced(s.q, dq), s.v + dv, s.a);
        VectorXd all(9);
        all << probe.Position(point), probe.Velocity(point), probe.Acceleration(point);
        return all;
      };
      const auto [dq, dv] = StateDifferences(motion, nv);
      ASSERT_LT(RelativeError(D.jacobian, dq.topRows(3)), kDerivativeTolerance) << c.name;
      ASSERT_LT(RelativeError(D.velocity_dq, dq.middleRows(3, 3)), kDerivativeTolerance) << c.name;
      ASSERT_LT(RelativeError(D.acceleration_dq, dq.bottomRows(3)), kDerivativeTolerance) << c.name;
      ASSERT_LT(RelativeError(D.jacobian, dv.middleRows(3, 3)), kDerivativeTolerance) << c.name;
      ASSERT_LT(RelativeError(D.acceleration_dv, dv.bottomRows(3)), kDerivativeTolerance) << c.name;
      MatrixXd J(3, nv);
      dynamics.Jacobian(point, J);
      ASSERT_LT(RelativeError(D.jacobian, J), 1e-12);

      const Vector3d force = RandomVector(&random, 3, 100);
      MatrixXd force_dq = MatrixXd::Zero(nv, nv);
      dynamics.AddPointForceDerivative(point, force, force_dq);
      const auto generalised = [&](const VectorXd& d) {
        probe.SetState(c.model->Displaced(s.q, d), s.v);
        VectorXd f = VectorXd::Zero(nv);
        probe.AddPointForce(point, force, f);
        return f;
      };
      ASSERT_LT(RelativeError(force_dq, RichardsonJacobian(generalised, nv)), kDerivativeTolerance)
          << c.name;
    }
  }
}

TEST(MultibodyDynamicsTest, CentroidalDerivativesAgreeWithDifferences) {
  std::mt19937 random(5);
  for (const ModelCase& c : Cases(200, 20)) {
    MultibodyDynamics dynamics(c.model);
    MultibodyDynamics probe(c.model);
    const int nv = c.model->nv();
    for (int i = 0; i < c.states; ++i) {
      const MotionState s = RandomMotionState(&random, *c.model);
      dynamics.SetState(s.q, s.v);
      const CentroidalQuantities C = dynamics.Centroidal();
      const auto at = [&](const VectorXd& dq, const VectorXd& dv) {
        probe.SetState(c.model->Displaced(s.q, dq), s.v + dv);
        VectorXd all(9);
        all << probe.Centroidal().position, probe.Centroidal().momentum;
        return all;
      };
      const auto [dq, dv] = StateDifferences(at, nv);
      ASSERT_LT(RelativeError(C.jacobian, dq.topRows(3)), kDerivativeTolerance) << c.name;
      ASSERT_LT(RelativeError(C.momentum_dq, dq.bottomRows(6)), kDerivativeTolerance) << c.name;
      ASSERT_LT(RelativeError(C.momentum_dv, dv.bottomRows(6)), kDerivativeTolerance) << c.name;
    }
  }
}

/// Momentum about the centre of mass, as the sum over the links from point velocities.
Vector3d AngularMomentum(const MultibodyDynamics& dynamics) {
  const models::RobotModel& tree = dynamics.model().tree();
  const Vector3d com = dynamics.kinematics().CentreOfMass();
  Vector3d sum = Vector3d::Zero();
  for (int i = 0; i < tree.num_links(); ++i) {
    const models::Inertial& inertial = tree.links[i].inertial;
    const ContactPoint centre{i, inertial.p_LC};
    const Eigen::Matrix3d R = dynamics.kinematics().X_WL()[i].linear();
    // The angular velocity comes from the velocities of three points of the link.
    Eigen::Matrix3d spin;
    for (int k = 0; k < 3; ++k) {
      spin.col(k) =
          dynamics.Velocity({i, inertial.p_LC + Vector3d::Unit(k)}) - dynamics.Velocity(centre);
    }
    spin = spin * R.transpose();
    const Vector3d omega(spin(2, 1), spin(0, 2), spin(1, 0));
    sum += R * inertial.I_LC * R.transpose() * omega +
           (dynamics.Position(centre) - com).cross(inertial.mass * dynamics.Velocity(centre));
  }
  return sum;
}

TEST(MultibodyDynamicsTest, MomentumIsTheSumOverTheLinksAndChangesWithTheBaseWrench) {
  std::mt19937 random(6);
  const ModelPtr model = MultibodyModel::Spatial(Hubo());
  MultibodyDynamics dynamics(model);
  for (int i = 0; i < 50; ++i) {
    const MotionState s = RandomMotionState(&random, *model);
    dynamics.SetState(s.q, s.v, s.a);
    const CentroidalQuantities C = dynamics.Centroidal();
    EXPECT_LT((C.momentum.head(3) - AngularMomentum(dynamics)).norm(), 1e-10);
    // Newton-Euler for the whole robot: the rate of momentum is the base wrench plus gravity.
    const VectorXd rate = C.momentum_dq * s.v + C.momentum_dv * s.a;
    const VectorXd forces = dynamics.InverseDynamics();
    const Vector3d f = forces.segment(3, 3);
    const Vector3d n = forces.head(3) + (s.q.segment<3>(4) - C.position).cross(f);
    EXPECT_LT(RelativeError(rate.head(3), n), 1e-10);
    const Vector3d weight(0, 0, -Hubo().TotalMass() * kGravity);
    EXPECT_LT(RelativeError(rate.tail(3), f + weight), 1e-10);
  }
}

PointTerm RandomTerm(std::mt19937* random, const MultibodyModel& model) {
  const ContactPoint point = RandomPoint(random, model);
  return {point.link,
          point.p_L,
          RandomVector(random, 3, 5),
          RandomVector(random, 3, 5),
          RandomVector(random, 3, 5),
          RandomVector(random, 3, 5)};
}

/// Gradients (q, v, a stacked) of lambda' ID + the point terms, from the first derivatives.
VectorXd Gradient(MultibodyDynamics* dynamics, const VectorXd& lambda,
                  const std::vector<PointTerm>& terms) {
  const int nv = dynamics->model().nv();
  const InverseDynamicsDerivatives& D = dynamics->Differentiate();
  VectorXd gradient(3 * nv);
  gradient << D.dq.transpose() * lambda, D.dv.transpose() * lambda, D.da.transpose() * lambda;
  for (const PointTerm& term : terms) {
    const ContactPoint point{term.link, term.p_L};
    const PointDerivatives& P = dynamics->DifferentiatePoint(point);
    gradient.head(nv) += P.jacobian.transpose() * term.on_position +
                         P.velocity_dq.transpose() * term.on_velocity +
                         P.acceleration_dq.transpose() * term.on_acceleration;
    gradient.segment(nv, nv) += P.jacobian.transpose() * term.on_velocity +
                                P.acceleration_dv.transpose() * term.on_acceleration;
    gradient.tail(nv) += P.jacobian.transpose() * term.on_acceleration;
    MatrixXd force_dq = MatrixXd::Zero(nv, nv);
    dynamics->AddPointForceDerivative(point, term.force, force_dq);
    gradient.head(nv) += force_dq.transpose() * lambda;
  }
  return gradient;
}

TEST(MultibodyDynamicsTest, HessianAgreesWithDifferencesOfGradients) {
  std::mt19937 random(7);
  for (const ModelCase& c : Cases(50, 10)) {
    MultibodyDynamics dynamics(c.model);
    MultibodyDynamics probe(c.model);
    const int nv = c.model->nv();
    for (int i = 0; i < c.states; ++i) {
      const MotionState s = RandomMotionState(&random, *c.model);
      const VectorXd lambda = RandomVector(&random, nv, 1);
      std::vector<PointTerm> terms;
      for (int k = 0; k < i % 4; ++k) terms.push_back(RandomTerm(&random, *c.model));
      dynamics.SetState(s.q, s.v, s.a);
      const HessianProduct H = dynamics.Hessian(lambda, terms);
      const auto gradient = [&](const VectorXd& dq, const VectorXd& dv) {
        probe.SetState(c.model->Displaced(s.q, dq), s.v + dv, s.a);
        return Gradient(&probe, lambda, terms);
      };
      const auto [dq, dv] = StateDifferences(gradient, nv);
      // Along a curve, each of the two orders of rotations has weight one half.
      MatrixXd qq = dq.topRows(nv);
      if (c.model->base() == Base::kFloating) {
        const Eigen::Matrix3d root = qq.topLeftCorner<3, 3>();
        qq.topLeftCorner<3, 3>() = (root + root.transpose()) / 2;
      }
      ASSERT_LT(RelativeError(H.qq, qq), kDerivativeTolerance) << c.name << ", state " << i;
      ASSERT_LT(RelativeError(H.qv, dv.topRows(nv)), kDerivativeTolerance)
          << c.name << ", state " << i;
      ASSERT_LT(RelativeError(H.qv.transpose(), dq.middleRows(nv, nv)), kDerivativeTolerance)
          << c.name;
      ASSERT_LT(RelativeError(H.vv, dv.middleRows(nv, nv)), kDerivativeTolerance) << c.name;
      ASSERT_LT(RelativeError(H.qa.transpose(), dq.bottomRows(nv)), kDerivativeTolerance) << c.name;
      ASSERT_LT(RelativeError(H.qq, H.qq.transpose()), 1e-14);
    }
  }
}

TEST(MultibodyDynamicsTest, HessianIsTheSecondDerivativeAlongAnyCurve) {
  std::mt19937 random(8);
  const ModelPtr model = MultibodyModel::Spatial(RandomTree(&random, 8));
  MultibodyDynamics dynamics(model);
  for (int i = 0; i < 20; ++i) {
    const MotionState s = RandomMotionState(&random, *model);
    const VectorXd lambda = RandomVector(&random, model->nv(), 1);
    const VectorXd direction = RandomVector(&random, model->nv(), 1);
    const auto value = [&](double t) {
      dynamics.SetState(model->Displaced(s.q, t * direction), s.v, s.a);
      return lambda.dot(dynamics.InverseDynamics());
    };
    const double h = 1e-3;
    const double second = (value(h) - 2 * value(0) + value(-h)) / (h * h);
    dynamics.SetState(s.q, s.v, s.a);
    const double expected = direction.dot(dynamics.Hessian(lambda).qq * direction);
    EXPECT_NEAR(second, expected, 1e-4 * std::max(100.0, std::abs(expected)));
  }
}

TEST(MultibodyDynamicsTest, AWorkspaceGivesTheSameResultAfterOtherCalls) {
  std::mt19937 random(9);
  const ModelPtr model = MultibodyModel::Spatial(Hubo());
  MultibodyDynamics used(model);
  for (int i = 0; i < 20; ++i) {
    const MotionState s = RandomMotionState(&random, *model);
    used.SetState(s.q, s.v, s.a);
    used.Hessian(RandomVector(&random, model->nv(), 1), {RandomTerm(&random, *model)});
    used.Differentiate();
    MultibodyDynamics fresh(model);
    fresh.SetState(s.q, s.v);
    fresh.SetAcceleration(s.a);
    const VectorXd lambda = RandomVector(&random, model->nv(), 1);
    EXPECT_EQ(used.InverseDynamics(), fresh.InverseDynamics());
    EXPECT_EQ(used.Differentiate().dq, fresh.Differentiate().dq);
    EXPECT_EQ(used.Hessian(lambda).qq, fresh.Hessian(lambda).qq);
    EXPECT_EQ(used.Hessian(lambda).qa, fresh.Hessian(lambda).qa);
  }
}

TEST(MultibodyDynamicsTest, InvalidArgumentsAreRefusedByName) {
  const ModelPtr model = MultibodyModel::Spatial(Hubo());
  MultibodyDynamics dynamics(model);
  VectorXd q = VectorXd::Zero(model->nq());
  q[0] = 1;
  const VectorXd v = VectorXd::Zero(model->nv());
  VectorXd bad = v;
  bad[7] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(MessageOf([&] { dynamics.SetState(v, v); }),
            "MultibodyDynamics: q has 33 elements, expected 34");
  EXPECT_EQ(MessageOf([&] { dynamics.SetState(q, bad); }), "MultibodyDynamics: v is not finite");
  dynamics.SetState(q, v);
  EXPECT_EQ(MessageOf([&] { dynamics.SetAcceleration(bad); }),
            "MultibodyDynamics: a is not finite");
  EXPECT_EQ(MessageOf([&] { dynamics.Hessian(bad); }), "MultibodyDynamics: lambda is not finite");
  EXPECT_EQ(MessageOf([&] {
              dynamics.Position({99, Vector3d::Zero()});
            }),
            "MultibodyDynamics: a point names link 99, the robot has 28");
}

}  // namespace
}  // namespace possibility::dynamics
