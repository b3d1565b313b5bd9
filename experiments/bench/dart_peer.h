#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <vector>

#include "dynamics/tree/tree_kinematics.h"
#include "experiments/peers/dart_engine.h"
#include "models/robot/robot_model.h"

namespace possibility::experiments {

/// A robot in DART. All joints are independent: mimics are not coupled. Available only if DART is
/// installed (POSSIBILITY_WITH_DART is defined).
class DartPeer {
 public:
  explicit DartPeer(const models::RobotModel& robot)
      : engine_(Links(robot), dynamics::kGravity),
        forces_(robot.nv()),
        acceleration_(robot.nv()),
        mass_matrix_(robot.nv(), robot.nv()) {}

  /// `q`: nq, quaternion of length 1; `v`: nv. Sizes are not checked, here and below.
  void SetState(const Eigen::VectorXd& q, const Eigen::VectorXd& v) {
    engine_.SetState(q.data(), v.data());
  }
  /// M(q) a + c(q, v) + g(q); nv.
  const Eigen::VectorXd& InverseDynamics(const Eigen::VectorXd& a) {
    engine_.InverseDynamics(a.data(), forces_.data());
    return forces_;
  }
  /// Acceleration under generalised forces, which exclude gravity; nv.
  const Eigen::VectorXd& ForwardDynamics(const Eigen::VectorXd& forces) {
    engine_.ForwardDynamics(forces.data(), acceleration_.data());
    return acceleration_;
  }
  const Eigen::MatrixXd& MassMatrix() {  ///< nv x nv
    engine_.MassMatrix(mass_matrix_.data());
    return mass_matrix_;
  }

 private:
  static std::vector<PeerLink> Links(const models::RobotModel& robot) {
    std::vector<PeerLink> links(robot.links.size());
    for (int i = 0; i < robot.num_links(); ++i) {
      const models::Inertial& inertial = robot.links[i].inertial;
      links[i].mass = inertial.mass;
      std::copy_n(inertial.p_LC.data(), 3, links[i].p_LC.begin());
      std::copy_n(inertial.I_LC.data(), 9, links[i].I_LC.begin());
      if (i > 0) SetJoint(robot.joints[i - 1], &links[i]);
    }
    return links;
  }

  static void SetJoint(const models::Joint& joint, PeerLink* link) {
    const bool slides = joint.type == models::JointType::kPrismatic;
    link->parent = joint.parent;
    link->joint = slides ? PeerJoint::kPrismatic : PeerJoint::kRevolute;
    const Eigen::Matrix3d R = joint.X_PJ.linear();
    const Eigen::Vector3d p = joint.X_PJ.translation();
    std::copy_n(R.data(), 9, link->R_PJ.begin());
    std::copy_n(p.data(), 3, link->p_PJ.begin());
    std::copy_n(joint.axis.data(), 3, link->axis.begin());
  }

  DartEngine engine_;
  Eigen::VectorXd forces_, acceleration_;
  Eigen::MatrixXd mass_matrix_;
};

}  // namespace possibility::experiments
