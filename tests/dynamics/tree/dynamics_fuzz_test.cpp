#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "dynamics/contact/contact_feasibility.h"
#include "dynamics/forward/forward_dynamics.h"
#include "dynamics/sagittal/sagittal_reduction.h"
#include "models/robot/robot_yaml.h"
#include "tests/dynamics/random_robot.h"

namespace possibility::dynamics {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
/// The arguments of one round.
struct Arguments {
  VectorXd q, v, a, forces;
  std::vector<HeldPoint> points;
  ContactForceSettings settings;
  bool huge = false;  ///< so large that results may overflow
  /// A word that the exception's message must contain, where an argument is invalid.
  std::string bad_argument;

  std::vector<ContactPoint> ContactPoints() const {
    std::vector<ContactPoint> result;
    for (const HeldPoint& held : points) result.push_back(held.point);
    return result;
  }
};

struct Counts {
  int succeeded = 0;
  int refused = 0;
  int not_held = 0;
  int overflowed = 0;
  int forces_found = 0;
};

/// One robot whose workspaces are used again and again. A failed call must leave them usable.
class Subject {
 public:
  explicit Subject(const std::shared_ptr<const MultibodyModel>& model)
      : model_(model), forward_(model), without_feedback_(model, {kInfinity}) {}

  void Round(std::mt19937* random, Counts* counts) {
    Arguments arguments = Drawn(random);
    if ((*random)() % 5 < 2) Spoil(random, &arguments);
    try {
      Run(arguments, random, counts);
      EXPECT_EQ(arguments.bad_argument, "") << "was accepted";
      ++counts->succeeded;
    } catch (const std::invalid_argument& error) {
      const std::string text = error.what();
      if (arguments.bad_argument.empty()) {
        EXPECT_TRUE(arguments.huge && text.find("so large") != std::string::npos) << text;
        ++counts->overflowed;
      } else {
        EXPECT_NE(text.find(arguments.bad_argument), std::string::npos)
            << text << "\nexpected to name " << arguments.bad_argument;
        ++counts->refused;
      }
    }
  }

 private:
  Arguments Drawn(std::mt19937* random) {
    Arguments arguments;
    DrawState(random, &arguments);
    const int nv = model_->nv();
    arguments.a = RandomVector(random, nv, 10);
    arguments.forces = RandomVector(random, nv, 100);
    const std::vector<ContactPoint> points = DrawPoints(random);
    forward_.SetState(arguments.q, VectorXd::Zero(nv));
    for (const ContactPoint& point : points) {
      arguments.points.push_back({point, forward_.dynamics()->Position(point)});
    }
    if ((*random)() % 2 == 0 && !arguments.huge) PlantContactForces(random, &arguments);
    return arguments;
  }

  /// Sets the acceleration to one that torques within limits and forces in the cones produce.
  void PlantContactForces(std::mt19937* random, Arguments* arguments) {
    VectorXd forces = VectorXd::Zero(model_->nv());
    forward_.SetState(arguments->q, arguments->v);
    for (int i = 0; i < model_->num_joints(); ++i) {
      forces[model_->num_base_velocities() + i] = Uniform(random, -0.9, 0.9) * model_->effort()[i];
    }
    for (const HeldPoint& held : arguments->points) {
      const Vector3d across = held.point.normal_W.cross(RandomVector(random, 3, 1).head<3>());
      const Vector3d force = held.point.normal_W + 0.3 * across.normalized();
      const double size = Uniform(random, 0, 500);
      forward_.dynamics()->AddPointForce(held.point, size * force, forces);
    }
    arguments->a = forward_.Free(forces);
  }

  void DrawState(std::mt19937* random, Arguments* arguments) {
    VectorXd& q = arguments->q;
    q = RandomVector(random, model_->nq(), 2);
    // Straight legs and arms, with the root anywhere.
    if ((*random)() % 3 == 0) q.tail(model_->num_joints()).setZero();
    if (model_->base() == Base::kFloating && (*random)() % 4 == 0) q.head<7>().setUnit(0);
    switch ((*random)() % 6) {
      case 0:
        arguments->v = VectorXd::Zero(model_->nv());
        break;
      case 1:
        arguments->v = RandomVector(random, model_->nv(), std::pow(10, Uniform(random, 1, 7)));
        break;
      case 2:
        arguments->v = RandomVector(random, model_->nv(), std::pow(10, Uniform(random, 60, 300)));
        arguments->huge = true;
        break;
      default:
        arguments->v = RandomVector(random, model_->nv(), 2);
    }
  }

