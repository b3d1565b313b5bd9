#include "dynamics/sagittal/sagittal_reduction.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <string>

#include "dynamics/tree/multibody_dynamics.h"
#include "models/input/input_error.h"
#include "models/robot/robot_yaml.h"
#include "tests/dynamics/newton_euler.h"
#include "tests/dynamics/random_robot.h"
#include "tests/dynamics/sagittal/random_symmetric_robot.h"
#include "tests/message_of.h"

namespace possibility::dynamics {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using models::JointType;

/// E, one column per velocity.
MatrixXd Expansion(const SagittalReduction& reduction) {
  const int nv = reduction.model()->nv();
  MatrixXd E(reduction.full().nv(), nv);
  for (int i = 0; i < nv; ++i) E.col(i) = reduction.ExpandVelocity(VectorXd::Unit(nv, i));
  return E;
}

/// Both robots at one random state. The full one uses recursions of its own.
struct Twins {
  Twins(const SagittalReduction& reduction, std::mt19937* random)
      : q(RandomVector(random, reduction.model()->nq(), 1.5)),
        v(RandomVector(random, reduction.model()->nv(), 3)),
        a(RandomVector(random, reduction.model()->nv(), 20)),
        full(MultibodyModel::Spatial(reduction.full())),
        planar(reduction.model()) {
    full.SetState(reduction.ExpandConfiguration(q), reduction.ExpandVelocity(v),
                  reduction.ExpandVelocity(a));
    planar.SetState(q, v, a);
  }
  VectorXd q, v, a;
  MultibodyDynamics full;
  MultibodyDynamics planar;
};

void ExpectSameDynamics(const SagittalReduction& reduction, int states, std::mt19937* random) {
  const MatrixXd E = Expansion(reduction);
  for (int state = 0; state < states; ++state) {
    Twins twins(reduction, random);
    const VectorXd full = E.transpose() * twins.full.InverseDynamics();
    EXPECT_LT((full - twins.planar.InverseDynamics()).norm(), 1e-9 * full.norm());
    EXPECT_LT((reduction.ReduceForces(twins.full.InverseDynamics()) - full).norm(),
              1e-12 * full.norm());
    const MatrixXd M = E.transpose() * twins.full.MassMatrix() * E;
    EXPECT_LT((M - twins.planar.MassMatrix()).norm(), 1e-9 * M.norm());

    const CentroidalQuantities& f = twins.full.Centroidal();
    const CentroidalQuantities& p = twins.planar.Centroidal();
    for (const int axis : {0, 2}) EXPECT_NEAR(f.position[axis], p.position[axis], 1e-11);
    for (const int axis : {1, 3, 5}) {
      EXPECT_NEAR(f.momentum[axis], p.momentum[axis], 1e-9 * (1 + f.momentum.norm()));
    }
    // Every link of the full robot moves like its link of the tree in the plane.
    for (int link = 0; link < reduction.full().num_links(); ++link) {
      const ContactPoint point{link, RandomVector(random, 3, 0.3)};
      const ContactPoint lumped = reduction.LumpedPoint(point);
      MatrixXd J(3, reduction.full().nv());
      MatrixXd J_planar(3, reduction.model()->nv());
      twins.full.Jacobian(point, J);
      twins.planar.Jacobian(lumped, J_planar);
      EXPECT_LT((J * E - J_planar).norm(), 1e-10);
      Vector3d apart = twins.full.Position(point) - twins.planar.Position(lumped);
      apart.y() = 0;
      EXPECT_LT(apart.norm(), 1e-11);
      EXPECT_LT((twins.full.Velocity(point) - twins.planar.Velocity(lumped)).norm(), 1e-10);
      EXPECT_LT((twins.full.Acceleration(point) - twins.planar.Acceleration(lumped)).norm(), 1e-8);
    }
  }
}

/// Forces at the lumped contacts have the same effect as the forces that they expand to.
void ExpectSameContactForces(const SagittalReduction& reduction, std::mt19937* random) {
  const models::RobotModel& tree = reduction.model()->tree();
  Twins twins(reduction, random);
  for (std::size_t contact = 0; contact < tree.contacts.size(); ++contact) {
    const models::ContactPatch& patch = tree.contacts[contact];
    for (std::size_t i = 0; i < patch.points.size(); ++i) {
      const int c = static_cast<int>(contact);
      const int p = static_cast<int>(i);
      Vector3d force = RandomVector(random, 3, 100);
      force.y() = 0;
      const auto& points = reduction.FullPoints(c, p);
      const Eigen::Matrix3Xd forces = reduction.ExpandContactForce(c, p, force);
      ASSERT_EQ(forces.cols(), static_cast<Eigen::Index>(points.size()));
      VectorXd full = VectorXd::Zero(reduction.full().nv());
      for (std::size_t k = 0; k < points.size(); ++k) {
        twins.full.AddPointForce(points[k], forces.col(k), full);
      }
      VectorXd planar = VectorXd::Zero(reduction.model()->nv());
      twins.planar.AddPointForce({patch.link, patch.points[i]}, force, planar);
      EXPECT_LT((reduction.ReduceForces(full) - planar).norm(), 1e-10 * (1 + full.norm()));
      const OutOfPlaneForces out = reduction.OutOfPlane(full);
      EXPECT_LT(std::abs(out.force_y) + std::abs(out.moment_x) + std::abs(out.moment_z) +
                    out.pair_difference,
                1e-9);
    }
  }
}

void ExpectRoundTrips(const SagittalReduction& reduction, std::mt19937* random) {
  const int nv = reduction.model()->nv();
  for (int trial = 0; trial < 20; ++trial) {
    const VectorXd q = RandomVector(random, reduction.model()->nq(), 3);
    VectorXd full = reduction.ExpandConfiguration(q);
    EXPECT_LT((reduction.ReduceConfiguration(full) - q).norm(), 1e-12);
    full.head<4>() *= -3;
    EXPECT_LT((reduction.ReduceConfiguration(full) - q).norm(), 1e-12);
    const VectorXd v = RandomVector(random, nv, 3);
    EXPECT_EQ(reduction.ReduceVelocity(reduction.ExpandVelocity(v)), v);
    const VectorXd forces = RandomVector(random, nv, 100);
    EXPECT_LT((reduction.ReduceForces(reduction.ExpandForces(forces)) - forces).norm(), 1e-11);
  }
}

double LargestOutOfPlane(const SagittalReduction& reduction, std::mt19937* random) {
  double largest = 0;
  for (int trial = 0; trial < 50; ++trial) {
    Twins twins(reduction, random);
    const OutOfPlaneForces out = reduction.OutOfPlane(twins.full.InverseDynamics());
    largest = std::max({largest, std::abs(out.force_y), std::abs(out.moment_x),
                        std::abs(out.moment_z), out.pair_difference});
  }
  return largest;
}

TEST(SagittalReduction, DrcHuboAndItsReductionMoveAlikeInThePlane) {
  std::mt19937 random(1);
  const SagittalReduction reduction(DrcHubo());
  ExpectSameDynamics(reduction, 200, &random);
  for (int i = 0; i < 20; ++i) ExpectSameContactForces(reduction, &random);
  ExpectRoundTrips(reduction, &random);
}

TEST(SagittalReduction, DrcHuboWithFoldedHandsAndItsReductionMoveAlike) {
  std::mt19937 random(2);
  const models::RobotModel robot = DrcHubo();
  const SagittalReduction reduction(robot, robot.GaitNamed("crawl").posture.joints);
  const int wrist = robot.JointIndex("LWR");
  const VectorXd q = reduction.ExpandConfiguration(VectorXd::Zero(reduction.model()->nq()));
  EXPECT_EQ(q[7 + wrist], robot.GaitNamed("crawl").posture.joints[wrist]);
  ExpectSameDynamics(reduction, 50, &random);
  ExpectRoundTrips(reduction, &random);
  // The robot's own nominal posture is one of the lumped robot's.
  const VectorXd crawl = robot.Configuration(robot.GaitNamed("crawl").posture);
  EXPECT_LT((reduction.ExpandConfiguration(reduction.ReduceConfiguration(crawl)) - crawl).norm(),
            1e-12);
}

TEST(SagittalReduction, DrcHuboFoldsIntoSevenLinks) {
  const models::RobotModel robot = DrcHubo();
  const SagittalReduction reduction(robot);
  const models::RobotModel& tree = reduction.model()->tree();
  std::vector<std::string> joints;
  for (const models::Joint& joint : tree.joints) joints.push_back(joint.name);
  std::vector<std::string> sorted = joints;
  std::sort(sorted.begin(), sorted.end());
  EXPECT_EQ(sorted, (std::vector<std::string>{"LAP", "LEP", "LHP", "LKP", "LSP", "LWP"}));
  EXPECT_EQ(tree.num_links(), 7);
  EXPECT_NEAR(tree.TotalMass(), robot.TotalMass(), 1e-12);
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const SagittalJoint& pair = reduction.joints()[i];
    EXPECT_EQ(robot.joints[pair.left].name, joints[i]);
    EXPECT_EQ(robot.joints[pair.right].name, "R" + joints[i].substr(1));
    EXPECT_EQ(pair.right_sign, 1);
    EXPECT_EQ(tree.joints[i].effort, 200);
    EXPECT_EQ(tree.joints[i].lower, robot.joints[pair.left].lower);
  }
  // Heel and toe of both soles, and the tip of both pegs.
  ASSERT_EQ(tree.contacts.size(), 2u);
  EXPECT_EQ(tree.contacts[0].name, "left_sole");
  ASSERT_EQ(tree.contacts[0].points.size(), 2u);
  EXPECT_EQ(reduction.FullPoints(0, 0).size(), 4u);
  EXPECT_EQ(tree.contacts[1].name, "left_peg");
  ASSERT_EQ(tree.contacts[1].points.size(), 1u);
  EXPECT_EQ(reduction.FullPoints(1, 0).size(), 2u);
  EXPECT_THROW(reduction.FullPoints(1, 1), std::out_of_range);
}

