#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "dynamics/tree/contact_point.h"
#include "dynamics/tree/multibody_model.h"
#include "dynamics/tree/tree_derivatives.h"

namespace possibility::dynamics {

/// The dynamics of a MultibodyModel and their exact derivatives, in independent coordinates. One
/// workspace per thread; the model is shared. Derivatives with respect to q are with respect to a
/// tangent (MultibodyModel). Points and vectors are 3-D, world axes, for planar models too.
///
/// Call SetState before everything else. Returned references stay valid until the next call of the
/// same function. Sizes and finiteness are checked: @throws std::invalid_argument that names the
/// bad argument.
class MultibodyDynamics {
 public:
  explicit MultibodyDynamics(std::shared_ptr<const MultibodyModel> model);

  const MultibodyModel& model() const { return *model_; }
  const std::shared_ptr<const MultibodyModel>& shared_model() const { return model_; }

  /// `q`: nq, `v`: nv. The acceleration becomes zero.
  void SetState(const Eigen::Ref<const Eigen::VectorXd>& q,
                const Eigen::Ref<const Eigen::VectorXd>& v);
  /// The same with an acceleration, nv, in one sweep.
  void SetState(const Eigen::Ref<const Eigen::VectorXd>& q,
                const Eigen::Ref<const Eigen::VectorXd>& v,
                const Eigen::Ref<const Eigen::VectorXd>& a);
  /// Sets another acceleration at the same state; nv. Costs nothing if it is the one set.
  void SetAcceleration(const Eigen::Ref<const Eigen::VectorXd>& a);

  /// M(q) a + c(q, v) + g(q), with the torques of rotors and friction, at the acceleration set; nv.
  const Eigen::VectorXd& InverseDynamics();
  /// nv x nv, symmetric; with the rotors.
  const Eigen::MatrixXd& MassMatrix();
  /// First derivatives of InverseDynamics at the acceleration set, each nv x nv.
  const InverseDynamicsDerivatives& Differentiate();

  /// MultibodyModel::TorqueLimits at the state set.
  const Eigen::VectorXd& torque_limits() const { return torque_limits_; }

  Eigen::Vector3d Position(const ContactPoint& point) const;
  Eigen::Vector3d Velocity(const ContactPoint& point) const;
  /// At the acceleration set; J-dot v if that is zero.
  Eigen::Vector3d Acceleration(const ContactPoint& point) const;
  /// Writes 3 x nv, for example a block of a larger matrix.
  void Jacobian(const ContactPoint& point, Eigen::Ref<Eigen::MatrixXd> J) const;
  /// Derivatives of a point's velocity and acceleration (d velocity / d v and
  /// d acceleration / d a are the Jacobian).
  const PointDerivatives& DifferentiatePoint(const ContactPoint& point);
  /// Adds J' f of a force (world axes) at a point to `forces` (nv).
  void AddPointForce(const ContactPoint& point, const Eigen::Vector3d& force,
                     Eigen::Ref<Eigen::VectorXd> forces) const;
  /// Adds the derivative of J' f with respect to q, f held fixed, to `dq` (nv x nv).
  void AddPointForceDerivative(const ContactPoint& point, const Eigen::Vector3d& force,
                               Eigen::Ref<Eigen::MatrixXd> dq) const;

  /// Centre of mass and momentum about it, with their derivatives.
  const CentroidalQuantities& Centroidal();

  /// Second derivatives of lambda' InverseDynamics + the point terms, at the acceleration set.
  /// `lambda`: nv.
  const HessianProduct& Hessian(const Eigen::Ref<const Eigen::VectorXd>& lambda,
                                const std::vector<PointTerm>& terms = {});
  /// After Hessian at the same state: d(J lambda) / dq of a point, 3 x nv. Its rows are the second
  /// derivatives of lambda' J' f with respect to q and f.
  const Eigen::MatrixXd& DifferentiateVirtualVelocity(const ContactPoint& point);

  /// Kinematics of the tree: poses, Jacobians and centre of mass in the tree's own coordinates.
  const TreeKinematics& kinematics() const { return tree_.kinematics(); }

 private:
  void Check(const char* what, const Eigen::Ref<const Eigen::VectorXd>& x, int expected) const;
  void CheckPoint(const ContactPoint& point) const;
  void Reduce(const Eigen::MatrixXd& tree, Eigen::MatrixXd* reduced) const;
  void AddReduced(const Eigen::MatrixXd& tree, Eigen::Ref<Eigen::MatrixXd> reduced) const;

  std::shared_ptr<const MultibodyModel> model_;
  TreeDerivatives tree_;
  Eigen::VectorXd acceleration_;
  Eigen::VectorXd torque_limits_;
  // Only for models whose coordinates are not the tree's.
  Eigen::VectorXd forces_;
  Eigen::MatrixXd mass_matrix_;
  InverseDynamicsDerivatives derivatives_;
  PointDerivatives point_;
  CentroidalQuantities centroidal_;
  HessianProduct hessian_;
  Eigen::MatrixXd virtual_velocity_dq_;
};

}  // namespace possibility::dynamics
