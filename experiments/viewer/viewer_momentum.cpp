#include "experiments/viewer/viewer_momentum.h"

namespace possibility::experiments {

CentroidalState CentroidalStateAt(const actions::Knot& knot, dynamics::TreeKinematics* kinematics) {
  kinematics->SetPosition(knot.q);
  kinematics->SetVelocity(knot.v);
  CentroidalState state{kinematics->CentreOfMass(),
                        kinematics->total_mass() * kinematics->CentreOfMassVelocity(),
                        Eigen::Vector3d::Zero()};
  const models::RobotModel& robot = kinematics->model();
  for (int link = 0; link < robot.num_links(); ++link) {
    const models::Inertial& inertial = robot.links[link].inertial;
    if (inertial.mass == 0) continue;
    const Eigen::Vector3d arm = kinematics->Position(link, inertial.p_LC) - state.position;
    const Eigen::Matrix3d R = kinematics->X_WL()[link].linear();
    state.angular += arm.cross(inertial.mass * kinematics->Velocity(link, inertial.p_LC)) +
                     R * inertial.I_LC * R.transpose() * kinematics->AngularVelocity(link);
  }
  return state;
}

}  // namespace possibility::experiments
