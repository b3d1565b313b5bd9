#pragma once

#include <Eigen/Core>
#include <vector>

#include "dynamics/tree/point_derivatives.h"
#include "dynamics/tree/tree_motion.h"

namespace possibility::dynamics {

/// A scalar of one point of the robot:
///   on_position' p + on_velocity' p-dot + on_acceleration' p-ddot + force' (J lambda),
/// where lambda are the multipliers of inverse dynamics. If `force` is minus a contact force,
/// lambda' (ID - J' f) is differentiated.
struct PointTerm {
  int link = 0;
  Eigen::Vector3d p_L = Eigen::Vector3d::Zero();
  Eigen::Vector3d on_position = Eigen::Vector3d::Zero();
  Eigen::Vector3d on_velocity = Eigen::Vector3d::Zero();
  Eigen::Vector3d on_acceleration = Eigen::Vector3d::Zero();
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
};

/// Second derivatives of a scalar s(q, v, a), each nv x nv: rows by the first index, columns by
/// the second. qq is that of t -> s(q displaced by t) at t = 0, hence symmetric. s is linear in a,
/// and v and a do not mix: the blocks not named are zero.
struct HessianProduct {
  Eigen::MatrixXd qq;
  Eigen::MatrixXd qv;  ///< rows q, columns v
  Eigen::MatrixXd vv;
  Eigen::MatrixXd qa;  ///< rows q, columns a
};

/// Second derivatives of lambda' ID and of points (docs/dynamics.md, "Second derivatives"). A
/// workspace: one per thread.
class TreeHessian {
 public:
  explicit TreeHessian(const models::RobotModel& model);

  /// Second derivatives of lambda' InverseDynamics + the point terms at the motion's state;
  /// `lambda`: nv. Valid until the next call.
  /// @throws std::invalid_argument if `lambda` has another size.
  const HessianProduct& Compute(const TreeMotion& motion,
                                const Eigen::Ref<const Eigen::VectorXd>& lambda,
                                const std::vector<PointTerm>& terms);

  /// Derivative with respect to q of J lambda, the virtual velocity of a point under the
  /// multipliers of the last Compute, whose motion must not have changed; 3 x nv. Its product with
  /// a force is the derivative of lambda' J' f, so its rows are the second derivatives of lambda'
  /// ID
  /// - lambda' J' f with respect to q and minus f.
  void DifferentiateVirtualVelocity(int link, const Eigen::Vector3d& p_L,
                                    Eigen::MatrixXd* derivative) const;

 private:
  /// Counterpart of SpatialBody for the virtual velocity w, whose rates are the multipliers
  /// (Hessian).
  struct VirtualBody {
    SpatialVector momentum;                              ///< g: I w
    Eigen::Matrix3d coriolis = Eigen::Matrix3d::Zero();  ///< D of w in place of v
    Eigen::Vector3d turning = Eigen::Vector3d::Zero();   ///< k: angular part of B' w

    /// Gradient of y' K(., w).
    SpatialVector Turning(const Eigen::Vector3d& y) const {
      return {-Times(coriolis, y), Cross(momentum.linear, y)};
    }
  };

  /// Forces at points of one link, which do not turn with it: all that the second derivatives of
  /// their power need, however many points there are.
  struct LinkForces {
    bool any = false;
    SpatialVector wrench;                              ///< about the root's origin
    Eigen::Matrix3d virial = Eigen::Matrix3d::Zero();  ///< sum of force times position'

    /// Sum of f' (s x (t x p)).
    double Turned(const Eigen::Vector3d& s, const Eigen::Vector3d& t) const {
      return Dot(t, Times(virial, s)) - Dot(s, t) * virial.trace();
    }
    /// Sum of f' (s x the motion's velocity at p).
    double Turned(const Eigen::Vector3d& s, const SpatialVector& motion) const {
      return Dot(wrench.linear, Cross(s, motion.linear)) + Turned(s, motion.angular);
    }
  };

  void ClearDynamics();
  void AddDynamics(const Eigen::Ref<const Eigen::VectorXd>& lambda,
                   const std::vector<PointTerm>& terms);
  void FindVirtualMotion(const Eigen::Ref<const Eigen::VectorXd>& lambda);
  void AddJointHessian(int link);
  void AddRootHessian();
  void CollectForces(const std::vector<PointTerm>& terms);
  void AddForceHessian(int link);
  double ForcePair(int link, int outer, int inner) const;
  double RootForcePair(int link, int j, int k) const;
  void AddPointHessian(const PointTerm& term);
  void AddPointPair(const PointTerm& term, const PointMotion& point, int outer, int inner);
  void AddRootPointPair(const PointTerm& term, const PointMotion& point, int j, int k);

  const TreeMotion* motion_ = nullptr;        // during Compute
  std::vector<SpatialVector> w_;              // by link, virtual velocity
  std::vector<SpatialVector> virtual_rates_;  // by coordinate, chi: w_parent x S
  std::vector<VirtualBody> virtual_bodies_;   // by link
  std::vector<LinkForces> forces_;            // by link
  HessianProduct hessian_;
};

}  // namespace possibility::dynamics
