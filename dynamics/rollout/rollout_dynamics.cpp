#include "dynamics/rollout/rollout_dynamics.h"

#include <utility>

namespace possibility::dynamics {

using Eigen::Matrix3Xd;
using Eigen::MatrixXd;
using Eigen::VectorXd;

RolloutDynamics::RolloutDynamics(std::shared_ptr<const MultibodyModel> model,
                                 std::vector<RolloutContact> contacts, JointControl control,
                                 const RobotRolloutSettings& settings)
    : forward_(std::move(model), settings.dynamics),
      applied_(forward_.model(), std::move(control), settings.push),
      contacts_(std::move(contacts)),
      kinematics_(forward_.model().tree()),
      weight_(dynamics()->kinematics().total_mass() * kGravity) {}

bool RolloutDynamics::Lands(int contact, const VectorXd& state) const {
  return !contacts_[contact].lands || contacts_[contact].lands(state.head(nq()));
}

void RolloutDynamics::NormaliseOrientation(VectorXd* state) const {
  if (model().base() == Base::kFloating) state->head<4>().normalize();
}

void RolloutDynamics::SetState(const Eigen::Ref<const VectorXd>& state) {
  accelerated_ = nullptr;
  forward_.SetState(state.head(nq()), state.tail(nv()));
}

double RolloutDynamics::Gap(int contact) {
  const ContactPoint& point = contacts_[contact].point;
  return point.normal_W.dot(dynamics()->Position(point)) - contacts_[contact].offset;
}

double RolloutDynamics::GapAt(const Eigen::Ref<const VectorXd>& state, int contact) {
  if (position_.size() != nq() || position_ != state.head(nq())) {
    position_ = state.head(nq());
    kinematics_.SetPosition(model().TreeConfiguration(position_));
  }
  const ContactPoint& point = contacts_[contact].point;
  return point.normal_W.dot(kinematics_.Position(point.link, point.p_L)) -
         contacts_[contact].offset;
}

double RolloutDynamics::KineticEnergy(const Eigen::Ref<const VectorXd>& v) {
  return 0.5 * v.dot(dynamics()->MassMatrix() * v);
}

std::vector<HeldPoint> RolloutDynamics::HeldWhereTheyAre(const std::vector<int>& held) {
  std::vector<HeldPoint> points;
  for (const int contact : held) {
    const ContactPoint& point = contacts_[contact].point;
    points.push_back({point, dynamics()->Position(point)});
  }
  return points;
}

std::vector<ContactPatchBalance> RolloutDynamics::PatchesOf(const std::vector<int>& held) {
  return MakePatches(HeldWhereTheyAre(held));
}

const Impact& RolloutDynamics::Hit(const std::vector<int>& contacts) {
  std::vector<ContactPoint> points;
  points.reserve(contacts.size());
  for (const int contact : contacts) points.push_back(contacts_[contact].point);
  return forward_.Hit(points);
}

UnilateralContacts RolloutDynamics::UnilateralVelocities(const std::vector<int>& contacts) {
  VectorXd velocities(3 * contacts.size());
  for (size_t i = 0; i < contacts.size(); ++i) {
    velocities.segment<3>(3 * i) = dynamics()->Velocity(contacts_[contacts[i]].point);
  }
  return Unilateral(contacts, std::move(velocities));
}

UnilateralContacts RolloutDynamics::UnilateralAccelerations(double t,
                                                            const Eigen::Ref<const VectorXd>& state,
                                                            const std::vector<int>& contacts) {
  dynamics()->SetAcceleration(forward_.Free(Applied(t, state, true)));
  VectorXd accelerations(3 * contacts.size());
  for (size_t i = 0; i < contacts.size(); ++i) {
    accelerations.segment<3>(3 * i) = dynamics()->Acceleration(contacts_[contacts[i]].point);
  }
  return Unilateral(contacts, std::move(accelerations));
}

UnilateralContacts RolloutDynamics::Unilateral(const std::vector<int>& contacts,
                                               VectorXd unconstrained) {
  UnilateralContacts unilateral;
  unilateral.mass = dynamics()->MassMatrix();
  unilateral.unconstrained = std::move(unconstrained);
  unilateral.jacobian.resize(3 * contacts.size(), nv());
  for (size_t i = 0; i < contacts.size(); ++i) {
    const ContactPoint& point = contacts_[contacts[i]].point;
    dynamics()->Jacobian(point, unilateral.jacobian.middleRows<3>(3 * i));
    unilateral.normals.push_back(point.normal_W);
  }
  return unilateral;
}

const VectorXd& RolloutDynamics::Applied(double t, const Eigen::Ref<const VectorXd>& state,
                                         bool has_landed) {
  return applied_.Evaluate(t, state.head(nq()), state.tail(nv()), has_landed, dynamics());
}

VectorXd RolloutDynamics::Accelerate(double t, const Eigen::Ref<const VectorXd>& state,
                                     const RolloutStance& stance, Matrix3Xd* forces) {
  SetState(state);
  const VectorXd& joint_forces = Applied(t, state, stance.has_landed);
  forces_.setZero(3, stance.points.size());
  VectorXd acceleration;
  if (stance.points.empty()) {
    acceleration = forward_.Free(joint_forces);
  } else {
    const ConstrainedMotion& motion = forward_.Held(joint_forces, stance.points);
    acceleration = motion.acceleration;
    forces_ = motion.forces;
  }
  if (forces != nullptr) *forces = forces_;
  accelerated_ = &stance;
  time_ = t;
  state_ = state;
  return acceleration;
}

bool RolloutDynamics::IsNearLastAcceleration(double t, const Eigen::Ref<const VectorXd>& state,
                                             const RolloutStance& stance, double distance,
                                             double speed) const {
  return accelerated_ == &stance && time_ == t &&
         (state - state_).head(nq()).lpNorm<Eigen::Infinity>() <= distance &&
         (state - state_).tail(nv()).lpNorm<Eigen::Infinity>() <= speed;
}

void RolloutDynamics::DifferentiateRate(double t, const Eigen::Ref<const VectorXd>& state,
                                        const RolloutStance& stance,
                                        Eigen::Ref<MatrixXd> jacobian) {
  Accelerate(t, state, stance, nullptr);
  const int joints = model().num_joints();
  const ConstrainedResponse response = forward_.Response();
  const double rate = 1 / forward_.settings().drift_time;
  MatrixXd to_position = -rate * rate * response.to_drift;
  MatrixXd to_velocity = -2 * rate * response.to_drift;
  const auto to_torques = response.to_forces.rightCols(joints);
  to_position.rightCols(joints) -= to_torques * applied_.torques().Stiffness().asDiagonal();
  const VectorXd damping = applied_.torques().Damping() + FrictionSlopes(model(), state.tail(nv()));
  to_velocity.rightCols(joints) -= to_torques * damping.asDiagonal();
  StateRateJacobian(model(), state.head(nq()), to_position, to_velocity, jacobian);
}

RobotMotion RolloutDynamics::MotionAt(double t, const VectorXd& state,
                                      const RolloutStance& stance) {
  RobotMotion motion;
  Matrix3Xd forces;
  motion.a = Accelerate(t, state, stance, &forces);
  motion.q = state.head(nq());
  motion.v = state.tail(nv());
  motion.torques = joint_torques();
  motion.forces.setZero(3, num_contacts());
  for (size_t i = 0; i < stance.held.size(); ++i) {
    motion.forces.col(stance.held[i]) = forces.col(i);
  }
  return motion;
}

double RolloutDynamics::AccelerationIfLetGo(const RolloutStance& stance, int contact) {
  std::vector<HeldPoint> others;
  for (size_t i = 0; i < stance.held.size(); ++i) {
    if (stance.held[i] != contact) others.push_back(stance.points[i]);
  }
  const VectorXd acceleration = others.empty()
                                    ? forward_.Free(applied_.generalised())
                                    : forward_.Held(applied_.generalised(), others).acceleration;
  dynamics()->SetAcceleration(acceleration);
  const ContactPoint& point = contacts_[contact].point;
  return point.normal_W.dot(dynamics()->Acceleration(point));
}

}  // namespace possibility::dynamics
