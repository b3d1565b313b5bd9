#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "actions/motion/nominal_stance.h"
#include "dynamics/sagittal/sagittal_reduction.h"
#include "dynamics/tree/contact_point.h"
#include "models/robot/robot_model.h"
#include "models/world/collision.h"

namespace possibility::actions {

/// Everything about the standing long jump of one robot that does not depend on the jump: the
/// robot in its sagittal plane, and the two stances that a jump leads from and to. Joints that
/// cannot stay in the plane are locked as the landing stance has them.
///
/// Planar configurations (pitch, x, z, joints) are relative to the frame of their own stance: on
/// the ground, below the root.
class SagittalModel {
 public:
  /// @throws InputError if the robot is not symmetric, the gaits' postures are not, or the landing
  /// does not bear on the patches that the launch bears on.
  SagittalModel(const models::RobotModel& robot, const NominalStance& launch,
                const NominalStance& landing);

  const dynamics::SagittalReduction& reduction() const { return reduction_; }
  const std::shared_ptr<const dynamics::MultibodyModel>& planar() const {
    return reduction_.model();
  }

  /// The launch stance, all joints that no limb moves already where the landing has them.
  const Eigen::VectorXd& ready() const { return ready_; }
  /// The landing stance.
  const Eigen::VectorXd& landed() const { return landed_; }

  const dynamics::ContactPoint& heel() const { return heel_; }
  const dynamics::ContactPoint& toe() const { return toe_; }
  /// What lands besides the feet, a point per patch.
  const std::vector<dynamics::ContactPoint>& hands() const { return hands_; }
  /// By hand: the rounded end of its peg, which touches the ground wherever the peg leans; of
  /// radius 0 if the end is not round.
  struct Ball {
    dynamics::ContactPoint centre;
    double radius = 0;  ///< m
  };
  const std::vector<Ball>& peg_ends() const { return peg_ends_; }
  /// A chain of links from the trunk to a point.
  struct Limb {
    dynamics::ContactPoint root;  ///< its first joint
    dynamics::ContactPoint tip;
    double length = 0;  ///< m, stretched out
  };
  const Limb& leg() const { return leg_; }                 ///< to the ankle
  const std::vector<Limb>& arms() const { return arms_; }  ///< by hand
  /// Two points of the body that have to stay apart.
  struct Separation {
    dynamics::ContactPoint a, b;
    double distance = 0;  ///< m, at least
  };
  /// Between the trunk and the feet.
  const std::vector<Separation>& separations() const { return separations_; }

  /// Limits of the planar joints within which no link runs into another one of its own limb or
  /// the trunk, the other joints as in either stance; within their position limits, rad or m.
  const Eigen::VectorXd& lower() const { return lower_; }
  const Eigen::VectorXd& upper() const { return upper_; }
  /// Points of the body that have to stay above the ground, by the radius of what is around them:
  /// joints in their housings, and corners of the trunk.
  struct Guard {
    dynamics::ContactPoint point;
    double radius = 0;  ///< m
  };
  const std::vector<Guard>& guards() const { return guards_; }
  /// Half-way along the arms' links, for grounds with an edge that fits between the guards.
  const std::vector<Guard>& middle_guards() const { return middle_guards_; }

  /// x and z of a point of the plane at planar q.
  Eigen::Vector2d Position(const dynamics::ContactPoint& point, const Eigen::VectorXd& q) const;

 private:
  void FindContacts(const models::RobotModel& robot, const models::Gait& launch,
                    const models::Gait& landing);
  Ball PegEnd(const dynamics::ContactPoint& hand) const;
  Limb LimbTo(const dynamics::ContactPoint& tip) const;
  void FindGuards();
  void FindSeparations();
  void FindFreeRanges(const models::RobotModel& robot);
  double FreeLimit(const models::CollisionChecker& checker, const Eigen::VectorXd& q, int joint,
                   double limit) const;

  dynamics::SagittalReduction reduction_;
  Eigen::VectorXd ready_;
  Eigen::VectorXd landed_;
  dynamics::ContactPoint heel_;
  dynamics::ContactPoint toe_;
  std::vector<dynamics::ContactPoint> hands_;
  std::vector<Ball> peg_ends_;
  Limb leg_;
  std::vector<Limb> arms_;
  std::vector<Guard> guards_;
  std::vector<Guard> middle_guards_;
  std::vector<Separation> separations_;
  Eigen::VectorXd lower_, upper_;
};

}  // namespace possibility::actions