TEST(SagittalReduction, RandomSymmetricRobotsAndTheirReductionsMoveAlike) {
  std::mt19937 random(3);
  for (int robot = 0; robot < 30; ++robot) {
    const SagittalReduction reduction(RandomSymmetricRobot(&random));
    ExpectSameDynamics(reduction, 5, &random);
    ExpectSameContactForces(reduction, &random);
    ExpectRoundTrips(reduction, &random);
    // Mirror images load the plane equally from both sides.
    EXPECT_LT(LargestOutOfPlane(reduction, &random), 1e-8);
  }
}

TEST(SagittalReduction, AsymmetricMassesKeepTheDynamicsAndActOutOfPlane) {
  std::mt19937 random(4);
  for (int robot = 0; robot < 30; ++robot) {
    const SagittalReduction reduction(RandomSymmetricRobot(&random, false));
    ExpectSameDynamics(reduction, 5, &random);
    EXPECT_GT(LargestOutOfPlane(reduction, &random), 1);
  }
}

TEST(SagittalReduction, DrcHuboIsSymmetricButForHandsAndTrunk) {
  // The published right hand has one finger more, and the trunk's com is off the plane by 2 mm.
  std::mt19937 random(5);
  const models::RobotModel robot = DrcHubo();
  const SagittalReduction reduction(robot);
  MultibodyDynamics full(MultibodyModel::Spatial(robot));
  full.SetState(robot.Configuration(robot.GaitNamed("walk").posture), VectorXd::Zero(robot.nv()));
  const OutOfPlaneForces out = reduction.OutOfPlane(full.InverseDynamics());
  EXPECT_LT(std::abs(out.force_y), 1e-9);
  EXPECT_LT(std::abs(out.moment_z), 1e-9);
  EXPECT_GT(out.pair_difference, 1e-3);
  EXPECT_LT(out.pair_difference, 0.5);
  EXPECT_LT(std::abs(out.moment_x), 2);
  models::RobotModel evened = robot;
  for (const auto& [left, right] : robot.sagittal_pairs) {
    models::Inertial& r = evened.links[right + 1].inertial;
    const models::Inertial& l = evened.links[left + 1].inertial;
    r.mass = l.mass;
    r.p_LC = SymmetricRobotBuilder::Mirrored(l.p_LC);
    const Eigen::Matrix3d mirror = Vector3d(1, -1, 1).asDiagonal();
    r.I_LC = mirror * l.I_LC * mirror;
  }
  const SagittalReduction even(evened);
  for (int trial = 0; trial < 50; ++trial) {
    Twins twins(even, &random);
    EXPECT_LT(even.OutOfPlane(twins.full.InverseDynamics()).pair_difference, 1e-8);
  }
}

