#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "actions/plan/plan.h"
#include "dynamics/tree/tree_kinematics.h"
#include "models/robot/robot_model.h"

namespace possibility::actions {

/// What an inertial sensor at the root says about its departure from the plan.
struct RootTilt {
  Eigen::Vector3d tilt = Eigen::Vector3d::Zero();  ///< rotation vector from the plan, world, rad
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();  ///< its rate, rad/s
};

/// Changes of joint positions and velocities, num_joints.
struct JointCorrection {
  Eigen::VectorXd position;
  Eigen::VectorXd velocity;
};

/// Balance of a robot that walks on two feet: a foot in swing comes down flat, and where it catches
/// a robot that tips. Feet are moved by the error of the instantaneous capture point (Pratt et al.
/// 2006), which follows from the tilt, because stiff joints turn every error into tipping. After
/// landing, a foot's displacement dies out as fast as a captured pendulum comes to rest. Feet stay
/// apart. Does nothing while more or fewer than two limbs that hold their orientation walk.
class StepFeedback {
 public:
  /// `robot` must outlive this.
  StepFeedback(const Segment& segment, const models::RobotModel& robot);

  /// Times at which Sense is to be called, s, ascending; each foot's several times a swing.
  const std::vector<double>& ticks() const { return ticks_; }

  /// Directs the foot that swings at tick `t`. `q_landing`: configuration of the tree at
  /// LandingAfter(t), nq, as planned. `normal`: of the ground.
  void Sense(double t, const RootTilt& root, const Eigen::VectorXd& q_landing,
             const Eigen::Vector3d& normal);
  /// When the foot that swings at tick `t` is planned to land, s.
  double LandingAfter(double t) const;

  /// Whether a foot is displaced.
  bool IsCorrecting() const;
  /// Corrections of the joints at `t`. `q`: configuration of the tree, nq, as planned. None if no
  /// foot is displaced.
  std::optional<JointCorrection> CorrectionAt(double t, const Eigen::VectorXd& q) const;

 private:
  using Vector6d = Eigen::Matrix<double, 6, 1>;

  struct Swing {
    int foot = 0;
    double lift = 0;  ///< s
    double land = 0;  ///< s
  };

  /// Displacement of a foot from the plan, seen from the root: rotation, translation; world axes.
  struct Foot {
    const models::GaitLimb* limb = nullptr;
    double begin = 0, land = 0;  ///< s: `from` at `begin`, `to` at `land`, and then dies out
    Vector6d from = Vector6d::Zero();
    Vector6d to = Vector6d::Zero();
    double rate = 0;  ///< 1/s, at which it dies out

    bool IsMoved() const { return !from.isZero() || !to.isZero(); }
    Vector6d At(double t) const;
  };

  const Swing& SwingAt(double t) const;
  Eigen::Vector3d PlaceOf(int foot) const;

  const models::RobotModel* robot_;
  mutable dynamics::TreeKinematics kinematics_;
  mutable Eigen::MatrixXd jacobian_;
  std::vector<Foot> feet_;
  std::vector<Swing> swings_;
  std::vector<double> ticks_;
};

}  // namespace possibility::actions
