#include "collocation/robot/robot_phase.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "collocation/problem/function.h"
#include "collocation/robot/balance_functions.h"
#include "collocation/robot/multibody_functions.h"
#include "dynamics/tree/tree_kinematics.h"

namespace possibility::collocation {
namespace {

using dynamics::MultibodyModel;

// Typical sizes. The accuracy of a row of the KKT system depends on its scaling.
constexpr double kSpeed = 5;
constexpr double kAccelerationScale = 50;
constexpr double kForce = 400;
constexpr double kTorque = 100;

std::vector<std::string> BaseNames(const MultibodyModel& model) {
  if (model.base() == dynamics::Base::kPlanar) return {"pitch", "x", "z"};
  return {"x", "y", "z", "yaw", "roll", "pitch"};
}

/// m or rad. In space the robot may go anywhere.
Bounds BaseRange(const MultibodyModel& model, int velocity) {
  constexpr double kMost = 3;
  const bool translates =
      std::any_of(model.translations().begin(), model.translations().end(),
                  [velocity](const auto& translation) { return translation.index == velocity; });
  return translates && model.base() != dynamics::Base::kPlanar ? Bounds{} : Bounds{-kMost, kMost};
}

void AddCoordinates(const MultibodyModel& model, const RobotLimits& limits, RobotPhase* robot) {
  const std::vector<std::string> base = BaseNames(model);
  const double acceleration = limits.max_acceleration;
  for (int i = 0; i < model.nv(); ++i) {
    const int joint = i - model.num_base_velocities();
    const bool is_joint = joint >= 0;
    const std::string name = is_joint ? model.tree().joints[model.joints()[joint]].name : base[i];
    const Bounds range = is_joint ? Bounds{model.lower()[joint] + limits.joint_margin,
                                           model.upper()[joint] - limits.joint_margin}
                                  : BaseRange(model, i);
    const double speed =
        is_joint ? limits.speed_fraction * model.velocity()[joint] : limits.max_base_speed;
    robot->q.push_back(robot->phase->AddCoordinate(name, range));
    robot->v.push_back(robot->phase->Rate(robot->q.back()));
    robot->a.push_back(robot->phase->Rate(robot->q.back(), 2));
    robot->phase->SetScale(robot->v.back(), kSpeed);
    robot->phase->SetScale(robot->a.back(), kAccelerationScale);
    robot->phase->Bound(robot->v.back(), {-speed, speed});
    robot->phase->Bound(robot->a.back(), {-acceleration, acceleration});
  }
}

/// friction * f_z >= +-f_x in the plane.
std::shared_ptr<Function> PlanarCone(double friction) {
  return Differentiated<2, 2>([friction](const auto& f, auto* g) {
    (*g)[0] = friction * f[1] + f[0];
    (*g)[1] = friction * f[1] - f[0];
  });
}

/// The pyramid with edges on the cone, whose sides face x and y.
std::shared_ptr<Function> Pyramid(double friction) {
  const double side = friction / std::sqrt(2.0);
  return Differentiated<3, 4>([side](const auto& f, auto* g) {
    (*g)[0] = side * f[2] + f[0];
    (*g)[1] = side * f[2] - f[0];
    (*g)[2] = side * f[2] + f[1];
    (*g)[3] = side * f[2] - f[1];
  });
}

void AddForces(const MultibodyModel& model, const RobotLimits& limits, RobotPhase* robot) {
  const double friction = limits.friction * limits.friction_fraction;
  const double most = limits.max_normal_force;
  const double weight = model.tree().TotalMass() * dynamics::kGravity;
  const bool planar = model.base() == dynamics::Base::kPlanar;
  const auto cone = planar ? PlanarCone(friction) : Pyramid(friction);
  for (std::size_t i = 0; i < robot->points.size(); ++i) {
    std::vector<Variable> force;
    for (const char* axis : planar ? std::vector{"x"} : std::vector{"x", "y"}) {
      force.push_back(robot->phase->AddControl(fmt::format("f{}{}", axis, i),
                                               {-friction * most, friction * most}, kForce));
      robot->phase->Guess(force.back(), 0);
    }
    force.push_back(
        robot->phase->AddControl(fmt::format("fz{}", i), {limits.min_normal_force, most}, kForce));
    robot->phase->Guess(force.back(), weight / static_cast<double>(robot->points.size()));
    robot->phase->Constrain(fmt::format("cone {}", i), cone, force, {{0, kInfinity}},
                            At::kEverywhere, {kForce});
    robot->f.insert(robot->f.end(), force.begin(), force.end());
  }
}

/// Of a joint's torque. `most`: N m or N.
Bounds Within(double most) { return {-most, most}; }

/// |torque + slope * rate| <= limit is the torque-speed line, and the same for the opposite sign.
struct LineLimit {
  TorqueSpeedRow row;
  double most = 0;  ///< N m or N
};

std::vector<LineLimit> LineLimits(const MultibodyModel& model, const RobotLimits& limits) {
  std::vector<LineLimit> lines;
  for (int i = 0; i < model.num_joints(); ++i) {
    const auto& line = model.actuator(i).line;
    if (!line) continue;
    const double most = limits.torque_fraction * line->stall_torque;
    lines.push_back({{i, most / line->no_load_speed}, most});
  }
  return lines;
}

void AddTorques(const MultibodyModel& model, const RobotLimits& limits, RobotPhase* robot) {
  for (int i = 0; i < model.num_joints(); ++i) {
    const double most = limits.torque_fraction * model.effort()[i];
    robot->torques.push_back(robot->phase->AddControl(
        "torque " + model.tree().joints[model.joints()[i]].name, Within(most), kTorque));
    robot->phase->Guess(robot->torques.back(), 0);
  }
  for (const LineLimit& line : LineLimits(model, limits)) {
    const int joint = line.row.joint;
    robot->phase->Constrain(
        "torque and speed of " + model.tree().joints[model.joints()[joint]].name,
        Differentiated<2, 1>(
            [slope = line.row.slope](const auto& z, auto* y) { (*y)[0] = z[0] + slope * z[1]; }),
        {robot->torques[joint], robot->v[model.num_base_velocities() + joint]}, {Within(line.most)},
        At::kEverywhere, {kTorque});
  }
}

void AddMotion(const std::shared_ptr<const MultibodyModel>& model, const RobotLimits& limits,
               RobotPhase* robot) {
  std::vector<Variable> arguments;
  for (const auto* group : {&robot->q, &robot->v, &robot->a, &robot->f, &robot->torques}) {
    arguments.insert(arguments.end(), group->begin(), group->end());
  }
  std::vector<Bounds> bounds(model->nv(), Bounds{0, 0});
  std::vector<double> scales(model->nv(), kTorque);
  for (const auto& translation : model->translations()) scales[translation.index] = kForce;
  if (!robot->torques.empty()) {
    robot->phase->Constrain("motion", ActuatedMotion(model, robot->points), arguments, bounds,
                            At::kEverywhere, scales);
    return;
  }
  for (int i = 0; i < model->num_joints(); ++i) {
    bounds[model->num_base_velocities() + i] = Within(limits.torque_fraction * model->effort()[i]);
  }
  std::vector<TorqueSpeedRow> rows;
  for (const LineLimit& line : LineLimits(*model, limits)) {
    rows.push_back(line.row);
    bounds.push_back(Within(line.most));
    scales.push_back(kTorque);
  }
  robot->phase->Constrain("motion", EquationOfMotion(model, robot->points, rows), arguments, bounds,
                          At::kEverywhere, scales);
}

}  // namespace

std::vector<Variable> RobotPhase::State() const {
  std::vector<Variable> state = q;
  state.insert(state.end(), v.begin(), v.end());
  return state;
}

std::vector<Variable> RobotPhase::Motion() const {
  std::vector<Variable> motion = State();
  motion.insert(motion.end(), a.begin(), a.end());
  return motion;
}

RobotPhase AddRobotPhase(OptimalControlProblem* problem, const std::string& name,
                         const std::shared_ptr<const MultibodyModel>& model,
                         const std::vector<dynamics::ContactPoint>& points,
                         const RobotLimits& limits, Torques torques) {
  RobotPhase robot;
  robot.phase = &problem->AddPhase(name, 2);
  robot.points = points;
  AddCoordinates(*model, limits, &robot);
  AddForces(*model, limits, &robot);
  if (torques == Torques::kControls) AddTorques(*model, limits, &robot);
  AddMotion(model, limits, &robot);
  return robot;
}

void ContinueRobot(OptimalControlProblem* problem, const RobotPhase& from, const RobotPhase& to,
                   bool with_velocities) {
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