TEST(SagittalReduction, LumpedInertiasArePhysical) {
  std::mt19937 random(6);
  for (int robot = 0; robot < 20; ++robot) {
    const SagittalReduction reduction(RandomSymmetricRobot(&random, robot % 2 == 0));
    for (const models::Link& link : reduction.model()->tree().links) {
      EXPECT_GT(link.inertial.mass, 0);
      EXPECT_EQ(link.inertial.p_LC.y(), 0);
      const Vector3d moments = link.inertial.I_LC.diagonal();
      EXPECT_TRUE(link.inertial.I_LC.isDiagonal(0));
      EXPECT_GT(moments.minCoeff(), 0);
      EXPECT_GE(moments.sum() - 2 * moments.maxCoeff(), 0);
    }
  }
}

TEST(SagittalReduction, EffortsAreSharedSoThatBothJointsReachTheirLimits) {
  std::mt19937 random(7);
  const SagittalReduction reduction(RandomSymmetricRobot(&random));
  const MultibodyModel& model = *reduction.model();
  VectorXd forces = VectorXd::Zero(model.nv());
  forces.tail(model.num_joints()) = model.effort();
  const VectorXd full = reduction.ExpandForces(forces);
  for (const SagittalJoint& pair : reduction.joints()) {
    for (const int joint : {pair.left, pair.right}) {
      EXPECT_NEAR(std::abs(full[6 + joint]), reduction.full().joints[joint].effort, 1e-10);
    }
  }
}