  ContactPoint RandomPoint(std::mt19937* random) {
    const int link = static_cast<int>((*random)() % model_->tree().num_links());
    return {link, RandomVector(random, 3, 0.3)};
  }

  std::vector<ContactPoint> DrawPoints(std::mt19937* random) {
    std::vector<ContactPoint> points;
    const ContactPoint first = RandomPoint(random);
    const Vector3d direction = RandomVector(random, 3, 0.1);
    switch ((*random)() % 6) {
      case 0:
        break;
      case 1:  // coincident
        points.assign(2 + (*random)() % 3, first);
        points.push_back(RandomPoint(random));
        break;
      case 2:  // in one line on one link
        for (int i = 0; i < 4; ++i) points.push_back({first.link, first.p_L + i * direction});
        break;
      case 3:
        for (int i = 0; i < 4; ++i) points.push_back(RandomPoint(random));
        break;
      default:  // whole patches, or a single point where the robot has none
        for (const models::ContactPatch& patch : model_->tree().contacts) {
          if ((*random)() % 3 == 0) continue;
          for (const Vector3d& p : patch.points) points.push_back({patch.link, p});
        }
        if (points.empty()) points.push_back(first);
    }
    for (ContactPoint& point : points) {
      if ((*random)() % 4 == 0) point.normal_W = RandomVector(random, 3, 1).normalized();
    }
    return points;
  }

  /// Makes one argument wrong.
  void Spoil(std::mt19937* random, Arguments* arguments) {
    if (arguments->huge) arguments->v = RandomVector(random, model_->nv(), 2);
    arguments->huge = false;
    const auto spoil_vector = [&](VectorXd* x, const char* name) {
      arguments->bad_argument = name;
      const double bad[] = {kNan, kInfinity, -kInfinity};
      if ((*random)() % 3 == 0) {
        x->conservativeResize(x->size() + ((*random)() % 2 == 0 ? 1 : -1));
        (*x)[x->size() - 1] = 0;
      } else {
        (*x)[(*random)() % x->size()] = bad[(*random)() % 3];
      }
    };
    const std::size_t index =
        arguments->points.empty() ? 0 : (*random)() % arguments->points.size();
    switch ((*random)() % 10) {
      case 0:
        return spoil_vector(&arguments->q, ": q ");
      case 1:
        return spoil_vector(&arguments->v, ": v ");
      case 2:
        return spoil_vector(&arguments->a, ": a ");
      case 3:
        return spoil_vector(&arguments->forces, ": forces ");
      case 4:
        if (model_->base() != Base::kFloating) return;
        arguments->q.head<4>().setZero();
        arguments->bad_argument = "quaternion";
        return;
      case 5: {
        const double bad[] = {kNan, kInfinity, -1};
        arguments->settings.friction = bad[(*random)() % 3];
        arguments->bad_argument = "settings";
        return;
      }
      default:
        if (!arguments->points.empty()) SpoilPoint(random, index, arguments);
    }
  }

  void SpoilPoint(std::mt19937* random, std::size_t index, Arguments* arguments) {
    HeldPoint& held = arguments->points[index];
    const std::string name = "point " + std::to_string(index);
    const int axis = static_cast<int>((*random)() % 3);
    const int links[] = {-1, model_->tree().num_links(), std::numeric_limits<int>::max()};
    switch ((*random)() % 4) {
      case 0:
        held.point.link = links[(*random)() % 3];
        arguments->bad_argument = name;
        break;
      case 1:
        held.point.p_L[axis] = (*random)() % 2 == 0 ? kNan : kInfinity;
        arguments->bad_argument = name;
        break;
      case 2:
        held.anchor[axis] = kNan;
        arguments->bad_argument = "anchor of " + name;
        break;
      default:
        held.point.normal_W *= 2;
        arguments->bad_argument = name;
    }
  }

