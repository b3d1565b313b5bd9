#include "collocation/robot/placed_patch.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <random>

#include "collocation/robot/point_functions.h"
#include "dynamics/tree/multibody_model.h"
#include "tests/collocation/robot/exact_derivatives.h"
#include "tests/dynamics/random_robot.h"

namespace possibility::collocation {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// A body with one contact whose points are given in the contact's frame.
RobotSystem BodyWithPatch(const std::vector<Vector3d>& points) {
  std::mt19937 random(1);
  models::RobotModel body = dynamics::RandomTree(&random, 1);
  models::ContactPatch patch;
  patch.name = "patch";
  patch.points = points;
  body.contacts = {patch};
  return dynamics::MultibodyModel::OnJoints(body);
}

const std::vector<Vector3d> kSole = {
    {0.137, 0.077, -0.1}, {-0.076, 0.077, -0.1}, {-0.076, -0.067, -0.1}, {0.137, -0.067, -0.1}};

Eigen::Isometry3d SomePlace(std::mt19937* random) {
  const VectorXd turn = dynamics::RandomVector(random, 3, 2);
  const VectorXd place = dynamics::RandomVector(random, 3, 1);
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.rotate(Eigen::AngleAxisd(turn.norm(), turn.normalized()));
  X.pretranslate(Vector3d(place));
  return X;
}

/// Rates of the components of a rigid body's points, by its six velocities: (rotation, place).
Eigen::MatrixXd RatesOf(const PlacedPatch& patch) {
  const std::vector<PointComponent> components = HoldingComponents(patch);
  Eigen::MatrixXd rates(components.size(), 6);
  for (std::size_t i = 0; i < components.size(); ++i) {
    Vector3d place = Vector3d::Zero();
    for (std::size_t k = 0; k < patch.points.size(); ++k) {
      if (patch.points[k].p_L == components[i].point.p_L) place = patch.places[k];
    }
    rates.row(i) << place.cross(components[i].axis).transpose(), components[i].axis.transpose();
  }
  return rates;
}

TEST(PlacedPatchTest, ASoleIsHeldBySixIndependentComponentsAnywhere) {
  std::mt19937 random(2);
  const RobotSystem model = BodyWithPatch(kSole);
  for (int trial = 0; trial < 100; ++trial) {
    const Eigen::MatrixXd rates = RatesOf(Place(*model, 0, SomePlace(&random)));
    ASSERT_EQ(rates.rows(), 6);
    // Points of a sole are 0.14 m apart, so that no turn moves them by less than 0.05 m per rad.
    EXPECT_GT(rates.jacobiSvd().singularValues().minCoeff(), 0.03);
  }
}

TEST(PlacedPatchTest, AnEdgeIsHeldByFiveAndAPointByThree) {
  std::mt19937 random(3);
  const RobotSystem edge = BodyWithPatch({kSole[0], kSole[3]});
  const RobotSystem point = BodyWithPatch({kSole[0]});
  for (int trial = 0; trial < 20; ++trial) {
    const Eigen::Isometry3d place = SomePlace(&random);
    EXPECT_EQ(RatesOf(Place(*edge, 0, place)).fullPivLu().rank(), 5);
    EXPECT_EQ(HoldingComponents(Place(*edge, 0, place)).size(), 5U);
    EXPECT_EQ(RatesOf(Place(*point, 0, place)).fullPivLu().rank(), 3);
    EXPECT_EQ(HoldingComponents(Place(*point, 0, place)).size(), 3U);
  }
}

TEST(PlacedPatchTest, PlacesAreThoseOfTheRobotThatStandsThere) {
  // The patch is on the root: its pose gives the robot's.
  std::mt19937 random(4);
  const RobotSystem model = BodyWithPatch(kSole);
  for (int trial = 0; trial < 50; ++trial) {
    VectorXd q = dynamics::RandomVector(&random, model->nv(), 1);
    dynamics::MultibodyDynamics dynamics(model);
    dynamics.SetState(q, VectorXd::Zero(model->nv()));
    const models::ContactPatch& patch = model->tree().contacts[0];
    Eigen::Isometry3d X_WL = Eigen::Isometry3d::Identity();
    const Vector3d origin = dynamics.Position({patch.link, Vector3d::Zero()});
    for (int i = 0; i < 3; ++i) {
      X_WL.linear().col(i) = dynamics.Position({patch.link, Vector3d::Unit(i)}) - origin;
    }
    X_WL.translation() = origin;
    const PlacedPatch placed = Place(*model, 0, X_WL * patch.Frame());
    const std::vector<double> places = HeldPlaces(placed);
    VectorXd positions(6);
    PointPositions(model, HoldingComponents(placed))->Evaluate(q, &positions);
    for (int i = 0; i < 6; ++i) EXPECT_NEAR(positions[i], places[i], 1e-12);
  }
}

TEST(PlacedPatchTest, PressureReserveIsTheDistanceOfTheCentreOfPressureFromTheEdges) {
  constexpr double kReserve = 0.02;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> load(0.1, 1);
  const RobotSystem model = BodyWithPatch(kSole);
  for (int trial = 0; trial < 50; ++trial) {
    const PlacedPatch patch = Place(*model, 0, SomePlace(&random));
    VectorXd forces(12);
    Vector2d moment = Vector2d::Zero();
    double normal = 0;
    for (int i = 0; i < 4; ++i) {
      // Along the surface, too, which moves no centre of pressure.
      const double bears = load(random);
      const Vector3d n = patch.points[i].normal_W;
      forces.segment<3>(3 * i) = bears * n + n.cross(Vector3d::Random());
      moment += bears * patch.in_patch[i];
      normal += bears;
    }
    const Vector2d centre = moment / normal;
    VectorXd rows(4);
    PressureReserve(patch, kReserve)->Evaluate(forces, &rows);
    // Distances from the four edges of the rectangle 0.213 m x 0.144 m about its middle.
    Eigen::Vector4d distances(0.072 - centre.y(), 0.1065 + centre.x(), 0.072 + centre.y(),
                              0.1065 - centre.x());
    for (int edge = 0; edge < 4; ++edge) {
      EXPECT_NEAR(rows[edge], normal * (distances[edge] - kReserve), 1e-12);
    }
  }
}

}  // namespace
}  // namespace possibility::collocation
