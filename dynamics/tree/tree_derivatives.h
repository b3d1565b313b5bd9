#pragma once

#include <Eigen/Core>
#include <vector>

#include "dynamics/tree/actuator_torques.h"
#include "dynamics/tree/point_derivatives.h"
#include "dynamics/tree/tree_hessian.h"
#include "dynamics/tree/tree_motion.h"

namespace possibility::dynamics {

/// First derivatives of inverse dynamics tau = M(q) a + c(q, v) + g(q), each nv x nv.
struct InverseDynamicsDerivatives {
  Eigen::VectorXd forces;  ///< tau itself, nv
  Eigen::MatrixXd dq;      ///< with respect to a tangent of q
  Eigen::MatrixXd dv;
  Eigen::MatrixXd da;  ///< the mass matrix
};

/// The centre of mass and the momentum about it (rows 0-2 angular, 3-5 linear), world axes.
struct CentroidalQuantities {
  Eigen::Vector3d position;     ///< m
  Eigen::MatrixXd jacobian;     ///< d position / dq, 3 x nv
  Eigen::VectorXd momentum;     ///< 6: kg m^2/s, kg m/s
  Eigen::MatrixXd momentum_dq;  ///< 6 x nv
  Eigen::MatrixXd momentum_dv;  ///< 6 x nv, the centroidal momentum matrix
};

/// Inverse dynamics of a floating-base tree with exact first and second derivatives: two sweeps
/// over the tree and one product per pair of a joint and its ancestor (docs/dynamics.md), and what
/// the joints' actuators add. q, v, a,
/// generalised forces: TreeKinematics; derivatives with respect to q are with respect to a
/// rotation vector of the root in world axes, a translation, and the joints (nv numbers).
/// Returned references stay valid until the next call of the same function. One workspace per
/// thread; the model must outlive it.
///
/// Sizes are checked: @throws std::invalid_argument.
class TreeDerivatives {
 public:
  explicit TreeDerivatives(const models::RobotModel& model);

  /// Poses and Jacobians at the last state's q.
  const TreeKinematics& kinematics() const { return motion_.kinematics(); }

  /// `q`: nq, `v`: nv, `a`: nv.
  void SetState(const Eigen::Ref<const Eigen::VectorXd>& q,
                const Eigen::Ref<const Eigen::VectorXd>& v,
                const Eigen::Ref<const Eigen::VectorXd>& a) {
    motion_.SetState(q, v, a);
    actuators_.SetVelocity(v);
    actuators_.SetAcceleration(a);
  }
  /// Sets another acceleration at the same q and v.
  void SetAcceleration(const Eigen::Ref<const Eigen::VectorXd>& a) {
    motion_.SetAcceleration(a);
    actuators_.SetAcceleration(a);
  }

  /// Generalised forces at the acceleration set, gravity and actuators included; nv.
  const Eigen::VectorXd& InverseDynamics();
  const Eigen::MatrixXd& MassMatrix();  ///< nv x nv
  const InverseDynamicsDerivatives& Differentiate();

  Eigen::Vector3d Position(int link, const Eigen::Vector3d& p_L) const;
  Eigen::Vector3d Velocity(int link, const Eigen::Vector3d& p_L) const;
  Eigen::Vector3d Acceleration(int link, const Eigen::Vector3d& p_L) const;
  const PointDerivatives& DifferentiatePoint(int link, const Eigen::Vector3d& p_L);
  /// Adds the derivative of J' f with respect to q, f (world axes) held fixed, to `dq`: nv x nv.
  void AddPointForceDerivative(int link, const Eigen::Vector3d& p_L, const Eigen::Vector3d& f,
                               // A writable Eigen::Ref is passed by value.
                               // NOLINTNEXTLINE(performance-unnecessary-value-param)
                               Eigen::Ref<Eigen::MatrixXd> dq) const {
    dynamics::AddPointForceDerivative(motion_, link, p_L, f, dq);
  }

  const CentroidalQuantities& Centroidal();

  /// Second derivatives of lambda' InverseDynamics + the point terms; `lambda`: nv.
  const HessianProduct& Hessian(const Eigen::Ref<const Eigen::VectorXd>& lambda,
                                const std::vector<PointTerm>& terms);
  /// After Hessian at the same state: TreeHessian::DifferentiateVirtualVelocity.
  const Eigen::MatrixXd& DifferentiateVirtualVelocity(int link, const Eigen::Vector3d& p_L) {
    hessian_.DifferentiateVirtualVelocity(link, p_L, &virtual_velocity_dq_);
    return virtual_velocity_dq_;
  }

 private:
  void DifferentiateRoot();
  void DifferentiateJoint(int link);

  TreeMotion motion_;
  ActuatorTorques actuators_;
  Eigen::VectorXd forces_;  // with actuators
  HessianProduct with_actuators_;
  Eigen::MatrixXd mass_matrix_;
  InverseDynamicsDerivatives derivatives_;
  PointDerivatives point_;
  CentroidalQuantities centroidal_;
  TreeHessian hessian_;
  Eigen::MatrixXd virtual_velocity_dq_;
};

}  // namespace possibility::dynamics
