#pragma once

#include <Eigen/Core>
#include <vector>

#include "dynamics/tree/spatial.h"
#include "dynamics/tree/tree_kinematics.h"

namespace possibility::dynamics {

/// First derivatives of inverse dynamics tau = M(q) a + c(q, v) + g(q), each nv x nv.
struct InverseDynamicsDerivatives {
  Eigen::VectorXd forces;  ///< tau itself, nv
  Eigen::MatrixXd dq;      ///< with respect to a tangent of q
  Eigen::MatrixXd dv;
  Eigen::MatrixXd da;  ///< the mass matrix
};

/// First derivatives of a point's velocity and acceleration, each 3 x nv, world axes. The
/// acceleration is J a + J-dot v: its derivatives at a = 0 are those of the bias.
struct PointDerivatives {
  Eigen::MatrixXd jacobian;         ///< d position / dq, d velocity / dv, d acceleration / da
  Eigen::MatrixXd velocity_dq;      ///< d velocity / dq
  Eigen::MatrixXd acceleration_dq;  ///< d acceleration / dq
  Eigen::MatrixXd acceleration_dv;  ///< d acceleration / dv
};

/// The centre of mass and the momentum about it (rows 0-2 angular, 3-5 linear), world axes.
struct CentroidalQuantities {
  Eigen::Vector3d position;     ///< m
  Eigen::MatrixXd jacobian;     ///< d position / dq, 3 x nv
  Eigen::VectorXd momentum;     ///< 6: kg m^2/s, kg m/s
  Eigen::MatrixXd momentum_dq;  ///< 6 x nv
  Eigen::MatrixXd momentum_dv;  ///< 6 x nv, the centroidal momentum matrix
};

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

/// Inverse dynamics of a floating-base tree with exact first and second derivatives: two sweeps
/// over the tree and one product per pair of a joint and its ancestor (docs/dynamics.md). q, v, a,
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
  const TreeKinematics& kinematics() const { return kinematics_; }

  /// `q`: nq, `v`: nv, `a`: nv.
  void SetState(const Eigen::Ref<const Eigen::VectorXd>& q,
                const Eigen::Ref<const Eigen::VectorXd>& v,
                const Eigen::Ref<const Eigen::VectorXd>& a);
  /// Sets another acceleration at the same q and v.
  void SetAcceleration(const Eigen::Ref<const Eigen::VectorXd>& a);

  /// Generalised forces at the acceleration set, gravity included; nv.
  const Eigen::VectorXd& InverseDynamics() const { return forces_; }
  const Eigen::MatrixXd& MassMatrix();  ///< nv x nv
  const InverseDynamicsDerivatives& Differentiate();

  Eigen::Vector3d Position(int link, const Eigen::Vector3d& p_L) const;
  Eigen::Vector3d Velocity(int link, const Eigen::Vector3d& p_L) const;
  Eigen::Vector3d Acceleration(int link, const Eigen::Vector3d& p_L) const;
  const PointDerivatives& DifferentiatePoint(int link, const Eigen::Vector3d& p_L);
  /// Adds the derivative of J' f with respect to q, f (world axes) held fixed, to `dq`: nv x nv.
  void AddPointForceDerivative(int link, const Eigen::Vector3d& p_L, const Eigen::Vector3d& f,
                               Eigen::Ref<Eigen::MatrixXd> dq) const;

  const CentroidalQuantities& Centroidal();

  /// Second derivatives of lambda' InverseDynamics + the point terms; `lambda`: nv.
  const HessianProduct& Hessian(const Eigen::Ref<const Eigen::VectorXd>& lambda,
                                const std::vector<PointTerm>& terms);

 private:
  /// A link, or the links of a subtree together. Spatial vectors about the root's origin, world
  /// axes, in the frame that moves with that origin (no derivative depends on its motion).
  struct Body {
    double mass = 0;
    Eigen::Vector3d moment = Eigen::Vector3d::Zero();    ///< mass * com
    Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();   ///< rotational, about the origin
    Eigen::Vector3d momentum = Eigen::Vector3d::Zero();  ///< linear
    Eigen::Matrix3d coriolis = Eigen::Matrix3d::Zero();  ///< D of docs/dynamics.md
    SpatialVector force;

