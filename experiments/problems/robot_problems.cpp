// Problems of multibody systems in inverse-dynamics form: contact forces are variables, torques are
// rows. Their optima are our own: both linear solvers and a finer mesh agree on them.
#include "experiments/problems/robot_problems.h"

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "collocation/robot/multibody_functions.h"
#include "collocation/robot/point_functions.h"
#include "collocation/robot/robot_phase.h"
#include "dynamics/sagittal/sagittal_reduction.h"
#include "experiments/legged/walk_from_rest.h"
#include "experiments/legged/walking_step.h"

namespace possibility::experiments {
namespace {

using namespace collocation;  // reads like the mathematics
using Eigen::VectorXd;

/// Heel and toe of the feet, in the plane.
std::vector<dynamics::ContactPoint> SoleOf(const dynamics::MultibodyModel& model) {
  std::vector<dynamics::ContactPoint> points;
  for (const models::ContactPatch& patch : model.tree().contacts) {
    if (patch.points.size() != 2) continue;  // a sole, seen from the side
    for (const Eigen::Vector3d& p : patch.points) points.push_back({patch.link, p});
  }
  return points;
}

/// The posture with bent legs, sole flat on the ground, heel at x = 0.
VectorXd Standing(const RobotSystem& model, const dynamics::ContactPoint& heel, double bend) {
  dynamics::MultibodyDynamics dynamics(model);
  VectorXd q = VectorXd::Zero(model->nq());
  const models::RobotModel& tree = model->tree();
  q[3 + tree.JointIndex("LHP")] = -bend;
  q[3 + tree.JointIndex("LKP")] = 2 * bend;
  q[3 + tree.JointIndex("LAP")] = -bend;
  dynamics.SetState(q, VectorXd::Zero(model->nv()));
  const Eigen::Vector3d at = dynamics.Position(heel);
  q[1] = -at.x();
  q[2] = -at.z();
  return q;
}

std::unique_ptr<OptimalControlProblem> SquatToStand(const models::RobotModel& humanoid) {
  auto problem = std::make_unique<OptimalControlProblem>("squat to stand");
  const RobotSystem model = dynamics::SagittalReduction(humanoid).model();
  RobotLimits limits;
  limits.friction = humanoid.friction;
  const RobotPhase robot = AddRobotPhase(problem.get(), "rise", model, SoleOf(*model), limits);
  robot.phase->SetDuration(1);

  const VectorXd crouch = Standing(model, robot.points[0], 0.9);
  const VectorXd upright = Standing(model, robot.points[0], 0.1);
  for (int i = 0; i < crouch.size(); ++i) {
    robot.phase->Fix(robot.q[i], crouch[i], At::kStart);
    robot.phase->Fix(robot.q[i], upright[i], At::kEnd);
    robot.phase->Fix(robot.v[i], 0, At::kStart);
    robot.phase->Fix(robot.v[i], 0, At::kEnd);
  }
  // The sole stays in place: three of its points' four velocity components are held, the fourth
  // follows. At the ends all velocities are zero anyway.
  robot.phase->Constrain("sole", PointVelocities(model, robot.points), robot.State(),
                         {{0, 0}, {0, 0}, {-kInfinity, kInfinity}, {0, 0}}, At::kInside);
  AddSquareCost("acceleration", robot.a, 10, 1, robot.phase);
  AddSquareCost("force", robot.f, 4000, 1, robot.phase);
  return problem;
}

}  // namespace

std::vector<RegressionProblem> RobotProblems(const models::RobotModel& humanoid) {
  return {
      {"drchubo1_squat_to_stand",
       "ours: both linear solvers, and a mesh of 80 intervals",
       {{"global", 0.478078, 1e-5}},
       [humanoid] { return SquatToStand(humanoid); },
       20},
      {"drchubo1_walking_step",
       "ours: both linear solvers, and a mesh of 40 intervals",
       {{"global", 0.846036, 2e-5}},
       [humanoid] { return WalkingStep(humanoid); },
       15},
      {"drchubo1_walk",
       "ours, of the nonlinear program on this mesh: both linear solvers (10 intervals per phase: "
       "3.89659, 20: 3.88346)",
       {{"global", 3.92101345, 1e-6}},
       [humanoid] { return WalkFromRest(humanoid); },
       5}};
}

}  // namespace possibility::experiments