  void Run(const Arguments& arguments, std::mt19937* random, Counts* counts) {
    forward_.SetState(arguments.q, arguments.v);
    ExpectFreeMotion(arguments);
    const std::vector<ContactPoint> points = arguments.ContactPoints();
    TryHeld(&forward_, arguments, counts);
    try {
      ExpectImpact(points);
    } catch (const std::runtime_error& error) {
      ExpectNamesPoint(error.what());
      ++counts->not_held;
    }
    forward_.dynamics()->SetAcceleration(arguments.a);
    ExpectContactForces(arguments, points, random, counts);
    // At rest after the impact, the same points can be held far more often.
    if (points.empty()) return;
    VectorXd after;
    try {
      const Impact& impact = forward_.Hit(points);
      after = impact.velocity;
      if ((*random)() % 4 == 0) ExpectImpulses(impact, points, arguments.settings.friction);
    } catch (const std::runtime_error&) {
      return;
    }
    without_feedback_.SetState(arguments.q, after);
    TryHeld(&without_feedback_, arguments, counts);
  }

  static void ExpectNamesPoint(const std::string& text) {
    EXPECT_TRUE(text.find("point") != std::string::npos &&
                text.find("cannot be held") != std::string::npos)
        << text;
  }

  void ExpectFreeMotion(const Arguments& arguments) {
    const VectorXd a = forward_.Free(arguments.forces);
    ASSERT_TRUE(a.allFinite());
    ExpectEquationOfMotion(&forward_, a, arguments.forces, 0);
  }

  /// M a + bias = forces. `other`: size of the other terms in the balance.
  static void ExpectEquationOfMotion(ForwardDynamics* dynamics, const VectorXd& a,
                                     const VectorXd& forces, double other) {
    const int nv = static_cast<int>(a.size());
    dynamics->dynamics()->SetAcceleration(VectorXd::Zero(nv));
    const double bias = dynamics->dynamics()->InverseDynamics().stableNorm();
    dynamics->dynamics()->SetAcceleration(a);
    const double scale = bias + forces.stableNorm() + other +
                         dynamics->dynamics()->MassMatrix().stableNorm() * a.stableNorm();
    EXPECT_LE((dynamics->dynamics()->InverseDynamics() - forces).stableNorm(), 1e-9 * scale);
  }

  void TryHeld(ForwardDynamics* dynamics, const Arguments& arguments, Counts* counts) {
    try {
      ExpectHeld(dynamics, arguments);
    } catch (const std::runtime_error& error) {
      ExpectNamesPoint(error.what());
      ++counts->not_held;
    }
  }

  static void ExpectHeld(ForwardDynamics* dynamics, const Arguments& arguments) {
    const ConstrainedMotion motion = dynamics->Held(arguments.forces, arguments.points);
    ASSERT_TRUE(motion.acceleration.allFinite() && motion.forces.allFinite());
    VectorXd forces = arguments.forces;
    double loads = 0;
    for (std::size_t i = 0; i < arguments.points.size(); ++i) {
      const VectorXd before = forces;
      dynamics->dynamics()->AddPointForce(arguments.points[i].point, motion.forces.col(i), forces);
      loads += (forces - before).stableNorm();
    }
    ExpectEquationOfMotion(dynamics, motion.acceleration, forces, loads);
  }

  void ExpectImpact(const std::vector<ContactPoint>& points) {
    const Impact& impact = forward_.Hit(points);
    ASSERT_TRUE(impact.velocity.allFinite() && impact.impulses.allFinite());
    EXPECT_GE(impact.energy_lost, 0);
    MatrixXd J(3, model_->nv());
    for (const ContactPoint& point : points) {
      forward_.dynamics()->Jacobian(point, J);
      const double scale = J.stableNorm() * (impact.velocity.stableNorm() + Speed(point));
      EXPECT_LE((J * impact.velocity).stableNorm(), 1e-6 * scale);
    }
  }

  double Speed(const ContactPoint& point) {
    return 1 + forward_.dynamics()->Velocity(point).stableNorm();
  }