TEST(SagittalReduction, PositionLimitsIntersectAndFollowTheSign) {
  std::mt19937 random(8);
  SymmetricRobotBuilder builder(&random);
  for (int i = 0; i < 6; ++i) builder.AddPair(0, 0, JointType::kRevolute, Vector3d::UnitY());
  models::RobotModel& robot = builder.model();
  for (const auto& [left, right] : robot.sagittal_pairs) {
    robot.joints[left].lower = -0.5;
    robot.joints[right].velocity = 4;
  }
  const SagittalReduction reduction(robot);
  for (std::size_t i = 0; i < reduction.joints().size(); ++i) {
    const SagittalJoint& pair = reduction.joints()[i];
    const models::Joint& lumped = reduction.model()->tree().joints[i];
    EXPECT_EQ(lumped.lower, -0.5);
    EXPECT_EQ(lumped.upper, 2);
    EXPECT_EQ(lumped.velocity, 4);
    const models::Joint& right = robot.joints[pair.right];
    EXPECT_EQ(right.lower, pair.right_sign > 0 ? -1 : -2);
  }
}

/// A pair of pitch joints, each with a follower further out, and a middle one.
struct CoupledRobot {
  explicit CoupledRobot(std::mt19937* random) : builder(random) {
    middle = builder.AddMiddle(0, JointType::kRevolute, Vector3d::UnitY()) - 1;
    hips = builder.AddPair(0, 0, JointType::kRevolute, Vector3d::UnitY());
    knees = builder.AddPair(hips.first, hips.second, JointType::kRevolute, Vector3d::UnitY());
  }
  /// -1 or 1: right over left, from the axes in the world at rest.
  double Sign(const std::pair<int, int>& links) {
    const auto axis = [&](int link) {
      TreeKinematics kinematics(builder.model());
      kinematics.SetPosition(VectorXd::Unit(builder.model().nq(), 0));
      return (kinematics.X_WL()[link].linear() * builder.model().joints[link - 1].axis).y();
    };
    return axis(links.first) * axis(links.second) > 0 ? 1 : -1;
  }
  void Couple(int joint, int master, double multiplier, double offset) {
    builder.model().joints[joint].mimic = models::Mimic{master, multiplier, offset};
  }
  SymmetricRobotBuilder builder;
  int middle = 0;
  std::pair<int, int> hips;
  std::pair<int, int> knees;
};

TEST(SagittalReduction, MimicJointsAreFoldedWithTheirCouplings) {
  std::mt19937 random(9);
  for (int trial = 0; trial < 10; ++trial) {
    CoupledRobot robot(&random);
    const double hip = robot.Sign(robot.hips);
    const double knee = robot.Sign(robot.knees);
    robot.Couple(robot.knees.first - 1, robot.hips.first - 1, -0.5, 0.2);
    robot.Couple(robot.knees.second - 1, robot.hips.second - 1, -0.5 * hip * knee, 0.2 * knee);
    const SagittalReduction reduction(robot.builder.model());
    EXPECT_EQ(reduction.model()->num_joints(), 2);
    const VectorXd q = RandomVector(&random, reduction.model()->nq(), 1);
    const VectorXd full = reduction.ExpandConfiguration(q);
    for (const models::Joint& joint : robot.builder.model().joints) {
      if (!joint.mimic) continue;
      const int index = robot.builder.model().JointIndex(joint.name);
      EXPECT_NEAR(full[7 + index],
                  joint.mimic->multiplier * full[7 + joint.mimic->joint] + joint.mimic->offset,
                  1e-12);
    }
    ExpectRoundTrips(reduction, &random);
    // Every joint of the full tree, coupled or not, has an entry in the full quantities.
    const MatrixXd E = Expansion(reduction);
    const VectorXd v = RandomVector(&random, reduction.model()->nv(), 2);
    const VectorXd a = RandomVector(&random, reduction.model()->nv(), 9);
    TreeKinematics kinematics(robot.builder.model());
    kinematics.SetPosition(full);
    kinematics.SetVelocity(reduction.ExpandVelocity(v));
    MultibodyDynamics planar(reduction.model());
    planar.SetState(q, v, a);
    const VectorXd expected = E.transpose() * NewtonEuler(kinematics, E * a);
    EXPECT_LT((planar.InverseDynamics() - expected).norm(), 1e-9 * expected.norm());
  }
}