    /// I x.
    SpatialVector Inertia(const SpatialVector& x) const {
      return {Times(inertia, x.angular) + Cross(moment, x.linear),
              mass * x.linear - Cross(moment, x.angular)};
    }
    /// B x.
    SpatialVector Coriolis(const SpatialVector& x) const {
      return {Times(coriolis, x.angular), Cross(x.angular, momentum)};
    }
    /// Angular part of B' x; the linear part is zero.
    Eigen::Vector3d CoriolisTransposed(const SpatialVector& x) const {
      return TransposedTimes(coriolis, x.angular) + Cross(momentum, x.linear);
    }
    /// Its moment is the axial vector of D.
    SpatialVector Momentum() const {
      return {{coriolis(1, 2) - coriolis(2, 1), coriolis(2, 0) - coriolis(0, 2),
               coriolis(0, 1) - coriolis(1, 0)},
              momentum};
    }
  };
  struct LinkConstants {
    int parent = -1;
    bool prismatic = false;
    double mass = 0;
    Eigen::Vector3d p_LC = Eigen::Vector3d::Zero();
    Eigen::Matrix3d I_LC = Eigen::Matrix3d::Zero();
  };
  /// Data of one velocity coordinate: its motion and how that motion changes.
  struct Axis {
    SpatialVector S;             ///< motion per unit rate
    SpatialVector rate;          ///< psi-dot: v_parent x S
    SpatialVector rate_rate;     ///< psi-ddot: a_parent x S + v_parent x psi-dot
    SpatialVector twice;         ///< theta: psi-dot + S-dot
    SpatialVector virtual_rate;  ///< chi: w_parent x S (Hessian)
  };
  /// Counterpart of Body for the virtual velocity w, whose rates are the multipliers (Hessian).
  struct VirtualBody {
    SpatialVector momentum;                              ///< g: I w
    Eigen::Matrix3d coriolis = Eigen::Matrix3d::Zero();  ///< D of w in place of v
    Eigen::Vector3d turning = Eigen::Vector3d::Zero();   ///< k: angular part of B' w

    /// Gradient of y' K(., w).
    SpatialVector Turning(const Eigen::Vector3d& y) const {
      return {-Times(coriolis, y), Cross(momentum.linear, y)};
    }
  };
  struct PointMotion {
    int link;
    Eigen::Vector3d p, velocity, acceleration;
  };

  static int Coordinate(int link) { return 5 + link; }
  void CheckSize(const char* what, Eigen::Index size) const;
  void PlaceBody(int link, const Eigen::Vector3d& p_WO);
  void SumUpSubtrees();
  void FindVirtualMotion(const Eigen::Ref<const Eigen::VectorXd>& lambda);
  PointMotion MotionOf(int link, const Eigen::Vector3d& p_L) const;
  Eigen::Vector3d VelocityDerivative(const PointMotion& point, int coordinate) const;
  Eigen::Vector3d AccelerationDerivative(const PointMotion& point, int coordinate) const;
  void DifferentiateRoot();
  void DifferentiateJoint(int link);
  void AddJointHessian(int link);
  void AddRootHessian();
  void AddPointHessian(const PointTerm& term);
  void AddPointPair(const PointTerm& term, const PointMotion& point,
                    const Eigen::Vector3d& virtual_velocity, int outer, int inner);
  void AddRootPointPair(const PointTerm& term, const PointMotion& point,
                        const Eigen::Vector3d& virtual_velocity, int j, int k);

  TreeKinematics kinematics_;
  int num_links_;
  std::vector<LinkConstants> constants_;
  std::vector<Body> bodies_;          ///< by link
  std::vector<Body> subtrees_;        ///< by link: the link and all links it carries
  std::vector<SpatialVector> v_, a_;  ///< by link; a counts gravity as an upward acceleration
  std::vector<SpatialVector> w_;      ///< by link, virtual velocity
  std::vector<Axis> axes_;            ///< by coordinate
  std::vector<VirtualBody> virtual_bodies_;
  Eigen::VectorXd rates_;  ///< v as given
  Eigen::Vector3d origin_velocity_ = Eigen::Vector3d::Zero();
  Eigen::VectorXd forces_;
  Eigen::MatrixXd mass_matrix_;
  InverseDynamicsDerivatives derivatives_;
  PointDerivatives point_;
  CentroidalQuantities centroidal_;
  HessianProduct hessian_;
};

}  // namespace possibility::dynamics
