#pragma once

#include <Eigen/Core>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "dynamics/forward/forward_dynamics.h"
#include "dynamics/rollout/applied_forces.h"
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
  /// lands at configuration q. Called when the contact comes down to its plane and, while it is
  /// held, when another contact lands. False: it passes through the plane, or leaves it. If empty,
  /// it always lands.
  std::function<bool(const Eigen::VectorXd& q)> lands;
};

struct RobotRolloutSettings {
  RobotRolloutSettings();

  HybridSettings hybrid;  ///< default: BDF, tolerances 1e-8, steps of 0.02 s at most
  ForwardDynamicsSettings dynamics;
  /// m: a point this close to its plane touches it. A deeper point at the start is an error.
  double touching = 1e-6;
  /// m/s: after an impact, points that would leave the ground more slowly than this stay. This ends
  /// the endless sequence of ever smaller impacts of a rocking foot.
  double rest_speed = 1e-3;
  /// m: a point that friction jams (RobotContactEvent::jammed) sinks so far below its plane before
  /// it is held. A jam that passes within milliseconds then leaves no trace, as on ground that
  /// yields a little. 0: it is held at once.
  double jam_depth = 0;
  /// True: a patch whose resultant leaves its friction cone ends the rollout
  /// (RobotRolloutEnd::kSlip). False: the patch sticks, and its utilisation is reported.
  bool ends_at_slip = false;
  /// J: the rollout ends (kAtRest) when the kinetic energy has been below this for rest_time. 0:
  /// never.
  double rest_energy = 0;
  double rest_time = 0.1;              ///< s
  double utilisation_interval = 1e-3;  ///< s: utilisations are recorded this far apart at least
  /// N, world: a force on the root at its centre of mass, beside gravity and contacts. It must not
  /// change within less than `hybrid.integration.max_step`. May be empty. Floating bases only.
  RootPush push;
};

enum class RobotRolloutEnd { kTime, kAtRest, kSlip, kCancelled, kZeno };

/// A touchdown, a release, or both. The first event may be at the start, for the points that stand
/// on the ground there. Indices are of contacts.
struct RobotContactEvent {
  double time = 0;            ///< s
  std::vector<int> touched;   ///< contacts that came down
  std::vector<int> released;  ///< contacts that were held before and no longer are
  std::vector<int> held;      ///< contacts held from now on
  std::vector<int> jammed;    ///< subset of `held` that only friction keeps (BearingSelection)
  Eigen::VectorXd v_before;   ///< nv
  Eigen::VectorXd v_after;    ///< nv; equal to v_before without an impact
  Eigen::Matrix3Xd impulses;  ///< 3 x contacts, N s, on the robot, world axes
  double energy_lost = 0;     ///< J
  double friction_utilisation = 0;  ///< greatest one of the impulses
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
  /// By contact: greatest (tangential / normal force) / friction of the resultant of its patch (the
  /// held points of its link on its plane) at ends of integration steps (utilisation_interval).
  /// Impacts are in the events. Torsion about the normal is not included.
  Eigen::VectorXd friction_utilisation;
  /// By joint: greatest |torque| over effort limit, at the same times; 0 for joints without a
  /// limit.
  Eigen::VectorXd torque_utilisation;
  HybridRollout hybrid;  ///< the trajectory of (q, v)

  Eigen::VectorXd Configuration(double t) const;  ///< nq, quaternion normalised
  Eigen::VectorXd Velocity(double t) const;       ///< nv
  int nq = 0;
};

/// Simulates a robot under joint control over ground planes. Points that bear are held: they
/// neither slide nor leave. A mode is a set of held points. It ends when a free point touches down
/// or a patch tips about one of its edges. Gauss's principle of least constraint
/// (SelectBearingPoints) then selects the points that bear, first for the velocities (inelastic
/// impact), then for the accelerations. Joint stops and other collisions are not simulated. One
/// simulator per thread.
class RobotSimulator {
 public:
  /// @throws std::invalid_argument for invalid contacts, gains or settings.
  RobotSimulator(std::shared_ptr<const MultibodyModel> model, std::vector<RolloutContact> contacts,
                 JointControl control, const RobotRolloutSettings& settings = {});
  ~RobotSimulator();
  RobotSimulator(RobotSimulator&&) noexcept;

  /// Points on the ground at the start are held if they bear. Points that move into the ground hit
  /// it.
  /// @throws std::invalid_argument for a state of wrong size, that is not finite or has a point
  /// below the ground; OdeError if the integrator gives up; std::runtime_error if the dynamics have
  /// no solution (ForwardDynamics, SelectBearingPoints).
  RobotRollout Run(const Eigen::Ref<const Eigen::VectorXd>& q,
                   const Eigen::Ref<const Eigen::VectorXd>& v, double start_time, double end_time);

  /// Motion at a time of the last rollout.
  RobotMotion MotionAt(const RobotRollout& rollout, double t);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace possibility::dynamics