TEST(SagittalReduction, ARightJointMayMimicItsLeftOne) {
  std::mt19937 random(10);
  CoupledRobot robot(&random);
  robot.Couple(robot.hips.second - 1, robot.hips.first - 1, robot.Sign(robot.hips), 0);
  const SagittalReduction reduction(robot.builder.model());
  EXPECT_EQ(reduction.model()->num_joints(), 3);
  ExpectRoundTrips(reduction, &random);
  EXPECT_EQ(reduction.model()->tree().joints[1].effort,
            robot.builder.model().joints[robot.hips.first - 1].effort);
  robot.Couple(robot.hips.second - 1, robot.hips.first - 1, 0.7, 0);
  EXPECT_THROW(SagittalReduction{robot.builder.model()}, InputError);
}

std::string Refusal(const models::RobotModel& robot,
                    const std::optional<VectorXd>& locked = std::nullopt) {
  return MessageOf<InputError>([&] { SagittalReduction reduction(robot, locked); });
}

bool Mentions(const std::string& text, const std::vector<std::string>& words) {
  return std::all_of(words.begin(), words.end(),
                     [&](const std::string& word) { return text.find(word) != std::string::npos; });
}

TEST(SagittalReduction, RefusesAsymmetricRobotsByName) {
  const models::RobotModel good = DrcHubo();
  const int left = good.JointIndex("LKP");
  const int right = good.JointIndex("RKP");
  models::RobotModel robot = good;
  robot.joints[right].X_PJ.translation().x() += 1e-4;
  EXPECT_TRUE(Mentions(Refusal(robot),
                       {robot.file.string() + ":", "'LKP' and 'RKP'", "places differ", "0.0001"}))
      << Refusal(robot);
  robot = good;
  robot.joints[right].axis = Vector3d(0, 1, 1e-3).normalized();
  EXPECT_TRUE(Mentions(Refusal(robot), {"'LKP' and 'RKP'", "axes differ"})) << Refusal(robot);
  robot = good;
  robot.joints[right].type = JointType::kPrismatic;
  EXPECT_TRUE(Mentions(Refusal(robot), {"'LKP' and 'RKP'", "types"})) << Refusal(robot);
  robot = good;
  robot.joints[left].lower = 1;
  robot.joints[right].upper = 0.5;
  EXPECT_TRUE(Mentions(Refusal(robot), {"'LKP' and 'RKP'", "limits"})) << Refusal(robot);
  robot = good;
  robot.contacts[good.ContactIndex("right_sole")].points[0].x() += 0.01;
  EXPECT_TRUE(Mentions(Refusal(robot), {"'left_sole'", "mirror image"})) << Refusal(robot);
  robot = good;
  robot.sagittal_pairs.emplace_back(left, good.JointIndex("TSY"));
  EXPECT_TRUE(Mentions(Refusal(robot), {"'LKP'", "more than one pair"})) << Refusal(robot);
  robot = good;
  robot.sagittal_pairs.emplace_back(good.JointIndex("TSY"), 99);
  EXPECT_TRUE(Mentions(Refusal(robot), {"99"})) << Refusal(robot);
  VectorXd locked = VectorXd::Zero(good.num_joints());
  locked[good.JointIndex("LHR")] = 0.1;
  EXPECT_TRUE(Mentions(Refusal(good, locked), {"'LHR' and 'RHR'", "not symmetric"}))
      << Refusal(good, locked);
}

