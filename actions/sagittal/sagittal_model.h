#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "actions/sagittal/natural_units.h"
#include "actions/wholebody/nominal_stance.h"
#include "actions/wholebody/self_clearance.h"
#include "dynamics/sagittal/sagittal_reduction.h"
#include "dynamics/tree/contact_point.h"
#include "models/robot/robot_model.h"

namespace possibility::actions {

/// The part of a robot's standing long jump that does not depend on the jump: the robot in its
/// sagittal plane, and the launch and landing stances. Joints that cannot stay in the plane are
/// locked at their positions in the landing stance.
///
/// Planar configurations (pitch, x, z, joints) are relative to the frame of their own stance: on
/// the ground, below the root.
class SagittalModel {
 public:
  /// @throws InputError if the robot or the gaits' postures are not symmetric, or if the landing
  /// does not bear on all patches of the launch.
  SagittalModel(const models::RobotModel& robot, const NominalStance& launch,
                const NominalStance& landing);

  const dynamics::SagittalReduction& reduction() const { return reduction_; }
  const std::shared_ptr<const dynamics::MultibodyModel>& planar() const {
    return reduction_.model();
  }

  /// The launch stance, with the joints outside the limbs already at their landing positions.
  const Eigen::VectorXd& ready() const { return ready_; }
  /// The landing stance.
  const Eigen::VectorXd& landed() const { return landed_; }

  const dynamics::ContactPoint& heel() const { return heel_; }
  const dynamics::ContactPoint& toe() const { return toe_; }
  /// Contact points that land besides the feet, one per patch.
  const std::vector<dynamics::ContactPoint>& hands() const { return hands_; }
  /// By hand: the rounded end of its peg, which touches the ground at any tilt of the peg. Radius 0
  /// if the end is not round.
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
  const Limb& leg() const { return leg_; }  ///< to the ankle
  NaturalUnits units() const {
    return {planar()->tree().TotalMass() * dynamics::kGravity, leg_.length};
  }
  const std::vector<Limb>& arms() const { return arms_; }  ///< by hand
  /// Two points of the body that must stay apart.
  struct Separation {
    dynamics::ContactPoint a, b;
    double distance = 0;  ///< m, least allowed
  };
  /// Between the trunk and the feet.
  const std::vector<Separation>& separations() const { return separations_; }

  /// Limits of the planar joints within which links keep kSelfClearance from their own limb and the
  /// trunk, with the other joints as in either stance. Within the position limits, rad or m.
  const Eigen::VectorXd& lower() const { return lower_; }
  const Eigen::VectorXd& upper() const { return upper_; }
  /// Points of the body that must stay above the ground by the radius of their surroundings: joints
  /// in their housings, corners of the trunk and of the ends of limbs that do not bear.
  struct Guard {
    dynamics::ContactPoint point;
    double radius = 0;  ///< m
  };
  const std::vector<Guard>& guards() const { return guards_; }
  /// Guards half-way along the arms' links, for grounds with an edge that fits between the other
  /// guards.
  const std::vector<Guard>& middle_guards() const { return middle_guards_; }

  /// x and z of a point in the plane at planar q.
  Eigen::Vector2d Position(const dynamics::ContactPoint& point, const Eigen::VectorXd& q) const;

 private:
  void FindContacts(const models::RobotModel& robot, const models::Gait& launch,
                    const models::Gait& landing);
  Ball PegEnd(const dynamics::ContactPoint& hand) const;
  Limb LimbTo(const dynamics::ContactPoint& tip) const;
  void FindGuards();
  void FindSeparations();
  void FindFreeRanges(const models::RobotModel& robot);
  double FreeLimit(const SelfClearance& clearance, const Eigen::VectorXd& q, int joint,
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
