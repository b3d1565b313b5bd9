#include "actions/wholebody/nominal_stance.h"

#include <fmt/format.h>

#include <cmath>

#include "actions/wholebody/motion_error.h"
#include "actions/wholebody/whole_body_task.h"
#include "models/input/input_error.h"
#include "models/robot/rotation_vector.h"

namespace possibility::actions {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// `R` turned by the smallest rotation that makes the patch's normal point straight down.
Matrix3d Flattened(const Matrix3d& R, const Vector3d& normal_L) {
  return models::SmallestRotation(R * normal_L, -Vector3d::UnitZ()).toRotationMatrix() * R;
}

void CheckJointLimits(const models::RobotModel& robot, const models::Gait& gait,
                      const Eigen::VectorXd& q) {
  for (int j = 0; j < robot.num_joints(); ++j) {
    const models::Joint& joint = robot.joints[j];
    if (q[7 + j] < joint.lower || q[7 + j] > joint.upper) {
      throw InputError(fmt::format(
          "{}: gaits.{}.posture: joint {} at {:.4f} rad with the contacts on the ground, limits "
          "are {:.4f} to {:.4f}",
          robot.file.string(), gait.name, joint.name, q[7 + j], joint.lower, joint.upper));
    }
  }
}

}  // namespace

NominalStance SolveNominalStance(const models::RobotModel& robot, const models::Gait& gait) {
  const Eigen::VectorXd guess = robot.Configuration(gait.posture);
  WholeBodySolver solver(robot);
  solver.kinematics().SetPosition(guess);

  WholeBodyTask task;
  task.root_height = Constant(gait.posture.root_height);
  task.root_pitch = Constant(gait.posture.root_pitch);
  task.root_position = ConstantVector<Eigen::Vector2d>(Eigen::Vector2d::Zero());
  task.joints = ConstantVector<Eigen::VectorXd>(gait.posture.joints);
  NominalStance stance;
  stance.gait = &gait;
  for (const models::GaitLimb& limb : gait.limbs) {
    const models::ContactPatch& patch = robot.contacts[limb.contact];
    LimbTask limb_task;
    limb_task.limb = &limb;
    Vector3d centre = solver.kinematics().Position(patch.link, patch.Centre());
    centre.z() = 0;
    limb_task.position = ConstantVector<Vector3d>(centre);
    limb_task.orientation =
        Flattened(solver.kinematics().X_WL()[patch.link].linear(), patch.normal_L);
    task.limbs.push_back(limb_task);
    stance.patch_centres.push_back(centre);
    stance.patch_orientations.push_back(limb_task.orientation);
    const Vector3d ahead = limb_task.orientation * patch.Frame().linear().col(0);
    stance.patch_headings.push_back(limb.hold_orientation ? std::atan2(ahead.y(), ahead.x()) : 0);
  }
  try {
    stance.q = solver.Solve(task, guess).q;
  } catch (const MotionError& error) {
    throw InputError(fmt::format("{}: gaits.{}.posture: the contacts cannot reach the ground: {}",
                                 robot.file.string(), gait.name, error.what()));
  }
  CheckJointLimits(robot, gait, stance.q);
  for (const models::GaitLimb& limb : gait.limbs) {
    const models::ContactPatch& patch = robot.contacts[limb.contact];
    std::vector<Eigen::Vector2d>& points = stance.bearing_points.emplace_back();
    for (const Vector3d& p : patch.points) {
      points.push_back(solver.kinematics().Position(patch.link, p).head<2>());
    }
  }
  stance.centre_of_mass = solver.kinematics().CentreOfMass().head<2>();
  stance.X_SR = solver.kinematics().X_WL().front();
  return stance;
}

}  // namespace possibility::actions
