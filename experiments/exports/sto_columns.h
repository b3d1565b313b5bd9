#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "dynamics/tree/tree_kinematics.h"
#include "experiments/samples/plan_samples.h"
#include "models/robot/robot_model.h"

namespace possibility::experiments {

/// Angles (rad) of turns about x, then the turned y, then the twice turned z, as OpenSim's free
/// joints have them: R = Rx(a) Ry(b) Rz(c).
class BodyFixedAngles {
 public:
  /// The angles nearest to those of the last call, so that they do not jump.
  Eigen::Vector3d Of(const Eigen::Matrix3d& rotation);
  /// Their rates at an angular velocity (world axes) that turns the rotation of the last call.
  Eigen::Vector3d Rates(const Eigen::Vector3d& angular_velocity) const;

 private:
  Eigen::Vector3d last_ = Eigen::Vector3d::Zero();
};

/// The loads of a patch as OpenSim has external forces.
struct PatchLoad {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< on the robot, N
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< where it acts, m
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();  ///< about that place, N m
};

/// `points`, `forces`: 3 x n, in the world. The centre is the mean of the points, weighted by the
/// magnitudes of their forces; the moment is what is left, so that the load is exact on any ground.
PatchLoad LoadOf(const Eigen::Matrix3Xd& points, const Eigen::Matrix3Xd& forces);

/// Columns and rows of the storage. Samples in the order of time.
class StoTable {
 public:
  /// `robot` must outlive it.
  explicit StoTable(const models::RobotModel& robot);

  const std::vector<std::string>& labels() const { return labels_; }  ///< "time" first
  std::vector<double> Row(const PlanSample& sample);

 private:
  const models::RobotModel& robot_;
  dynamics::TreeKinematics kinematics_;
  BodyFixedAngles angles_;
  std::vector<std::string> labels_;
};

}  // namespace possibility::experiments
