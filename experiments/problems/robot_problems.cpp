// Problems of multibody systems in inverse-dynamics form: contact forces are variables, torques are
// rows. Their optima are our own: both linear solvers and a finer mesh agree on them.
#include "experiments/problems/robot_problems.h"

#include <fmt/format.h>

#include <cmath>

#include "collocation/robot/balance_functions.h"
#include "collocation/robot/multibody_functions.h"
#include "collocation/robot/point_functions.h"
#include "dynamics/sagittal/sagittal_reduction.h"

namespace possibility::experiments {
namespace {

using namespace collocation;  // reads like the mathematics
using Eigen::VectorXd;

/// A problem that owns the objects its functions refer to.
struct RobotProblem {
  explicit RobotProblem(const models::RobotModel& robot)
      : model(dynamics::SagittalReduction(robot).model()) {}

  PlanarModel model;
  std::vector<dynamics::ContactPoint> points;
  std::vector<Variable> q, v, a, f;
};

void AddRobot(RobotProblem* robot, Phase* phase) {
  const dynamics::MultibodyModel& model = *robot->model;
  const std::vector<std::string> base = {"pitch", "x", "z"};
  for (int i = 0; i < model.nv(); ++i) {
    const bool is_joint = i >= 3;
    const int joint = i - 3;
    const std::string name = is_joint ? model.tree().joints[model.joints()[joint]].name : base[i];
    const Bounds bounds =
        is_joint ? Bounds{model.lower()[joint], model.upper()[joint]} : Bounds{-3, 3};
    robot->q.push_back(phase->AddCoordinate(name, bounds));
    robot->v.push_back(phase->Rate(robot->q.back()));
    robot->a.push_back(phase->Rate(robot->q.back(), 2));
    phase->SetScale(robot->v.back(), 5);
    phase->SetScale(robot->a.back(), 50);
    const double speed = is_joint ? model.velocity()[joint] : 10;
    phase->Bound(robot->v.back(), {-speed, speed});
    phase->Bound(robot->a.back(), {-200, 200});
  }
}

/// Forces within their cones at every point, torques within their limits.
void AddDynamics(RobotProblem* robot, Phase* phase, double friction) {
  constexpr double kForce = 400;
  constexpr double kTorque = 100;
  for (std::size_t i = 0; i < robot->points.size(); ++i) {
    const Variable x = phase->AddControl(fmt::format("fx{}", i), {-1000, 1000}, kForce);
    const Variable z = phase->AddControl(fmt::format("fz{}", i), {0, 2000}, kForce);
    robot->f.push_back(x);
    robot->f.push_back(z);
    phase->Guess(z, kForce / 4);
    phase->Constrain(fmt::format("cone{}", i),
                     Differentiated<2, 2>([friction](const auto& f, auto* g) {
                       (*g)[0] = friction * f[1] + f[0];
                       (*g)[1] = friction * f[1] - f[0];
                     }),
                     {x, z}, {{0, kInfinity}}, At::kEverywhere, {kForce});
  }
  std::vector<Variable> arguments;
  for (const auto* group : {&robot->q, &robot->v, &robot->a, &robot->f}) {
    arguments.insert(arguments.end(), group->begin(), group->end());
  }
  std::vector<Bounds> bounds(3, Bounds{0, 0});
  std::vector<double> scales = {kTorque, kForce, kForce};
  for (const double effort : robot->model->effort()) {
    bounds.push_back({-effort, effort});
    scales.push_back(kTorque);
  }
  phase->Constrain("motion", EquationOfMotion(robot->model, robot->points), arguments, bounds,
                   At::kEverywhere, scales);
}

/// The posture with bent legs, sole flat on the ground, heel at x = 0.
VectorXd Standing(const RobotProblem& robot, double bend) {
  dynamics::MultibodyDynamics dynamics(robot.model);
  VectorXd q = VectorXd::Zero(robot.model->nq());
  const models::RobotModel& tree = robot.model->tree();
  q[3 + tree.JointIndex("LHP")] = -bend;
  q[3 + tree.JointIndex("LKP")] = 2 * bend;
  q[3 + tree.JointIndex("LAP")] = -bend;
  dynamics.SetState(q, VectorXd::Zero(robot.model->nv()));
  const Eigen::Vector3d heel = dynamics.Position(robot.points[0]);
  q[1] = -heel.x();
  q[2] = -heel.z();
  return q;
}

std::unique_ptr<OptimalControlProblem> SquatToStand(const models::RobotModel& humanoid) {
  auto problem = std::make_unique<OptimalControlProblem>("squat to stand");
  Phase& phase = problem->AddPhase("rise", 2);
  RobotProblem robot(humanoid);
  for (const models::ContactPatch& patch : robot.model->tree().contacts) {
    if (patch.points.size() != 2) continue;  // a sole, seen from the side
    for (const Eigen::Vector3d& p : patch.points) robot.points.push_back({patch.link, p});
  }
  AddRobot(&robot, &phase);
  AddDynamics(&robot, &phase, humanoid.friction);
  phase.SetDuration(1);

  const VectorXd crouch = Standing(robot, 0.9);
  const VectorXd upright = Standing(robot, 0.1);
  for (int i = 0; i < crouch.size(); ++i) {
    phase.Fix(robot.q[i], crouch[i], At::kStart);
    phase.Fix(robot.q[i], upright[i], At::kEnd);
    phase.Fix(robot.v[i], 0, At::kStart);
    phase.Fix(robot.v[i], 0, At::kEnd);
  }
  // The sole stays in place: three of its points' four velocity components are held, the fourth
  // follows. At the ends all velocities are zero anyway.
  std::vector<Variable> arguments = robot.q;
  arguments.insert(arguments.end(), robot.v.begin(), robot.v.end());
  phase.Constrain("sole", PointVelocities(robot.model, robot.points), arguments,
                  {{0, 0}, {0, 0}, {-kInfinity, kInfinity}, {0, 0}}, At::kInside);
  for (const Variable& a : robot.a) {
    phase.AddIntegralCost(
        "acceleration",
        Differentiated<1, 1>([](const auto& z, auto* c) { (*c)[0] = z[0] * z[0] / 100.0; }), {a});
  }
  for (const Variable& f : robot.f) {
    phase.AddIntegralCost(
        "force",
        Differentiated<1, 1>([](const auto& z, auto* c) { (*c)[0] = z[0] * z[0] / 1.6e7; }), {f});
  }
  return problem;
}

}  // namespace

std::vector<RegressionProblem> RobotProblems(const models::RobotModel& humanoid) {
  return {{"drchubo1_squat_to_stand",
           "ours: both linear solvers, and a mesh of 80 intervals",
           {{"global", 0.478078, 1e-5}},
           [humanoid] { return SquatToStand(humanoid); },
           20}};
}

}  // namespace possibility::experiments
