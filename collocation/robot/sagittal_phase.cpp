#include "collocation/robot/sagittal_phase.h"

#include <fmt/format.h>

#include <algorithm>

#include "collocation/problem/function.h"
#include "collocation/robot/balance_functions.h"
#include "collocation/robot/multibody_functions.h"
#include "dynamics/tree/tree_kinematics.h"

namespace possibility::collocation {
namespace {

using dynamics::MultibodyModel;

// Typical sizes. The accuracy of a row of the KKT system depends on its scaling.
constexpr double kSpeed = 5;
constexpr double kAcceleration = 50;
constexpr double kForce = 400;
constexpr double kTorque = 100;

void AddCoordinates(const MultibodyModel& model, const SagittalLimits& limits,
                    SagittalPhase* robot) {
  const std::vector<std::string> base = {"pitch", "x", "z"};
  const double acceleration = limits.max_acceleration;
  for (int i = 0; i < model.nv(); ++i) {
    const int joint = i - 3;
    const bool is_joint = joint >= 0;
    const std::string name = is_joint ? model.tree().joints[model.joints()[joint]].name : base[i];
    const Bounds range = is_joint ? Bounds{model.lower()[joint] + limits.joint_margin,
                                           model.upper()[joint] - limits.joint_margin}
                                  : Bounds{-3, 3};
    const double speed =
        is_joint ? limits.speed_fraction * model.velocity()[joint] : limits.max_base_speed;
    robot->q.push_back(robot->phase->AddCoordinate(name, range));
    robot->v.push_back(robot->phase->Rate(robot->q.back()));
    robot->a.push_back(robot->phase->Rate(robot->q.back(), 2));
    robot->phase->SetScale(robot->v.back(), kSpeed);
    robot->phase->SetScale(robot->a.back(), kAcceleration);
    robot->phase->Bound(robot->v.back(), {-speed, speed});
    robot->phase->Bound(robot->a.back(), {-acceleration, acceleration});
  }
}

void AddForces(double weight, const SagittalLimits& limits, SagittalPhase* robot) {
  const double friction = limits.friction * limits.friction_fraction;
  for (std::size_t i = 0; i < robot->points.size(); ++i) {
    const double most = limits.max_normal_force;
    const Variable x = robot->phase->AddControl(fmt::format("fx{}", i),
                                                {-friction * most, friction * most}, kForce);
    const Variable z =
        robot->phase->AddControl(fmt::format("fz{}", i), {limits.min_normal_force, most}, kForce);
    robot->phase->Guess(x, 0);
    robot->phase->Guess(z, weight / static_cast<double>(robot->points.size()));
    robot->phase->Constrain(fmt::format("cone {}", i),
                            Differentiated<2, 2>([friction](const auto& f, auto* g) {
                              (*g)[0] = friction * f[1] + f[0];
                              (*g)[1] = friction * f[1] - f[0];
                            }),
                            {x, z}, {{0, kInfinity}}, At::kEverywhere, {kForce});
    robot->f.push_back(x);
    robot->f.push_back(z);
  }
}

void AddMotion(const std::shared_ptr<const MultibodyModel>& model, const SagittalLimits& limits,
               SagittalPhase* robot) {
  std::vector<Variable> arguments;
  for (const auto* group : {&robot->q, &robot->v, &robot->a, &robot->f}) {
    arguments.insert(arguments.end(), group->begin(), group->end());
  }
  std::vector<Bounds> bounds(3, Bounds{0, 0});
  std::vector<double> scales = {kTorque, kForce, kForce};
  for (const double effort : model->effort()) {
    bounds.push_back({-limits.torque_fraction * effort, limits.torque_fraction * effort});
    scales.push_back(kTorque);
  }
  robot->phase->Constrain("motion", EquationOfMotion(model, robot->points), arguments, bounds,
                          At::kEverywhere, scales);
}

}  // namespace

std::vector<Variable> SagittalPhase::State() const {
  std::vector<Variable> state = q;
  state.insert(state.end(), v.begin(), v.end());
  return state;
}

std::vector<Variable> SagittalPhase::Motion() const {
  std::vector<Variable> motion = State();
  motion.insert(motion.end(), a.begin(), a.end());
  return motion;
}

SagittalPhase AddSagittalPhase(OptimalControlProblem* problem, const std::string& name,
                               const std::shared_ptr<const MultibodyModel>& model,
                               const std::vector<dynamics::ContactPoint>& points,
                               const SagittalLimits& limits) {
  SagittalPhase robot;
  robot.phase = &problem->AddPhase(name, 2);
  robot.points = points;
  AddCoordinates(*model, limits, &robot);
  AddForces(model->tree().TotalMass() * dynamics::kGravity, limits, &robot);
  AddMotion(model, limits, &robot);
  return robot;
}

void ContinueSagittally(OptimalControlProblem* problem, const SagittalPhase& from,
                        const SagittalPhase& to, bool with_velocities) {
  for (std::size_t i = 0; i < from.q.size(); ++i) {
    problem->Continue({from.q[i], At::kEnd}, {to.q[i], At::kStart});
    if (with_velocities) problem->Continue({from.v[i], At::kEnd}, {to.v[i], At::kStart});
  }
}

void AddSquareCost(const std::string& name, const std::vector<Variable>& variables, double scale,
                   double weight, Phase* phase) {
  const double factor = 1 / (scale * scale);
  for (const Variable& variable : variables) {
    phase->AddIntegralCost(name, Differentiated<1, 1>([factor](const auto& z, auto* c) {
                             (*c)[0] = factor * z[0] * z[0];
                           }),
                           {variable}, weight);
  }
}

}  // namespace possibility::collocation
