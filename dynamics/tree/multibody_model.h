#pragma once

#include <Eigen/Core>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "models/robot/robot_model.h"

namespace possibility::dynamics {

enum class Base {
  kFloating,  ///< q: quaternion (w, x, y, z), position; v: angular, linear velocity, world axes
  kPlanar,    ///< q: pitch about +y, x, z; v: their rates
  kJoints     ///< q: x, y, z, yaw, roll, pitch of the joints that carry the root; v: their rates
};

/// One velocity of the tree as a multiple of one independent velocity.
struct CoupledVelocity {
  int independent = -1;  ///< index into v; -1: always zero
  double factor = 1;
};

/// The immutable part of a multibody system, shared by the workspaces of all threads: a tree of
/// links (models::RobotModel, with its own conventions of q and v), and the map from the
/// independent coordinates of this class to the tree's coordinates. Independent coordinates: base
/// first (Base), then the independent joints in the tree's order.
///
/// Generalised forces are dual to v. A tangent (nv) is a displacement of q: a rotation vector in
/// world axes and a translation for a floating base, differences otherwise.
class MultibodyModel {
 public:
  /// The robot in space: every joint is independent except mimic joints.
  static std::shared_ptr<const MultibodyModel> Spatial(const models::RobotModel& robot);
  /// A tree whose joints all stay in the plane y = 0 (parallel to y, or prismatic in it).
  static std::shared_ptr<const MultibodyModel> Planar(const models::RobotModel& tree);
  /// The robot in space, its root on joints, so that v is the rate of q. `locked`: positions (rad,
  /// m) of joints of `robot`, by index, that do not move. Links and joints of tree() are those of
  /// OnBaseJoints. @throws std::invalid_argument for a locked joint that does not exist, mimics
  /// another one or is not finite.
  static std::shared_ptr<const MultibodyModel> OnJoints(const models::RobotModel& robot,
                                                        const std::map<int, double>& locked = {});

  const models::RobotModel& tree() const { return tree_; }
  Base base() const { return base_; }
  int nq() const { return num_base_positions() + num_joints(); }
  int nv() const { return num_base_velocities() + num_joints(); }
  int num_base_positions() const { return base_ == Base::kFloating ? 7 : num_base_velocities(); }
  int num_base_velocities() const { return base_ == Base::kPlanar ? 3 : 6; }
  int num_joints() const { return static_cast<int>(joints_.size()); }  ///< independent ones
  /// By independent joint: index into tree().joints of the joint whose value it is.
  const std::vector<int>& joints() const { return joints_; }
  /// True if the tree velocities are the independent velocities, in the same order.
  bool is_identity() const { return is_identity_; }
  /// What the dynamics do not depend on: the velocities that translate the whole robot, by index
  /// into v, and their directions.
  struct Translation {
    int index = 0;
    Eigen::Vector3d direction;
  };
  const std::vector<Translation>& translations() const { return translations_; }
  /// Whether a velocity, by index into v, moves a link of the tree.
  bool Moves(int velocity, int link) const { return moves_[velocity][link]; }
  /// Whether it moves one of the links against the other.
  bool MovesApart(int velocity, int link, int other) const;
  /// Whether some link is moved by both velocities.
  bool AreRelated(int velocity, int other) const { return related_[velocity][other]; }

  /// By tree velocity (tree().nv() of them).
  const std::vector<CoupledVelocity>& couplings() const { return couplings_; }

  // Limits by independent joint; those of its mimic joints are included.
  const Eigen::VectorXd& lower() const { return lower_; }        ///< rad or m, may be -inf
  const Eigen::VectorXd& upper() const { return upper_; }        ///< rad or m, may be +inf
  const Eigen::VectorXd& velocity() const { return velocity_; }  ///< rad/s or m/s
  const Eigen::VectorXd& effort() const { return effort_; }      ///< N m or N, at rest
  /// Greatest torque in both directions at velocity `v` (nv), by independent joint: what their
  /// torque-speed lines leave of effort().
  Eigen::VectorXd TorqueLimits(const Eigen::Ref<const Eigen::VectorXd>& v) const;
  /// Of an independent joint, for a torque of this sign; N m or N.
  double TorqueLimit(int joint, double torque, const Eigen::Ref<const Eigen::VectorXd>& v) const {
    return actuator(joint).Limit(effort_[joint], torque, v[num_base_velocities() + joint]);
  }
  /// Whether some independent joint has a torque-speed line.
  bool has_lines() const { return has_lines_; }
  /// Of an independent joint.
  const models::Actuator& actuator(int joint) const {
    return tree_.joints[joints_[joint]].actuator;
  }

  /// Tree coordinates of independent ones. @throws std::invalid_argument for a wrong size.
  Eigen::VectorXd TreeConfiguration(const Eigen::Ref<const Eigen::VectorXd>& q) const;
  Eigen::VectorXd TreeVelocity(const Eigen::Ref<const Eigen::VectorXd>& v) const;
  /// Independent generalised forces from those of the tree (the transpose of TreeVelocity).
  Eigen::VectorXd IndependentForces(const Eigen::Ref<const Eigen::VectorXd>& tree_forces) const;

  /// Writes the derivative with respect to the independent velocities (rows x nv) of something
  /// whose derivative with respect to the tree's is `tree` (rows x tree().nv()).
  void ReduceColumns(const Eigen::MatrixXd& tree, Eigen::Ref<Eigen::MatrixXd> reduced) const;

  /// q displaced by a tangent (nv), with the quaternion normalised.
  Eigen::VectorXd Displaced(const Eigen::Ref<const Eigen::VectorXd>& q,
                            const Eigen::Ref<const Eigen::VectorXd>& tangent) const;
  /// dq/dt (nq) at configuration q and velocity v.
  Eigen::VectorXd ConfigurationRate(const Eigen::Ref<const Eigen::VectorXd>& q,
                                    const Eigen::Ref<const Eigen::VectorXd>& v) const;

 private:
  MultibodyModel(models::RobotModel tree, Base base, const std::map<int, double>& locked);
  void CoupleBase();
  void CoupleJoints(const std::map<int, double>& locked);
  void CombineLimits();
  void FindMovedLinks();
  bool MovesInTree(int tree_velocity, int link) const;

  models::RobotModel tree_;
  Base base_;
  std::vector<int> joints_;
  std::vector<CoupledVelocity> couplings_;
  Eigen::VectorXd offsets_;  ///< by tree joint: its value when the independent joint is at 0
  std::vector<Translation> translations_;
  std::vector<std::vector<bool>> carried_by_;       ///< by link and joint of the tree
  std::vector<std::vector<int>> sources_;           ///< by velocity: the tree's that it drives
  std::vector<std::vector<bool>> moves_, related_;  ///< by velocity and link, by two velocities
  bool is_identity_ = true;
  bool has_lines_ = false;
  Eigen::VectorXd lower_, upper_, velocity_, effort_;
};

}  // namespace possibility::dynamics
