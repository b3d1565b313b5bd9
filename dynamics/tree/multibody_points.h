#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "dynamics/tree/contact_point.h"
#include "dynamics/tree/multibody_model.h"
#include "dynamics/tree/tree_hessian.h"
#include "dynamics/tree/tree_kinematics.h"

namespace possibility::dynamics {

/// Positions of a MultibodyModel's points with first and second derivatives, in independent
/// coordinates: what MultibodyDynamics says of them, without velocities, inertias and forces. One
/// workspace per thread; the model is shared. Derivatives with respect to q are with respect to a
/// tangent (MultibodyModel).
///
/// @throws std::invalid_argument as MultibodyDynamics does.
class MultibodyPoints {
 public:
  explicit MultibodyPoints(std::shared_ptr<const MultibodyModel> model);

  const MultibodyModel& model() const { return *model_; }

  /// `q`: nq. Call it before everything else.
  void SetPosition(const Eigen::Ref<const Eigen::VectorXd>& q);

  Eigen::Vector3d Position(const ContactPoint& point) const;
  /// 3 x nv. Valid until the next call.
  const Eigen::MatrixXd& Jacobian(const ContactPoint& point);
  /// Second derivatives of the sum of on_position' p, nv x nv, symmetric; the terms' other parts do
  /// not count. One sweep over the tree and one product per pair of a joint and its ancestor
  /// (docs/dynamics.md, "Second derivatives"). Valid until the next call.
  const Eigen::MatrixXd& Hessian(const std::vector<PointTerm>& terms);

 private:
  /// Weights at points, which do not turn with them: all that the second derivatives of their sum
  /// need, however many points there are.
  struct Pull {
    bool any = false;
    Eigen::Vector3d weight = Eigen::Vector3d::Zero();
    Eigen::Matrix3d virial = Eigen::Matrix3d::Zero();  ///< sum of weight times (p - root origin)'
  };

  void CheckPoint(int link, const Eigen::Vector3d& p_L) const;
  void CollectPulls(const std::vector<PointTerm>& terms);
  void AddJointPairs(int link);
  void AddRootPairs();
  /// For two velocities of the tree.
  void AddPair(int outer, int inner, double second);
  Eigen::Vector3d RootOrigin() const { return kinematics_.X_WL()[0].translation(); }
  const models::Joint& JointOf(int link) const { return model_->tree().joints[link - 1]; }

  std::shared_ptr<const MultibodyModel> model_;
  TreeKinematics kinematics_;
  std::vector<Pull> pulls_;  ///< by link; in a sweep, of the link and all links it carries
  Eigen::MatrixXd tree_jacobian_, jacobian_, hessian_;
};

}  // namespace possibility::dynamics
