#include "actions/checks/forces_check.h"

#include <algorithm>
#include <cmath>

#include "actions/checks/limits_check.h"
#include "actions/plan/force_change.h"
#include "dynamics/tree/tree_kinematics.h"

namespace possibility::actions {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Vector6d = Eigen::Matrix<double, 6, 1>;

constexpr double kKnotTolerance = 1e-6;  // of the weight (N), or of weight x 1 m (N m)
// Likewise, rows that no contact force can change.
constexpr double kUnsupplied = 1e-3;
constexpr double kUnsuppliedOfVersion2 = 1e-6;
constexpr double kConeTolerance = 1e-6;  // of the weight

/// Subtracts J' f from the joint rows: each force acts on every joint between its link and the
/// root.
void SubtractJointTorques(const VerifierState& state, const std::vector<BearingPoint>& points,
                          const Matrix3Xd& forces, const models::RobotModel& robot,
                          VectorXd* torques) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector3d p = state.Position(points[i]);
    const Vector3d force = forces.col(i);
    for (int link = points[i].link; link > 0; link = robot.joints[link - 1].parent) {
      const models::Joint& joint = robot.joints[link - 1];
      const Vector3d axis = state.X_WL[link].linear() * joint.axis;
      const Vector3d arm = p - state.X_WL[link].translation();
      (*torques)[link - 1] -= joint.type == models::JointType::kPrismatic
                                  ? axis.dot(force)
                                  : axis.dot(arm.cross(force));
    }
  }
}

void CheckCone(const Vector3d& force, const Vector3d& normal, double friction,
               const BearingPoint& point, const models::RobotModel& robot, double weight,
               const Instant& at, ViolationLog* log) {
  const double tolerance = kConeTolerance * weight;
  const double load = normal.dot(force);
  log->RequireAtLeast(ViolationKind::kFriction, at, load, 0, tolerance, "N",
                      [&] { return NameOf(robot, point) + " pulls on the ground"; });
  log->RequireAtMost(ViolationKind::kFriction, at, (force - load * normal).norm(),
                     friction * std::max(load, 0.0), tolerance, "N",
                     [&] { return NameOf(robot, point) + " tangential force"; });
}

}  // namespace

RealisedForces RealiseForces(const VerifierState& state, const std::vector<BearingPoint>& points,
                             const models::RobotModel& robot,
                             const dynamics::SimbodyDynamics& dynamics) {
  const VectorXd generalised = dynamics.InverseDynamics(state.knot.a);
  Matrix3Xd arms(3, points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    arms.col(i) = state.Position(points[i]) - state.X_WL[0].translation();
  }
  const Vector6d missing = generalised.head<6>() - WrenchOf(arms, state.knot.forces);
  RealisedForces realised;
  realised.declared_residual = missing.cwiseAbs().maxCoeff();
  realised.forces = state.knot.forces;
  if (!points.empty()) {
    const double weight = robot.TotalMass() * dynamics::kGravity;
    realised.forces += LeastForceChange(arms, state.knot.forces, weight, missing);
  }
  realised.residual =
      (generalised.head<6>() - WrenchOf(arms, realised.forces)).cwiseAbs().maxCoeff();
  realised.torques = generalised.tail(robot.num_joints());
  SubtractJointTorques(state, points, realised.forces, robot, &realised.torques);
  return realised;
}

void CheckForces(const VerifierState& state, const PhaseContacts& contacts,
                 const models::RobotModel& robot, const dynamics::SimbodyDynamics& dynamics,
                 bool at_knot, int version, const Instant& at, ViolationLog* log) {
  const RealisedForces realised = RealiseForces(state, contacts.points, robot, dynamics);
  const double weight = robot.TotalMass() * dynamics::kGravity;
  if (at_knot) {
    log->RequireAtMost(ViolationKind::kDynamics, at, realised.declared_residual, 0,
                       kKnotTolerance * weight, "N or N m", [] {
                         return std::string("unactuated rows under the declared contact forces");
                       });
    for (int j = 0; j < robot.num_joints(); ++j) {
      log->RequireAtMost(
          ViolationKind::kDynamics, at, std::abs(state.knot.tau[j] - realised.torques[j]), 0,
          kKnotTolerance * weight, "N m",
          [&] { return robot.joints[j].name + " declared torque off inverse dynamics"; });
    }
  }
  const double unsupplied = version == 2 ? kUnsuppliedOfVersion2 : kUnsupplied;
  log->RequireAtMost(
      ViolationKind::kDynamics, at, realised.residual, 0, unsupplied * weight, "N or N m",
      [] { return std::string("unactuated rows that no contact force can supply"); });
  for (std::size_t i = 0; i < contacts.points.size(); ++i) {
    CheckCone(realised.forces.col(i), contacts.normals.col(i), contacts.friction[i],
              contacts.points[i], robot, weight, at, log);
  }
  CheckTorqueLimits(realised.torques, state.knot.v, robot, at, log);
}

}  // namespace possibility::actions
