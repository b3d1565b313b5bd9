#pragma once

#include <Eigen/Core>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "dynamics/forward/forward_dynamics.h"
#include "dynamics/rollout/hybrid_rollout.h"
#include "dynamics/rollout/joint_control.h"

namespace possibility::dynamics {

/// A point of the robot and the plane that it may touch: normal' p = offset on the ground.
struct RolloutContact {
  std::string name;
  ContactPoint point;  ///< its normal_W is the plane's
  double offset = 0;   ///< m
  double friction = 0.7;
  /// For walkers without knees, whose swing foot passes through the ground: whether the contact
  /// lands at configuration q. Asked when it comes down to its plane and, if it is held, when
  /// another contact lands: no means that it goes through, or leaves. None: it always lands.
  std::function<bool(const Eigen::VectorXd& q)> lands;
};

struct RobotRolloutSettings {
  RobotRolloutSettings();

  HybridSettings hybrid;  ///< default: BDF, tolerances 1e-8, steps of 0.02 s at most
  ForwardDynamicsSettings dynamics;
  /// m: a point this near to its plane touches it; deeper at the start is an error.
  double touching = 1e-6;
  /// m/s: points that would leave the ground more slowly than this after an impact stay. It ends
  /// the endless sequence of ever smaller impacts of a rocking foot.
  double rest_speed = 1e-3;
  /// True: a patch whose resultant leaves its friction cone ends the rollout
  /// (RobotRolloutEnd::kSlip). False: it sticks, and the utilisation is reported.
  bool ends_at_slip = false;
  /// J: the rollout ends (kAtRest) when the kinetic energy has been below this for rest_time; 0:
  /// never.
  double rest_energy = 0;
  double rest_time = 0.1;  ///< s
};

enum class RobotRolloutEnd { kTime, kAtRest, kSlip, kStopped, kZeno };

/// A touchdown, a release, or both; the first may be at the start: what stands on the ground
/// there. Indices are of contacts.
struct RobotContactEvent {
  double time = 0;                  ///< s
  std::vector<int> touched;         ///< came down
  std::vector<int> released;        ///< were held before, and no longer are
  std::vector<int> held;            ///< from now on
  std::vector<int> jammed;          ///< of those: friction alone keeps them (BearingPoints)
  Eigen::VectorXd v_before;         ///< nv
  Eigen::VectorXd v_after;          ///< nv; equal to v_before without an impact
  Eigen::Matrix3Xd impulses;        ///< 3 x contacts, N s, on the robot, world axes
  double energy_lost = 0;           ///< J
  double friction_utilisation = 0;  ///< greatest of the impulses'
};

/// Everything at one time of a rollout.
struct RobotMotion {
  Eigen::VectorXd q, v, a;
  Eigen::VectorXd torques;  ///< num_joints, within the effort limits
  Eigen::Matrix3Xd forces;  ///< 3 x contacts, on the robot, world axes, N; zero where not held
};

struct RobotRollout {
  RobotRolloutEnd end = RobotRolloutEnd::kTime;
  std::string reason;  ///< one line
  double time = 0;     ///< s
  Eigen::VectorXd q, v;
  std::vector<RobotContactEvent> events;
  /// By contact: greatest tangential over normal force over friction of the resultant of its patch
  /// (the held points of its link on its plane) at the ends of the integration steps; impacts are
  /// in the events. Torsion about the normal is not in it.
  Eigen::VectorXd friction_utilisation;
  /// By joint: greatest |torque| over effort limit, likewise; 0 where there is no limit.
  Eigen::VectorXd torque_utilisation;
  HybridRollout hybrid;  ///< the trajectory of (q, v)

  Eigen::VectorXd Configuration(double t) const;  ///< nq, quaternion normalised
  Eigen::VectorXd Velocity(double t) const;       ///< nv
  int nq = 0;
};

/// Simulates a robot under joint control over ground planes. Points that bear are held: they
/// neither slide nor leave. A mode is a set of held points; touchdown of a free point and tipping
/// of a patch about one of its edges end it; then Gauss's principle of least constraint says which
/// points bear (SelectBearingPoints), first for the velocities (inelastic impact), then for the
/// accelerations. Joint stops and other collisions are not simulated. One per thread.
class RobotSimulator {
 public:
  /// @throws std::invalid_argument for contacts, gains or settings that make no sense.
  RobotSimulator(std::shared_ptr<const MultibodyModel> model, std::vector<RolloutContact> contacts,
                 JointControl control, const RobotRolloutSettings& settings = {});
  ~RobotSimulator();
  RobotSimulator(RobotSimulator&&) noexcept;

  /// Points on the ground at the start are held if they bear; those that move into it hit it.
  /// @throws std::invalid_argument for a state of wrong size, that is not finite or has a point
  /// below the ground; OdeError if the integrator gives up; std::runtime_error if the dynamics have
  /// no answer (ForwardDynamics, SelectBearingPoints).
  RobotRollout Run(const Eigen::Ref<const Eigen::VectorXd>& q,
                   const Eigen::Ref<const Eigen::VectorXd>& v, double start_time, double end_time);

  /// At a time of the last rollout.
  RobotMotion MotionAt(const RobotRollout& rollout, double t);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace possibility::dynamics
