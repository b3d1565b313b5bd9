// The solved walking problems, compared with mechanics written by hand, body by body, and with the
// published log.
#include "experiments/problems/walking_problems.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>

#include "experiments/regression/regression_run.h"

namespace possibility::experiments {
namespace {

using collocation::OptimalControlResult;
using collocation::PhaseTrajectory;
using Eigen::Vector2d;
using Eigen::VectorXd;
using Angles = Eigen::Vector<double, 5>;

constexpr double kGravity = 9.80665;
/// The source's gravity is 9.81. Its motion is ours, faster by this factor.
const double kSlower = std::sqrt(9.81 / kGravity);

RegressionProblem ProblemNamed(const std::string& name) {
  for (const RegressionProblem& problem : WalkingProblems()) {
    if (problem.name == name) return problem;
  }
  throw std::logic_error(name);
}

/// Each problem is solved once, as `regress` solves it.
const OptimalControlResult& Solved(const std::string& name) {
  static std::map<std::string, OptimalControlResult> results;
  if (!results.count(name)) {
    const RegressionProblem problem = ProblemNamed(name);
    results[name] = SolveOptimalControl(*problem.build(), RegressionOptions{}.For(problem));
  }
  return results[name];
}

const char* const kSteps[] = {"five_link_step", "five_link_step_short", "five_link_step_forward"};

// ---- Planar mechanics: x forward, z up, angles from the vertical, positive forward. ----

struct Body {
  double mass, inertia;
  Vector2d position, velocity;
  double spin;
};
using Bodies = std::vector<Body>;

Vector2d Direction(double angle) { return {std::sin(angle), std::cos(angle)}; }
Vector2d DirectionRate(double angle, double rate) {
  return rate * Vector2d(std::cos(angle), -std::sin(angle));
}

double Energy(const Bodies& bodies) {
  double energy = 0;
  for (const Body& b : bodies) {
    energy += b.mass * (b.velocity.squaredNorm() / 2 + kGravity * b.position.y()) +
              b.inertia * b.spin * b.spin / 2;
  }
  return energy;
}

double AngularMomentum(const Bodies& bodies, const Vector2d& about) {
  double momentum = 0;
  for (const Body& b : bodies) {
    const Vector2d r = b.position - about;
    momentum += b.mass * (r.y() * b.velocity.x() - r.x() * b.velocity.y()) + b.inertia * b.spin;
  }
  return momentum;
}

Vector2d Momentum(const Bodies& bodies) {
  Vector2d momentum = Vector2d::Zero();
  for (const Body& b : bodies) momentum += b.mass * b.velocity;
  return momentum;
}

Vector2d CentreOfMass(const Bodies& bodies) {
  Vector2d moment = Vector2d::Zero();
  double mass = 0;
  for (const Body& b : bodies) {
    moment += b.mass * b.position;
    mass += b.mass;
  }
  return moment / mass;
}

/// Simpson's rule over the duration of a phase.
template <typename Integrand>
double TimeIntegral(const PhaseTrajectory& phase, Integrand&& integrand) {
  constexpr int kIntervals = 2000;
  double sum = 0;
  for (int i = 0; i <= kIntervals; ++i) {
    const double weight = i == 0 || i == kIntervals ? 1 : i % 2 == 1 ? 4 : 2;
    sum += weight * integrand(static_cast<double>(i) / kIntervals);
  }
  return sum * phase.duration / (3 * kIntervals);
}

// ---- The biped. ----

constexpr double kMasses[] = {3.2, 6.8, 20, 6.8, 3.2};
constexpr double kInertias[] = {0.93, 1.08, 2.22, 1.08, 0.93};
/// Centre of mass k = sum over i of Arms()(k, i) times the direction of link i. The last one is the
/// foot.
Eigen::Matrix<double, 6, 5> Arms() {
  Eigen::Matrix<double, 6, 5> arms;
  arms << 0.272, 0, 0, 0, 0,      //
      0.4, 0.237, 0, 0, 0,        //
      0.4, 0.4, 0.425, 0, 0,      //
      0.4, 0.4, 0, -0.163, 0,     //
      0.4, 0.4, 0, -0.4, -0.128,  //
      0.4, 0.4, 0, -0.4, -0.4;
  return arms;
}

/// Angles of the links from the vertical, and their rates.
Angles Absolute(const VectorXd& q) {
  Angles angles;
  for (int i = 0; i < 5; ++i) angles[i] = (i == 0 ? 0 : angles[i - 1]) + q[i];
  return angles;
}

Vector2d BipedPoint(int row, const Angles& angles) {
  Vector2d point = Vector2d::Zero();
  for (int i = 0; i < 5; ++i) point += Arms()(row, i) * Direction(angles[i]);
  return point;
}

/// With the stance foot at `foot`.
Bodies BipedBodies(const Angles& angles, const Angles& rates, const Vector2d& foot) {
  Bodies bodies;
  for (int k = 0; k < 5; ++k) {
    Body body{kMasses[k], kInertias[k], foot + BipedPoint(k, angles), Vector2d::Zero(), rates[k]};
    for (int i = 0; i < 5; ++i) body.velocity += Arms()(k, i) * DirectionRate(angles[i], rates[i]);
    bodies.push_back(body);
  }
  return bodies;
}

/// Lagrange's equations of the pinned chain in absolute angles. A_ij = sum of m P_ki P_kj over k:
/// A_ij cos(t_i - t_j) t_j'' + I_i t_i'' + A_ij sin(t_i - t_j) t_j'^2 - g sin(t_i) sum m P_ki.
Angles LagrangeForces(const Angles& t, const Angles& v, const Angles& a) {
  Angles forces;
  for (int i = 0; i < 5; ++i) {
    forces[i] = kInertias[i] * a[i];
    for (int k = 0; k < 5; ++k) {
      forces[i] -= kGravity * kMasses[k] * Arms()(k, i) * std::sin(t[i]);
      for (int j = 0; j < 5; ++j) {
        const double A = kMasses[k] * Arms()(k, i) * Arms()(k, j);
        forces[i] += A * (std::cos(t[i] - t[j]) * a[j] + std::sin(t[i] - t[j]) * v[j] * v[j]);
      }
    }
  }
  return forces;
}

TEST(FiveLinkStep, ObeysLagrangesEquations) {
  for (const char* name : kSteps) {
    const PhaseTrajectory& phase = Solved(name).trajectory.phases.at(0);
    for (int point = 0; point < phase.num_points(); ++point) {
      const Angles forces = LagrangeForces(Absolute(phase.coordinates[0].col(point)),
                                           Absolute(phase.coordinates[1].col(point)),
                                           Absolute(phase.coordinates[2].col(point)));
      // Torque i acts between links i - 1 and i. The foot has no torque.
      const auto torques = phase.controls.col(point).tail<4>();
      for (int i = 0; i < 5; ++i) {
        const double here = i == 0 ? 0 : torques[i - 1];
        const double next = i == 4 ? 0 : torques[i];
        EXPECT_NEAR(forces[i], here - next, 1e-5) << name << " point " << point << " link " << i;
      }
    }
  }
}

TEST(FiveLinkStep, GainsTheWorkOfItsMotors) {
  for (const char* name : kSteps) {
    const PhaseTrajectory& phase = Solved(name).trajectory.phases.at(0);
    const auto energy = [&](double s) {
      return Energy(BipedBodies(Absolute(phase.Coordinates(s)), Absolute(phase.Coordinates(s, 1)),
                                Vector2d::Zero()));
    };
    const double work = TimeIntegral(phase, [&](double s) {
      return phase.Controls(s).tail(4).dot(phase.Coordinates(s, 1).tail(4));
    });
    EXPECT_GT(std::abs(energy(1) - energy(0)), 1) << name;  // what the impact takes away
    EXPECT_NEAR(work, energy(1) - energy(0), 1e-4) << name;
  }
}

/// The contact acts on the new stance foot alone, and hinges transmit no moment. So each part of
/// the chain beyond a hinge keeps its angular momentum about that hinge.
TEST(FiveLinkStep, TheImpactKeepsAngularMomentumAboutEveryHinge) {
  for (const char* name : kSteps) {
    const PhaseTrajectory& phase = Solved(name).trajectory.phases.at(0);
    const Angles angles = Absolute(phase.Coordinates(1));
    const Bodies before = BipedBodies(angles, Absolute(phase.Coordinates(1, 1)), Vector2d::Zero());
    const Vector2d new_foot = BipedPoint(5, angles);
    Bodies after =
        BipedBodies(Absolute(phase.Coordinates(0)), Absolute(phase.Coordinates(0, 1)), new_foot);
    std::reverse(after.begin(), after.end());  // the legs have swapped their names
    const Vector2d old_knee = 0.4 * Direction(angles[0]);
    const Vector2d hip = old_knee + 0.4 * Direction(angles[1]);
    const Vector2d new_knee = hip - 0.4 * Direction(angles[3]);
    const std::pair<int, Vector2d> parts[] = {
        {5, new_foot}, {4, new_knee}, {3, hip}, {2, hip}, {1, old_knee}};
    for (const auto& [links, hinge] : parts) {
      const Bodies part_before(before.begin(), before.begin() + links);
      const Bodies part_after(after.begin(), after.begin() + links);
      EXPECT_NEAR(AngularMomentum(part_before, hinge), AngularMomentum(part_after, hinge), 1e-6)
          << name << ", " << links << " links";
    }
    for (int k = 0; k < 5; ++k) {
      EXPECT_LT((before[k].position - after[k].position).norm(), 1e-8) << name;
    }
    EXPECT_LT(Energy(after), Energy(before) - 1) << name;
    const VectorXd& found = Solved(name).trajectory.parameters;  // lifting velocity, impulse
    EXPECT_LT((Momentum(after) - Momentum(before) - found.segment<2>(2)).norm(), 1e-6) << name;
  }
}

TEST(FiveLinkStep, TheFootStepsOverTheGround) {
  for (const char* name : kSteps) {
    const PhaseTrajectory& phase = Solved(name).trajectory.phases.at(0);
    const double length = std::string(name) == "five_link_step" ? 0.5 : 0.4;
    const auto foot = [&](double s) { return BipedPoint(5, Absolute(phase.Coordinates(s))); };
    EXPECT_LT((foot(0) - Vector2d(-length, 0)).norm(), 1e-8) << name;
    EXPECT_LT((foot(1) - Vector2d(length, 0)).norm(), 1e-8) << name;
    for (double s = 0.01; s < 0.995; s += 0.01) {
      EXPECT_GT(foot(s).y(), 0) << name << " at " << s;
      EXPECT_GT(phase.Controls(s)[1], 100) << name << ": the stance foot pulls at " << s;
    }
  }
}

TEST(FiveLinkStep, KneesDoNotBendForward) {
  const PhaseTrajectory& phase = Solved("five_link_step").trajectory.phases.at(0);
  EXPECT_LT(phase.coordinates[0].row(1).maxCoeff(), 1e-8);
  EXPECT_GT(phase.coordinates[0].row(4).minCoeff(), -1e-8);
}

/// SNOPT's log has the states at the ends, with five digits after the point and angles counted
/// backwards. It stopped at an objective 8e-8 above the limit of finer meshes. There, states still
/// differ by 2e-5 and rates by 2e-4.
TEST(FiveLinkStep, AgreesWithThePublishedStates) {
  const PhaseTrajectory& phase = Solved("five_link_step_short").trajectory.phases.at(0);
  const Angles start = -Angles(0.02013, 0.41495, -0.02620, -0.28219, -0.30287);
  const Angles start_rates = -Angles(-0.89700, -1.16032, 0.17595, -0.31220, -2.00701);
  const Angles end_rates = -Angles(-2.12601, -1.09705, 0.85285, -1.40248, 3.52563);
  EXPECT_LT((Absolute(phase.Coordinates(0)) - start).cwiseAbs().maxCoeff(), 5e-5);
  EXPECT_LT((Absolute(phase.Coordinates(1)) - start.reverse()).cwiseAbs().maxCoeff(), 5e-5);
  EXPECT_LT((kSlower * Absolute(phase.Coordinates(0, 1)) - start_rates).cwiseAbs().maxCoeff(),
            5e-4);
  EXPECT_LT((kSlower * Absolute(phase.Coordinates(1, 1)) - end_rates).cwiseAbs().maxCoeff(), 5e-4);
}

// ---- The hopper: q is the leg's pitch, the foot's x and z, the leg's length, the hip. ----

Bodies HopperBodies(const VectorXd& q, const VectorXd& v) {
  const Vector2d foot(q[1], q[2]), foot_velocity(v[1], v[2]);
  const Vector2d along = Direction(q[0]), along_rate = DirectionRate(q[0], v[0]);
  const double tilt = q[0] + q[4], tilt_rate = v[0] + v[4];
  const Vector2d hip = foot + q[3] * along;
  const Vector2d hip_velocity = foot_velocity + v[3] * along + q[3] * along_rate;
  return {{1, 0.02, foot + 0.2 * along, foot_velocity + 0.2 * along_rate, v[0]},
          {1, 0.01, hip, hip_velocity, v[0]},
          {10, 0.5, hip + 0.1 * Direction(tilt),
           hip_velocity + 0.1 * DirectionRate(tilt, tilt_rate), tilt_rate}};
}

Bodies HopperAt(const PhaseTrajectory& phase, double s) {
  return HopperBodies(phase.Coordinates(s), phase.Coordinates(s, 1));
}

TEST(Hop, FliesOnAParabolaWithConstantAngularMomentum) {
  const PhaseTrajectory& flight = Solved("planar_hop").trajectory.phases.at(1);
  const Bodies first = HopperAt(flight, 0);
  const Vector2d start = CentreOfMass(first), velocity = Momentum(first) / 12;
  const double spin = AngularMomentum(first, start);
  EXPECT_GT(velocity.norm(), 1);
  EXPECT_GT(flight.duration, 0.21);
  EXPECT_LT(flight.duration, 0.49);
  for (double s = 0; s <= 1; s += 0.01) {
    const double t = s * flight.duration;
    const Bodies bodies = HopperAt(flight, s);
    const Vector2d expected = start + velocity * t - Vector2d(0, kGravity * t * t / 2);
    const Vector2d centre = CentreOfMass(bodies);
    EXPECT_LT((centre - expected).norm(), 1e-6) << "at " << s;
    EXPECT_NEAR(AngularMomentum(bodies, centre), spin, 1e-4) << "at " << s;
    EXPECT_GT(flight.Coordinates(s)[2], -1e-6) << "the foot, at " << s;
  }
}

/// The ground acts on the foot alone. The hip transmits no moment, and the leg, which slides
/// freely, no force along itself.
TEST(Hop, TouchdownObeysTheImpactEquations) {
  const auto& trajectory = Solved("planar_hop").trajectory;
  const Bodies before = HopperAt(trajectory.phases.at(1), 1);
  const Bodies after = HopperAt(trajectory.phases.at(2), 0);
  const Vector2d foot(0.4, 0);
  const Vector2d impulse = Momentum(after) - Momentum(before);
  EXPECT_LT((impulse - trajectory.parameters.head<2>()).norm(), 1e-6);
  EXPECT_GT(impulse.y(), 1);
  EXPECT_LE(std::abs(impulse.x()), 0.7 * impulse.y() + 1e-8);
  EXPECT_NEAR(AngularMomentum(after, foot), AngularMomentum(before, foot), 1e-6);
  const Vector2d hip = before[1].position;
  EXPECT_LT((hip - after[1].position).norm(), 1e-8);
  EXPECT_NEAR(AngularMomentum({after[2]}, hip), AngularMomentum({before[2]}, hip), 1e-6);
  const Vector2d along = hip - foot;
  EXPECT_NEAR(along.dot(Momentum({after[1], after[2]})),
              along.dot(Momentum({before[1], before[2]})), 1e-6);
  EXPECT_LT(Energy(after), Energy(before) - 1);
}

TEST(Hop, StanceStaysInItsFrictionConeAndBalancesEnergyAndMomentum) {
  for (const int index : {0, 2}) {
    const PhaseTrajectory& stance = Solved("planar_hop").trajectory.phases.at(index);
    for (int point = 0; point < stance.num_points(); ++point) {
      EXPECT_NEAR(stance.coordinates[0](1, point), index == 0 ? 0 : 0.4, 1e-8);
      EXPECT_NEAR(stance.coordinates[0](2, point), 0, 1e-8);
      const double fx = stance.controls(0, point), fz = stance.controls(1, point);
      EXPECT_LE(std::abs(fx), 0.7 * fz + 1e-4);
    }
    const double gained = Energy(HopperAt(stance, 1)) - Energy(HopperAt(stance, 0));
    const double work = TimeIntegral(stance, [&](double s) {
      return stance.Controls(s).tail(2).dot(stance.Coordinates(s, 1).tail(2));
    });
    const Vector2d push = {TimeIntegral(stance, [&](double s) { return stance.Controls(s)[0]; }),
                           TimeIntegral(stance, [&](double s) { return stance.Controls(s)[1]; })};
    const Vector2d gained_momentum = Momentum(HopperAt(stance, 1)) - Momentum(HopperAt(stance, 0));
    EXPECT_NEAR(work, gained, 1e-3);
    EXPECT_NEAR(push.x(), gained_momentum.x(), 1e-3);
    EXPECT_NEAR(push.y(), gained_momentum.y() + 12 * kGravity * stance.duration, 1e-3);
  }
  const auto& phases = Solved("planar_hop").trajectory.phases;
  EXPECT_LT(phases.front().Coordinates(0, 1).norm(), 1e-8);
  EXPECT_LT(phases.back().Coordinates(1, 1).norm(), 1e-8);
}

// ---- The values. ----

TEST(WalkingProblems, BothLinearSolversAndAFinerMeshAgree) {
  for (const RegressionProblem& problem : WalkingProblems()) {
    RegressionOptions mumps, coarser;
    mumps.linear_solver = collocation::LinearSolver::kMumps;
    coarser.intervals = problem.intervals / 2;
    const double objective = Solved(problem.name).objective;
    const RegressionRecord with_mumps = RunProblem(problem, mumps);
    EXPECT_EQ(with_mumps.status, "solved");
    EXPECT_NEAR(with_mumps.objective / objective, 1, 1e-8) << problem.name;
    EXPECT_NEAR(RunProblem(problem, coarser).objective / objective, 1, 1e-4) << problem.name;
  }
}

TEST(WalkingProblems, EachConvergesToTheExtremalOfItsGuess) {
  const std::map<std::string, std::string> expected = {{"five_link_step", "global"},
                                                       {"five_link_step_short", "knees backward"},
                                                       {"five_link_step_forward", "knees forward"},
                                                       {"planar_hop", "global"}};
  for (const auto& [name, optimum] : expected) {
    const RegressionRecord record = RunProblem(ProblemNamed(name), {});
    EXPECT_TRUE(record.within_tolerance) << name << " " << record.relative_error;
    EXPECT_EQ(record.nearest.name, optimum);
    EXPECT_EQ(record.objective, Solved(name).objective) << "the same bytes again";
  }
}

}  // namespace
}  // namespace possibility::experiments
