#pragma once

#include <Eigen/Core>
#include <vector>

#include "dynamics/tree/spatial.h"
#include "dynamics/tree/spatial_body.h"
#include "dynamics/tree/tree_kinematics.h"

namespace possibility::dynamics {

/// One velocity coordinate of a tree: its motion and how that motion changes.
struct TreeAxis {
  SpatialVector S;          ///< motion per unit rate
  SpatialVector rate;       ///< psi-dot: v_parent x S
  SpatialVector rate_rate;  ///< psi-ddot: a_parent x S + v_parent x psi-dot
  SpatialVector twice;      ///< theta: psi-dot + S-dot
};

/// The motion of a floating-base tree in spatial vectors about the root's origin, world axes
/// (docs/dynamics.md), and the forces it takes: the sweep on which all derivatives stand. q, v, a,
/// generalised forces: TreeKinematics. One workspace per thread; the model must outlive it.
///
/// Sizes are checked: @throws std::invalid_argument.
class TreeMotion {
 public:
  explicit TreeMotion(const models::RobotModel& model);

  /// Poses and Jacobians at the last state's q.
  const TreeKinematics& kinematics() const { return kinematics_; }
  int num_links() const { return num_links_; }
  /// Of a link that is not the root.
  int parent(int link) const { return constants_[link].parent; }
  /// The velocity coordinate of a link's joint; the root's are 0 to 5.
  static int Coordinate(int link) { return 5 + link; }

  /// `q`: nq, `v`: nv, `a`: nv.
  void SetState(const Eigen::Ref<const Eigen::VectorXd>& q,
                const Eigen::Ref<const Eigen::VectorXd>& v,
                const Eigen::Ref<const Eigen::VectorXd>& a);
  /// Sets another acceleration at the same q and v.
  void SetAcceleration(const Eigen::Ref<const Eigen::VectorXd>& a);

  /// Generalised forces at the acceleration set, gravity included; nv.
  const Eigen::VectorXd& InverseDynamics() const { return forces_; }

  const SpatialBody& body(int link) const { return bodies_[link]; }
  /// The link and all links it carries; `force`: what their joint must bear.
  const SpatialBody& subtree(int link) const { return subtrees_[link]; }
  const TreeAxis& axis(int coordinate) const { return axes_[coordinate]; }
  const SpatialVector& velocity(int link) const { return v_[link]; }
  /// Counts gravity as an upward acceleration.
  const SpatialVector& acceleration(int link) const { return a_[link]; }
  /// Of the root's origin, m/s.
  const Eigen::Vector3d& origin_velocity() const { return origin_velocity_; }

  /// @throws std::invalid_argument that says `what` unless size is nv.
  void CheckSize(const char* what, Eigen::Index size) const;

 private:
  struct LinkConstants {
    int parent = -1;
    bool prismatic = false;
    double mass = 0;
    Eigen::Vector3d p_LC = Eigen::Vector3d::Zero();
    Eigen::Matrix3d I_LC = Eigen::Matrix3d::Zero();
  };

  void PlaceBody(int link, const Eigen::Vector3d& p_WO);
  void SumUpSubtrees();

  TreeKinematics kinematics_;
  int num_links_;
  std::vector<LinkConstants> constants_;
  std::vector<SpatialBody> bodies_, subtrees_;  // by link
  std::vector<SpatialVector> v_, a_;            // by link
  std::vector<TreeAxis> axes_;                  // by coordinate
  Eigen::VectorXd rates_;                       // v as given
  Eigen::Vector3d origin_velocity_ = Eigen::Vector3d::Zero();
  Eigen::VectorXd forces_;
};

}  // namespace possibility::dynamics
