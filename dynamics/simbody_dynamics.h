#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "models/robot_model.h"

namespace possibility::dynamics {

/// The robot as a Simbody multibody system with its State: the reference that our own recursions
/// are held to, and the engine of the verifier. One instance per thread (a shared system aborts
/// in forward dynamics). Conventions of q, v, a: models::RobotModel; of generalised forces:
/// TreeKinematics.
class SimbodyDynamics {
 public:
  explicit SimbodyDynamics(const models::RobotModel& model);
  ~SimbodyDynamics();
  SimbodyDynamics(SimbodyDynamics&&) noexcept;

  void SetState(const Eigen::Ref<const Eigen::VectorXd>& q,
                const Eigen::Ref<const Eigen::VectorXd>& v);

  /// M(q) a + c(q, v) + g(q), gravity included; nv.
  Eigen::VectorXd InverseDynamics(const Eigen::Ref<const Eigen::VectorXd>& a) const;
  Eigen::MatrixXd MassMatrix() const;  ///< nv x nv

  Eigen::Isometry3d LinkPose(int link) const;
  Eigen::Vector3d PointPosition(int link, const Eigen::Vector3d& p_L) const;
  Eigen::Vector3d PointVelocity(int link, const Eigen::Vector3d& p_L) const;
  Eigen::Matrix3Xd PointJacobian(int link, const Eigen::Vector3d& p_L) const;  ///< 3 x nv
  /// J-dot v of PointJacobian.
  Eigen::Vector3d PointBias(int link, const Eigen::Vector3d& p_L) const;
  Eigen::Vector3d CentreOfMass() const;
  Eigen::Vector3d CentreOfMassVelocity() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace possibility::dynamics
