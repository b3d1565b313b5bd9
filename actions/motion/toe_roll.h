#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "actions/motion/free_flight.h"
#include "actions/wholebody/motion_builder.h"
#include "dynamics/contact/contact_forces.h"
#include "dynamics/tree/multibody_dynamics.h"

namespace possibility::actions {

/// A robot that rolls over its toes in the plane y = 0, heels lifted. Its joints move as given. The
/// rotation of the whole robot about the line of the toes follows from the ground exerting no
/// moment about that line (Runge-Kutta, fourth order). One workspace per thread.
class ToeRoll {
 public:
  /// `toes`: bearing points, all on one line parallel to y.
  ToeRoll(std::shared_ptr<const dynamics::MultibodyModel> model,
          std::vector<dynamics::ContactPoint> toes, const MotionSettings& settings);

  /// From state (q, v), at which the toes rest on the ground. Knots at `intervals` equal steps.
  /// @throws MotionError if no forces in the cones and torques within the limits realise it.
  std::vector<Knot> Roll(const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                         const JointMotion& joints, double duration, int intervals);

 private:
  struct Turn {
    double pitch = 0;
    double rate = 0;
  };
  /// Of the root's pitch, rad/s^2: at which the ground exerts no moment about the line of the toes.
  double Acceleration(const Turn& turn, const Signal<Eigen::VectorXd>& joints);
  /// In the state of Acceleration: that moment (N m), if the root's pitch accelerates at `pitch`
  /// (rad/s^2) and the toes stay where they are.
  double Moment(double pitch);
  Turn Advance(const Turn& turn, double t, double step, const JointMotion& joints);
  /// Sets the state in which the toes are at their initial place.
  void Place(const Turn& turn, const Signal<Eigen::VectorXd>& joints);
  Knot KnotAt(const Turn& turn, double t, const JointMotion& joints);

  dynamics::MultibodyDynamics dynamics_;
  std::vector<dynamics::ContactPoint> toes_;
  MotionSettings settings_;
  Eigen::Vector3d anchor_ = Eigen::Vector3d::Zero();
  Eigen::VectorXd q_, v_, a_;
  Eigen::Vector3d reach_ = Eigen::Vector3d::Zero();  ///< m: of a toe from the root
  Eigen::Vector3d drift_ = Eigen::Vector3d::Zero();  ///< m/s^2: of a toe, with the root at rest
};

}  // namespace possibility::actions
