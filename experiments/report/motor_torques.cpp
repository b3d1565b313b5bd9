#include "experiments/report/motor_torques.h"

namespace possibility::experiments {

Eigen::VectorXd MotorTorques(const models::RobotModel& robot, const Eigen::VectorXd& tau) {
  Eigen::VectorXd motors = tau;
  for (int i = 0; i < robot.num_joints(); ++i) {
    const auto& mimic = robot.joints[i].mimic;
    if (!mimic) continue;
    motors[mimic->joint] += mimic->multiplier * tau[i];
    motors[i] = 0;
  }
  return motors;
}

}  // namespace possibility::experiments
