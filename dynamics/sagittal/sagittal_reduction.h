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

/// What of generalised forces no symmetric motion in the plane y = 0 is driven by. All of it is
/// zero for a robot whose halves are mirror images; published masses may differ a little.
struct OutOfPlaneForces {
  double force_y = 0;   ///< N, on the root
  double moment_x = 0;  ///< N m, on the root about its origin
  double moment_z = 0;  ///< N m
  /// N m or N: the greatest difference between the two joints of a pair, mirrored.
  double pair_difference = 0;
};

/// A symmetric robot that moves symmetrically in the plane y = 0 is exactly a planar tree: joints
/// parallel to y stay, every other one is locked, and what moves alike is one link. Built from a
/// RobotModel and its sagittal pairs; maps states, forces and contact points both ways.
///
/// "Full" quantities follow models::RobotModel with an entry for every joint, planar ones Base::
/// kPlanar of MultibodyModel. A lumped joint has the left one's name, sign and place. Immutable.
class SagittalReduction {
 public:
  /// `locked`: positions (num_joints) of the joints that are locked; those of the others are not
  /// looked at. Absent: all zero.
  /// @throws InputError naming the joints or contacts that are no mirror images of each other, or
  /// that cannot stay in the plane; std::invalid_argument if `locked` has a wrong size or is not
  /// finite.
  explicit SagittalReduction(const models::RobotModel& robot,
                             const std::optional<Eigen::VectorXd>& locked = std::nullopt);

  const models::RobotModel& full() const { return full_; }
  /// The lumped tree is model()->tree(): at the zero configuration all its frames are parallel to
  /// the world's. It has no gaits, no transitions and no pairs.
  const std::shared_ptr<const MultibodyModel>& model() const { return model_; }

  /// By joint of the lumped tree: those of the full robot that it stands for.
  const std::vector<SagittalJoint>& joints() const { return lumping_.joints; }
  /// By link of the full robot: the link of the lumped tree that it is part of.
  const std::vector<int>& lumped_link() const { return lumping_.lumped_link; }

  /// Full q of a planar one. @throws std::invalid_argument for a wrong size or what is not finite,
  /// as all maps do.
  Eigen::VectorXd ExpandConfiguration(const Eigen::Ref<const Eigen::VectorXd>& q) const;
  /// Full v or a of a planar one: a constant linear map E.
  Eigen::VectorXd ExpandVelocity(const Eigen::Ref<const Eigen::VectorXd>& v) const;
  /// @throws std::invalid_argument naming what is off if `full_q` is not within `tolerance` (rad,
  /// m) of a configuration that ExpandConfiguration returns. Pitch lies in [-pi, pi].
  Eigen::VectorXd ReduceConfiguration(const Eigen::Ref<const Eigen::VectorXd>& full_q,
                                      double tolerance = 1e-9) const;
  /// The same of v or a.
  Eigen::VectorXd ReduceVelocity(const Eigen::Ref<const Eigen::VectorXd>& full_v,
                                 double tolerance = 1e-9) const;
  /// E' tau.
  Eigen::VectorXd ReduceForces(const Eigen::Ref<const Eigen::VectorXd>& full_forces) const;
  /// Full forces with E' of them equal to the planar ones: the joints of a pair share in
  /// proportion to their effort limits, so that both reach them together.
  Eigen::VectorXd ExpandForces(const Eigen::Ref<const Eigen::VectorXd>& forces) const;
  /// Of full generalised forces, for example inverse dynamics minus J'f at a symmetric state.
  OutOfPlaneForces OutOfPlane(const Eigen::Ref<const Eigen::VectorXd>& full_forces) const;

  /// Where a point of the full robot is on the lumped tree, in the plane.
  ContactPoint LumpedPoint(const ContactPoint& full_point) const;
  /// The contact points of the full robot that a contact point of the lumped tree stands for:
  /// model()->tree().contacts[contact].points[point]. @throws std::out_of_range if there is none.
  const std::vector<ContactPoint>& FullPoints(int contact, int point) const;
  /// A planar force at such a point, split evenly over FullPoints; 3 x points.
  Eigen::Matrix3Xd ExpandContactForce(int contact, int point, const Eigen::Vector3d& force) const;

 private:
  models::RobotModel full_;
  SagittalLumping lumping_;
  std::vector<double> left_shares_;  // by lumped joint: of a force
  std::shared_ptr<const MultibodyModel> model_;
};

}  // namespace possibility::dynamics
