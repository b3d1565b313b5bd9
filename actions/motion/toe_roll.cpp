#include "actions/motion/toe_roll.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "actions/wholebody/force_fault.h"
#include "actions/wholebody/motion_error.h"
#include "dynamics/tree/tree_kinematics.h"

namespace possibility::actions {

using Eigen::Vector3d;
using Eigen::VectorXd;

ToeRoll::ToeRoll(std::shared_ptr<const dynamics::MultibodyModel> model,
                 std::vector<dynamics::ContactPoint> toes, const MotionSettings& settings)
    : dynamics_(std::move(model)), toes_(std::move(toes)), settings_(settings) {}

std::vector<Knot> ToeRoll::Roll(const VectorXd& q, const VectorXd& v, const JointMotion& joints,
                                double duration, int intervals) {
  dynamics_.SetState(q, v);
  q_ = q;
  anchor_ = dynamics_.Position(toes_.front());
  // In the plane the root's quaternion is (cos, 0, sin, 0) of half the pitch.
  Turn turn = {2 * std::atan2(q[2], q[0]), v[1]};
  const double step = duration / intervals;
  std::vector<Knot> knots = {KnotAt(turn, 0, joints)};
  for (int i = 0; i < intervals; ++i) {
    turn = Advance(turn, i * step, step, joints);
    knots.push_back(KnotAt(turn, i + 1 < intervals ? (i + 1) * step : duration, joints));
  }
  return knots;
}

ToeRoll::Turn ToeRoll::Advance(const Turn& turn, double t, double step, const JointMotion& joints) {
  const Signal<VectorXd> begin = joints(t);
  const Signal<VectorXd> middle = joints(t + step / 2);
  const Signal<VectorXd> end = joints(t + step);
  const auto moved = [&turn](double by, const Turn& rate) {
    return Turn{turn.pitch + by * rate.pitch, turn.rate + by * rate.rate};
  };
  const auto rate = [this](const Turn& at, const Signal<VectorXd>& motion) {
    return Turn{at.rate, Acceleration(at, motion)};
  };
  const Turn k1 = rate(turn, begin);
  const Turn k2 = rate(moved(step / 2, k1), middle);
  const Turn k3 = rate(moved(step / 2, k2), middle);
  const Turn k4 = rate(moved(step, k3), end);
  return moved(step / 6, {k1.pitch + 2 * k2.pitch + 2 * k3.pitch + k4.pitch,
                          k1.rate + 2 * k2.rate + 2 * k3.rate + k4.rate});
}

double ToeRoll::Acceleration(const Turn& turn, const Signal<VectorXd>& joints) {
  // Forces and accelerations depend neither on where the robot is nor on its velocity as a whole.
  const Eigen::Index n = joints.value.size();
  q_.head<4>() << std::cos(turn.pitch / 2), 0, std::sin(turn.pitch / 2), 0;
  q_.segment<3>(4).setZero();
  q_.tail(n) = joints.value;
  v_.setZero(6 + n);
  v_[1] = turn.rate;
  v_.tail(n) = joints.rate;
  a_.setZero(6 + n);
  a_.tail(n) = joints.acceleration;
  dynamics_.SetState(q_, v_, a_);
  reach_ = dynamics_.Position(toes_.front());
  drift_ = dynamics_.Acceleration(toes_.front());
  const double at_rest = Moment(0);
  return at_rest / (at_rest - Moment(1));
}

double ToeRoll::Moment(double pitch) {
  a_[1] = pitch;
  a_[3] = -drift_.x() - pitch * reach_.z();
  a_[5] = -drift_.z() + pitch * reach_.x();
  dynamics_.SetAcceleration(a_);
  const VectorXd& forces = dynamics_.InverseDynamics();
  return forces[1] - reach_.z() * forces[3] + reach_.x() * forces[5];
}

void ToeRoll::Place(const Turn& turn, const Signal<VectorXd>& joints) {
  const double y = q_[5];
  Moment(Acceleration(turn, joints));
  const Vector3d velocity = dynamics_.Velocity(toes_.front());
  v_[3] = -velocity.x();
  v_[5] = -velocity.z();
  q_.segment<3>(4) = anchor_ - reach_;
  q_[5] = y;
  dynamics_.SetState(q_, v_, a_);
}

Knot ToeRoll::KnotAt(const Turn& turn, double t, const JointMotion& joints) {
  const Signal<VectorXd> motion = joints(t);
  Place(turn, motion);
  RequireJointLimits(dynamics_.model().tree(), q_, v_, settings_.speed_margin, t);
  dynamics::ContactForceSettings force_settings;
  force_settings.friction = dynamics_.model().tree().friction;
  force_settings.friction_margin = settings_.friction_margin;
  force_settings.normal_reserve =
      settings_.normal_reserve * dynamics_.model().tree().TotalMass() * dynamics::kGravity;
  force_settings.torque_margin = settings_.torque_margin;
  const auto forces = dynamics::DistributeContactForces(&dynamics_, toes_, force_settings);
  if (!forces) {
    throw MotionError(fmt::format("{} at {:.2f} s of the roll over the toes",
                                  ForceFault(&dynamics_, toes_, force_settings).what(), t));
  }
  Knot knot;
  knot.t = t;
  knot.q = q_;
  knot.v = v_;
  knot.a = a_;
  knot.tau = forces->torques;
  knot.forces = forces->forces;
  return knot;
}

}  // namespace possibility::actions
