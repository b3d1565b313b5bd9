#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "dynamics/sagittal/sagittal_lumping.h"
#include "dynamics/tree/contact_point.h"
#include "dynamics/tree/multibody_model.h"
#include "models/robot/robot_model.h"

namespace possibility::dynamics {

/// The parts of generalised forces that drive no symmetric motion in the plane y = 0. They are zero
/// for a robot whose halves are mirror images; published masses may differ a little.
struct OutOfPlaneForces {
  double force_y = 0;   ///< N, on the root
  double moment_x = 0;  ///< N m, on the root about its origin
  double moment_z = 0;  ///< N m
  /// N m or N: greatest difference between the two joints of a pair, after mirroring.
  double pair_difference = 0;
};

/// A symmetric robot that moves symmetrically in the plane y = 0 is exactly a planar tree: joints
/// parallel to y remain, every other joint is locked, and links that move alike become one link.
/// Built from a RobotModel and its sagittal pairs. Maps states, forces and contact points both
/// ways.
///
/// "Full" quantities follow models::RobotModel with an entry for every joint; planar ones follow
/// Base::kPlanar of MultibodyModel. A lumped joint has the left joint's name, sign and place.
/// Immutable.
class SagittalReduction {
 public:
  /// `locked`: positions (num_joints) of the joints that are locked; the entries of all other
  /// joints are ignored. Absent: all zero.
  /// @throws InputError naming the joints or contacts that are not mirror images of each other or
  /// cannot stay in the plane; std::invalid_argument if `locked` has a wrong size or is not finite.
  explicit SagittalReduction(const models::RobotModel& robot,
                             const std::optional<Eigen::VectorXd>& locked = std::nullopt);

  const models::RobotModel& full() const { return full_; }
  /// The lumped tree is model()->tree(): at the zero configuration all its frames are parallel to
  /// the world's. It has no gaits, no transitions and no pairs.
  const std::shared_ptr<const MultibodyModel>& model() const { return model_; }

  /// By joint of the lumped tree: the joints of the full robot that it represents.
  const std::vector<SagittalJoint>& joints() const { return lumping_.joints; }
  /// By link of the full robot: the link of the lumped tree that contains it.
  const std::vector<int>& lumped_link() const { return lumping_.lumped_link; }
  /// By link of the full robot: its pose in that link.
  const std::vector<Eigen::Isometry3d>& X_GL() const { return lumping_.X_GL; }

  /// Full q of a planar q. @throws std::invalid_argument for a wrong size or a value that is not
  /// finite, like all maps here.
  Eigen::VectorXd ExpandConfiguration(const Eigen::Ref<const Eigen::VectorXd>& q) const;
  /// Full v or a of a planar one: a constant linear map E.
  Eigen::VectorXd ExpandVelocity(const Eigen::Ref<const Eigen::VectorXd>& v) const;
  /// Planar q of a full q; pitch lies in [-pi, pi].
  /// @throws std::invalid_argument naming the worst entry if `full_q` is not within `tolerance`
  /// (rad, m) of a configuration that ExpandConfiguration returns.
  Eigen::VectorXd ReduceConfiguration(const Eigen::Ref<const Eigen::VectorXd>& full_q,
                                      double tolerance = 1e-9) const;
  /// The same for v or a.
  Eigen::VectorXd ReduceVelocity(const Eigen::Ref<const Eigen::VectorXd>& full_v,
                                 double tolerance = 1e-9) const;
  /// E' tau.
  Eigen::VectorXd ReduceForces(const Eigen::Ref<const Eigen::VectorXd>& full_forces) const;
  /// Full forces f with E' f equal to the planar forces. The joints of a pair share in proportion
  /// to their effort limits, so that both reach them together.
  Eigen::VectorXd ExpandForces(const Eigen::Ref<const Eigen::VectorXd>& forces) const;
  /// Out-of-plane part of full generalised forces, for example inverse dynamics minus J'f at a
  /// symmetric state.
  OutOfPlaneForces OutOfPlane(const Eigen::Ref<const Eigen::VectorXd>& full_forces) const;

  /// The point of the lumped tree, in the plane, that represents a point of the full robot.
  ContactPoint LumpedPoint(const ContactPoint& full_point) const;
  /// The contact points of the full robot that are represented by
  /// model()->tree().contacts[contact].points[point]. @throws std::out_of_range if there is none.
  const std::vector<ContactPoint>& FullPoints(int contact, int point) const;
  /// Splits a planar force at such a point evenly over FullPoints; 3 x points.
  Eigen::Matrix3Xd ExpandContactForce(int contact, int point, const Eigen::Vector3d& force) const;

 private:
  models::RobotModel full_;
  SagittalLumping lumping_;
  std::vector<double> left_shares_;  // by lumped joint: the left joint's share of a force
  std::shared_ptr<const MultibodyModel> model_;
};

}  // namespace possibility::dynamics
