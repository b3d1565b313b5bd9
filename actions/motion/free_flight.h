#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <vector>

#include "actions/plan/plan.h"
#include "actions/wholebody/signal.h"
#include "dynamics/tree/multibody_dynamics.h"
#include "dynamics/tree/tree_kinematics.h"

namespace possibility::actions {

/// All joints over time, num_joints each.
using JointMotion = std::function<Signal<Eigen::VectorXd>(double t)>;

/// A robot in flight: its joints move as given, and the motion of its root follows from momentum
/// conservation. The centre of mass follows its parabola exactly and the angular momentum about it
/// is constant; only the root's orientation is integrated (Runge-Kutta, fourth order). One
/// workspace per thread.
class FreeFlight {
 public:
  explicit FreeFlight(std::shared_ptr<const dynamics::MultibodyModel> model);

  /// Take-off at time 0. `q`, `v`: state of the robot; its joints must agree with the motion.
  void TakeOff(const Eigen::VectorXd& q, const Eigen::VectorXd& v);

  /// Knots at `intervals` equal steps from 0 to `duration`; the first is the take-off. tau comes
  /// from inverse dynamics.
  std::vector<Knot> Fly(const JointMotion& joints, double duration, int intervals);
  /// The last of these knots only.
  Knot Land(const JointMotion& joints, double duration, int intervals);

 private:
  /// What the joints alone decide about the rotation: inertia and, with the root at rest, angular
  /// momentum, both about the centre of mass, root axes.
  struct JointsShare {
    Eigen::Matrix3d inertia;
    Eigen::Vector3d momentum;
  };

  /// Calls `visit` at the ends of all steps, the take-off first.
  void Integrate(const JointMotion& joints, double duration, int intervals,
                 const std::function<void(const Eigen::Quaterniond& R, double t)>& visit);
  Eigen::Quaterniond Advance(const Eigen::Quaterniond& R, double step, const JointsShare& begin,
                             const JointsShare& middle, const JointsShare& end) const;
  JointsShare ShareOf(const Signal<Eigen::VectorXd>& joints);
  Eigen::Vector3d AngularVelocity(const Eigen::Quaterniond& R, const JointsShare& share) const;
  Knot KnotAt(const Eigen::Quaterniond& R, double t, const JointMotion& joints);

  dynamics::MultibodyDynamics dynamics_;
  dynamics::TreeKinematics kinematics_;
  Eigen::Quaterniond orientation_ = Eigen::Quaterniond::Identity();  ///< at take-off
  Eigen::Vector3d position_ = Eigen::Vector3d::Zero();               ///< com at take-off, m
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();               ///< of the com, m/s
  Eigen::Vector3d momentum_ = Eigen::Vector3d::Zero();               ///< angular, kg m^2/s
  double mass_ = 0;
};

}  // namespace possibility::actions