TEST(SagittalReduction, RefusesCouplingsThatLeaveThePlaneOrDiffer) {
  std::mt19937 random(11);
  CoupledRobot robot(&random);
  robot.Couple(robot.knees.first - 1, robot.hips.first - 1, -0.5, 0);
  EXPECT_TRUE(Mentions(Refusal(robot.builder.model()), {"differently"}));
  CoupledRobot other(&random);
  const int yaw = other.builder.AddMiddle(0, JointType::kRevolute, Vector3d::UnitZ()) - 1;
  other.Couple(other.middle, yaw, 1, 0);
  EXPECT_TRUE(Mentions(Refusal(other.builder.model()), {"does not move in the plane"}));
  other.builder.model().joints[other.middle].mimic.reset();
  other.Couple(yaw, other.middle, 1, 0);
  EXPECT_TRUE(Mentions(Refusal(other.builder.model()), {"leaves the plane"}));
}

TEST(SagittalReduction, RefusesHalvesOnLinksThatMoveDifferently) {
  std::mt19937 random(12);
  SymmetricRobotBuilder builder(&random);
  const int spine = builder.AddMiddle(0, JointType::kRevolute, Vector3d::UnitY());
  builder.AddPair(0, spine, JointType::kRevolute, Vector3d::UnitY());
  EXPECT_TRUE(Mentions(Refusal(builder.model()), {"do not move alike"}));
}

TEST(SagittalReduction, RefusesStatesOutOfThePlaneByName) {
  const models::RobotModel robot = DrcHubo();
  const SagittalReduction reduction(robot);
  const VectorXd good = robot.Configuration(robot.GaitNamed("walk").posture);
  const auto refusal = [&](int index, double change) {
    VectorXd q = good;
    q[index] += change;
    return MessageOf([&] { reduction.ReduceConfiguration(q, 1e-6); });
  };
  EXPECT_EQ(refusal(5, 1e-7), "no error");
  EXPECT_TRUE(Mentions(refusal(5, 1e-5), {"root"}));
  EXPECT_TRUE(Mentions(refusal(1, 1e-3), {"root"}));
  EXPECT_TRUE(Mentions(refusal(7 + robot.JointIndex("RKP"), 1e-3), {"'RKP'"}));
  EXPECT_TRUE(Mentions(refusal(7 + robot.JointIndex("TSY"), 1e-3), {"'TSY'"}));
  VectorXd q = good;
  q.head<4>().setZero();
  EXPECT_TRUE(Mentions(MessageOf([&] { reduction.ReduceConfiguration(q); }), {"quaternion"}));
  VectorXd v = VectorXd::Zero(robot.nv());
  v[6 + robot.JointIndex("LKP")] = 1;
  EXPECT_TRUE(Mentions(MessageOf([&] { reduction.ReduceVelocity(v); }), {"'RKP'"}));
}

TEST(SagittalReduction, RefusesMalformedArguments) {
  const models::RobotModel robot = DrcHubo();
  const SagittalReduction reduction(robot);
  const VectorXd short_one = VectorXd::Zero(3);
  EXPECT_TRUE(Mentions(MessageOf([&] { reduction.ExpandConfiguration(short_one); }), {"q has 3"}));
  EXPECT_TRUE(Mentions(MessageOf([&] { reduction.ExpandVelocity(short_one); }), {"v has 3"}));
  EXPECT_TRUE(Mentions(MessageOf([&] { reduction.ExpandForces(short_one); }), {"forces has 3"}));
  EXPECT_TRUE(
      Mentions(MessageOf([&] { reduction.ReduceForces(short_one); }), {"full_forces has 3"}));
  EXPECT_TRUE(Mentions(MessageOf([&] { reduction.OutOfPlane(short_one); }), {"full_forces has 3"}));
  const VectorXd nan = VectorXd::Constant(reduction.model()->nv(), NAN);
  EXPECT_TRUE(Mentions(MessageOf([&] { reduction.ExpandVelocity(nan); }), {"v is not finite"}));
  const VectorXd q = reduction.ExpandConfiguration(VectorXd::Zero(reduction.model()->nq()));
  EXPECT_TRUE(Mentions(MessageOf([&] { reduction.ReduceConfiguration(q, NAN); }), {"tolerance"}));
  EXPECT_TRUE(Mentions(MessageOf([&] { reduction.LumpedPoint({99, Vector3d::Zero()}); }), {"99"}));
  EXPECT_TRUE(Mentions(MessageOf([&] { SagittalReduction(robot, short_one); }), {"locked has 3"}));
}

}  // namespace
}  // namespace possibility::dynamics