  void ExpectContactForces(const Arguments& arguments, const std::vector<ContactPoint>& points,
                           std::mt19937* random, Counts* counts) {
    MultibodyDynamics* dynamics = forward_.dynamics();
    const auto result = DistributeContactForces(dynamics, points, arguments.settings);
    if (!result) return;
    ++counts->forces_found;
    VectorXd left = dynamics->InverseDynamics();
    const double scale = 1 + left.norm();
    const int base = model_->num_base_velocities();
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vector3d force = result->forces.col(i);
      dynamics->AddPointForce(points[i], -force, left);
      EXPECT_GE(force.dot(points[i].normal_W), -1e-9 * scale);
      EXPECT_LE(FrictionUsed(points[i], force), arguments.settings.friction);
    }
    // Each row is balanced to 1e-9 of the weight, however little the motion requires.
    const double weight = model_->tree().TotalMass() * kGravity;
    EXPECT_LE(left.head(base).norm(), 1e-8 * scale + std::sqrt(6.0) * 1e-9 * weight);
    EXPECT_LE((left.tail(model_->num_joints()) - result->torques).norm(), 1e-8 * scale);
    if ((*random)() % 8 != 0) return;
    const auto margins = ComputeContactMargins(dynamics, points, arguments.settings);
    ASSERT_TRUE(margins);
    EXPECT_LE(margins->friction_fraction, result->friction_utilisation);
    EXPECT_LE(margins->effort_fraction, result->torque_utilisation);
    EXPECT_GE(std::min(margins->friction_fraction, margins->effort_fraction), 0);
  }

  void ExpectImpulses(const Impact& impact, const std::vector<ContactPoint>& points,
                      double friction) {
    const ImpulseFeasibility result = CheckImpact(&forward_, impact, points, friction);
    EXPECT_EQ(result.feasible, result.friction_fraction <= 1);
    EXPECT_TRUE(result.impulses.allFinite());
    VectorXd change = VectorXd::Zero(model_->nv());
    double scale = 1;
    for (std::size_t i = 0; i < points.size(); ++i) {
      forward_.dynamics()->AddPointForce(points[i], result.impulses.col(i) - impact.impulses.col(i),
                                         change);
      scale += impact.impulses.col(i).norm() + result.impulses.col(i).norm();
    }
    EXPECT_LE(change.norm(), 1e-6 * scale);
  }

  std::shared_ptr<const MultibodyModel> model_;
  ForwardDynamics forward_;
  ForwardDynamics without_feedback_;
};

/// DRC-HUBO1, its planar reduction and random trees, one with coupled joints.
std::vector<std::unique_ptr<Subject>> Subjects(std::mt19937* random) {
  const models::RobotModel robot =
      models::LoadRobotModel(POSSIBILITY_SOURCE_DIR "/models/drchubo1/drchubo1.yaml");
  std::vector<std::unique_ptr<Subject>> subjects;
  subjects.push_back(std::make_unique<Subject>(MultibodyModel::Spatial(robot)));
  subjects.push_back(std::make_unique<Subject>(SagittalReduction(robot).model()));
  for (int i = 0; i < 6; ++i) {
    models::RobotModel tree = RandomTree(random, 3 * i);
    for (int k = 0; k < tree.num_links(); ++k) tree.links[k].name = "link " + std::to_string(k);
    if (i == 5) tree.joints[3].mimic = models::Mimic{8, 0.5, 0.1};
    subjects.push_back(std::make_unique<Subject>(MultibodyModel::Spatial(tree)));
  }
  return subjects;
}

TEST(DynamicsFuzz, ResultsSatisfyTheirEquationsOrFailuresNameTheirCause) {
  constexpr int kRounds = 10000;
  std::mt19937 random(1);
  const std::vector<std::unique_ptr<Subject>> subjects = Subjects(&random);
  Counts counts;
  for (int round = 0; round < kRounds; ++round) {
    SCOPED_TRACE(round);
    // Half of them on DRC-HUBO1.
    const std::size_t subject = random() % 2 == 0 ? 0 : random() % subjects.size();
    subjects[subject]->Round(&random, &counts);
    if (HasFailure()) return;
  }
  EXPECT_GT(counts.succeeded, kRounds / 4);
  EXPECT_GT(counts.refused, kRounds / 5);
  EXPECT_GT(counts.not_held, kRounds / 50);
  EXPECT_GT(counts.overflowed, kRounds / 50);
  EXPECT_GT(counts.forces_found, kRounds / 10);
}

}  // namespace
}  // namespace possibility::dynamics
