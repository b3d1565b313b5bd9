#include "dynamics/rollout/robot_rollout.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "dynamics/rollout/rollout_dynamics.h"
#include "dynamics/rollout/rollout_events.h"
#include "dynamics/rollout/rollout_modes.h"
#include "dynamics/rollout/rollout_stance.h"

namespace possibility::dynamics {

namespace {

using Eigen::Matrix3Xd;
using Eigen::VectorXd;

[[noreturn]] void Reject(const std::string& what) {
  throw std::invalid_argument("RobotSimulator: " + what);
}

void CheckContact(const RolloutContact& contact, const MultibodyModel& model) {
  const auto fail = [&contact](const std::string& what) {
    Reject(fmt::format("contact '{}' {}", contact.name, what));
  };
  if (contact.point.link < 0 || contact.point.link >= model.tree().num_links()) {
    fail(fmt::format("is on link {}, expected 0 to {}", contact.point.link,
                     model.tree().num_links() - 1));
  }
  if (!contact.point.p_L.allFinite()) fail("is at a point that is not finite");
  if (!(std::abs(contact.point.normal_W.norm() - 1) < 1e-6)) fail("has a normal that is no unit");
  if (!std::isfinite(contact.offset)) fail("has a plane whose offset is not finite");
  if (!(contact.friction > 0) || !std::isfinite(contact.friction)) {
    fail(fmt::format("has friction {}, expected a positive number", contact.friction));
  }
}

void CheckSettings(const RobotRolloutSettings& settings) {
  if (!(settings.touching >= 0)) Reject("`touching` must not be negative");
  if (!(settings.rest_speed >= 0)) Reject("`rest_speed` must not be negative");
  if (!(settings.rest_energy >= 0)) Reject("`rest_energy` must not be negative");
  if (!(settings.rest_time > 0)) Reject("`rest_time` must be positive");
  if (!(settings.utilisation_interval >= 0)) Reject("`utilisation_interval` must not be negative");
}

}  // namespace

RobotRolloutSettings::RobotRolloutSettings() {
  // Feedback on light links is stiff (measurements: docs/dynamics.md).
  hybrid.integration.method = OdeMethod::kBdf;
  hybrid.integration.relative_tolerance = 1e-8;
  hybrid.integration.absolute_tolerance = 1e-8;
  hybrid.integration.max_step = 0.02;
  hybrid.integration.guard_samples = 4;
  hybrid.integration.guard_resolution = 1e-11;
}

VectorXd RobotRollout::Configuration(double t) const {
  VectorXd q = hybrid.State(t).head(nq);
  if (q.size() - (hybrid.state.size() - nq) == 1) q.head<4>().normalize();
  return q;
}

VectorXd RobotRollout::Velocity(double t) const {
  const VectorXd state = hybrid.State(t);
  return state.tail(state.size() - nq);
}

class RobotSimulator::Impl {
 public:
  Impl(std::shared_ptr<const MultibodyModel> model, std::vector<RolloutContact> contacts,
       JointControl control, const RobotRolloutSettings& settings)
      : robot_(std::move(model), std::move(contacts), std::move(control), settings),
        settings_(settings),
        events_(&robot_, settings, &rollout_),
        modes_(&robot_, settings, &events_, &rollout_) {
    for (int i = 0; i < robot_.num_contacts(); ++i) CheckContact(robot_.contact(i), robot_.model());
    CheckSettings(settings);
    if (settings.push && robot_.model().base() != Base::kFloating) {
      Reject("a push needs a floating base");
    }
  }

  RobotRollout Run(const Eigen::Ref<const VectorXd>& q, const Eigen::Ref<const VectorXd>& v,
                   double start_time, double end_time) {
    CheckState(q, v);
    rollout_ = {};
    rollout_.nq = robot_.nq();
    rollout_.friction_utilisation = VectorXd::Zero(robot_.num_contacts());
    rollout_.torque_utilisation = VectorXd::Zero(robot_.model().num_joints());
    modes_.Clear();

    VectorXd state(robot_.nq() + robot_.nv());
    state << q, v;
    robot_.SetState(state);
    CheckDepths();
    const auto mode = modes_.Make(events_.Start(start_time, &state));
    if (rollout_.end == RobotRolloutEnd::kSlip) {
      rollout_.hybrid.end = HybridEnd::kReset;
      rollout_.hybrid.reason = rollout_.reason;
      rollout_.hybrid.time = start_time;
      rollout_.hybrid.state = state;
      rollout_.hybrid.segments = {{mode, OdeTrajectory(start_time, state)}};
    } else {
      rollout_.hybrid = RollOut(mode, state, start_time, end_time, settings_.hybrid);
    }
    Conclude();
    return std::exchange(rollout_, {});
  }

  RobotMotion MotionAt(const RobotRollout& rollout, double t) {
    return robot_.MotionAt(t, rollout.hybrid.State(t),
                           modes_.StanceOf(rollout.hybrid.SegmentAt(t)));
  }

 private:
  void CheckState(const Eigen::Ref<const VectorXd>& q, const Eigen::Ref<const VectorXd>& v) const {
    if (q.size() != robot_.nq() || v.size() != robot_.nv()) {
      Reject(fmt::format("q and v have {} and {} elements, expected {} and {}", q.size(), v.size(),
                         robot_.nq(), robot_.nv()));
    }
    if (!q.allFinite() || !v.allFinite()) Reject("the state is not finite");
  }

  void CheckDepths() {
    for (int i = 0; i < robot_.num_contacts(); ++i) {
      const double gap = robot_.Gap(i);
      if (gap >= -settings_.touching || robot_.contact(i).lands) continue;
      Reject(fmt::format("contact '{}' starts {:.3g} m below the ground", robot_.contact(i).name,
                         -gap));
    }
  }

  void Conclude() {
    HybridRollout& hybrid = rollout_.hybrid;
    robot_.NormaliseOrientation(&hybrid.state);
    rollout_.time = hybrid.time;
    rollout_.q = hybrid.state.head(robot_.nq());
    rollout_.v = hybrid.state.tail(robot_.nv());
    rollout_.reason = hybrid.reason;
    if (hybrid.end == HybridEnd::kCancelled) rollout_.end = RobotRolloutEnd::kCancelled;
    if (hybrid.end == HybridEnd::kZeno) rollout_.end = RobotRolloutEnd::kZeno;
    for (const HybridSegment& segment : hybrid.segments) {
      double recorded = -std::numeric_limits<double>::infinity();
      for (const double t : segment.trajectory.StepTimes()) {
        if (t - recorded < settings_.utilisation_interval) continue;
        RecordUtilisation(t, segment.trajectory.State(t), modes_.StanceOf(segment));
        recorded = t;
      }
    }
  }

  void RecordUtilisation(double t, const VectorXd& state, const RolloutStance& stance) {
    Matrix3Xd forces;
    robot_.Accelerate(t, state, stance, &forces);
    const MultibodyModel& model = robot_.model();
    for (int i = 0; i < model.num_joints(); ++i) {
      const double torque = robot_.joint_torques()[i];
      const double limit = model.TorqueLimit(i, torque, state.tail(model.nv()));
      if (!(limit > 0) || !std::isfinite(limit)) continue;
      double& greatest = rollout_.torque_utilisation[i];
      greatest = std::max(greatest, std::abs(torque) / limit);
    }
    for (const ContactPatchBalance& patch : stance.patches) {
      const double utilisation =
          patch.FrictionUtilisation(forces, robot_.ContactOf(patch, stance.held).friction);
      for (const int point : patch.points) {
        double& greatest = rollout_.friction_utilisation[stance.held[point]];
        greatest = std::max(greatest, utilisation);
      }
    }
  }

  RolloutDynamics robot_;
  RobotRolloutSettings settings_;
  RobotRollout rollout_;  ///< the current rollout; empty in between
  RolloutEvents events_;
  RolloutModes modes_;
};

RobotSimulator::RobotSimulator(std::shared_ptr<const MultibodyModel> model,
                               std::vector<RolloutContact> contacts, JointControl control,
                               const RobotRolloutSettings& settings) {
  if (!model) Reject("no model");
  impl_ =
      std::make_unique<Impl>(std::move(model), std::move(contacts), std::move(control), settings);
}

RobotSimulator::~RobotSimulator() = default;
RobotSimulator::RobotSimulator(RobotSimulator&&) noexcept = default;

RobotRollout RobotSimulator::Run(const Eigen::Ref<const VectorXd>& q,
                                 const Eigen::Ref<const VectorXd>& v, double start_time,
                                 double end_time) {
  return impl_->Run(q, v, start_time, end_time);
}

RobotMotion RobotSimulator::MotionAt(const RobotRollout& rollout, double t) {
  return impl_->MotionAt(rollout, t);
}

}  // namespace possibility::dynamics
