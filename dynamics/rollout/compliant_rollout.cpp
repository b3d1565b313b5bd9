#include "dynamics/rollout/compliant_rollout.h"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

namespace possibility::dynamics {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

CompliantRolloutSettings::CompliantRolloutSettings() {
  integration.method = OdeMethod::kBdf;
  integration.relative_tolerance = 1e-6;
  integration.absolute_tolerance = 1e-6;
  integration.max_step = 0.01;
  integration.max_steps = 10'000'000;
}

VectorXd CompliantRollout::Configuration(double t) const {
  const VectorXd state = trajectory.State(t);
  VectorXd q = state.head(nq);
  if (2 * nq - state.size() == 1) q.head<4>().normalize();
  return q;
}

VectorXd CompliantRollout::Velocity(double t) const {
  const VectorXd state = trajectory.State(t);
  return state.tail(state.size() - nq);
}

CompliantSimulator::CompliantSimulator(std::shared_ptr<const MultibodyModel> model,
                                       std::vector<RolloutContact> contacts, JointControl control,
                                       CompliantRolloutSettings settings)
    : settings_(std::move(settings)),
      forward_(std::move(model)),
      applied_(forward_.model(), std::move(control), settings_.push),
      contacts_(std::move(contacts)) {}

bool CompliantSimulator::Bears(const RolloutContact& contact, const Eigen::Ref<const VectorXd>& q,
                               double gap) const {
  return gap < 0 && gap > -kSide && (!contact.lands || contact.lands(q));
}

double CompliantSimulator::Gap(const RolloutContact& contact) {
  return contact.point.normal_W.dot(forward_.dynamics()->Position(contact.point)) - contact.offset;
}

void CompliantSimulator::SetForces(double t, const Eigen::Ref<const VectorXd>& state) {
  const auto q = state.head(model().nq());
  forward_.SetState(q, state.tail(model().nv()));
  MultibodyDynamics* dynamics = forward_.dynamics();
  generalised_ = applied_.Evaluate(t, q, state.tail(model().nv()), true, dynamics);
  forces_.setZero(3, static_cast<Eigen::Index>(contacts_.size()));
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    const RolloutContact& contact = contacts_[i];
    const double gap = Gap(contact);
    if (!Bears(contact, q, gap)) continue;
    const Vector3d force = ForceOf(settings_.ground, contact.friction, contact.point.normal_W, gap,
                                   dynamics->Velocity(contact.point));
    forces_.col(static_cast<Eigen::Index>(i)) = force;
    if (!force.isZero()) dynamics->AddPointForce(contact.point, force, generalised_);
  }
}

VectorXd CompliantSimulator::Accelerate(double t, const Eigen::Ref<const VectorXd>& state) {
  SetForces(t, state);
  return forward_.Free(generalised_);
}

void CompliantSimulator::DifferentiateRate(double t, const Eigen::Ref<const VectorXd>& state,
                                           Eigen::Ref<MatrixXd> jacobian) {
  Accelerate(t, state);
  const int nv = model().nv(), joints = model().num_joints();
  MatrixXd by_position = MatrixXd::Zero(nv, nv), by_velocity = MatrixXd::Zero(nv, nv);
  by_position.diagonal().tail(joints) = -applied_.torques().Stiffness();
  by_velocity.diagonal().tail(joints) =
      -applied_.torques().Damping() - FrictionSlopes(model(), state.tail(nv));
  MatrixXd J(3, nv);
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    if (forces_.col(static_cast<Eigen::Index>(i)).isZero()) continue;
    const RolloutContact& contact = contacts_[i];
    const GroundReaction reaction =
        ReactionOf(settings_.ground, contact.friction, contact.point.normal_W, Gap(contact),
                   forward_.dynamics()->Velocity(contact.point));
    forward_.dynamics()->Jacobian(contact.point, J);
    by_position.noalias() += J.transpose() * (reaction.to_position * J);
    by_velocity.noalias() += J.transpose() * (reaction.to_velocity * J);
  }
  const MatrixXd to_forces = forward_.Response().to_forces;
  StateRateJacobian(model(), state.head(model().nq()), to_forces * by_position,
                    to_forces * by_velocity, jacobian);
}

CompliantRollout CompliantSimulator::Run(const Eigen::Ref<const VectorXd>& q,
                                         const Eigen::Ref<const VectorXd>& v, double start_time,
                                         double end_time) {
  const int nq = model().nq(), nv = model().nv();
  if (q.size() != nq || v.size() != nv) {
    throw std::invalid_argument(
        fmt::format("CompliantSimulator: q and v have {} and {} elements, expected {} and {}",
                    q.size(), v.size(), nq, nv));
  }
  OdeProblem problem;
  problem.rate = [this, nq, nv](double t, const auto& state, auto rate) {
    rate.tail(nv) = Accelerate(t, state);
    rate.head(nq) = model().ConfigurationRate(state.head(nq), state.tail(nv));
  };
  problem.jacobian = [this](double t, const auto& state, auto jacobian) {
    DifferentiateRate(t, state, jacobian);
  };
  problem.positions = nq;
  problem.start_time = start_time;
  problem.end_time = end_time;
  problem.start.resize(nq + nv);
  problem.start << q, v;
  if (settings_.until) {
    problem.guards.push_back({GuardDirection::kFalling});
    problem.guard_values = [this, nq](double t, const auto& state, auto values) {
      values[0] = settings_.until(t, state.head(nq));
    };
  }
  OdeSolution solution = Integrate(problem, settings_.integration);
  return {solution.end, std::move(solution.trajectory), solution.statistics, nq};
}

RobotMotion CompliantSimulator::MotionAt(const CompliantRollout& rollout, double t) {
  const VectorXd state = rollout.trajectory.State(t);
  RobotMotion motion;
  motion.a = Accelerate(t, state);
  motion.q = rollout.Configuration(t);
  motion.v = rollout.Velocity(t);
  motion.torques = applied_.generalised().tail(model().num_joints());
  motion.forces = forces_;
  return motion;
}

}  // namespace possibility::dynamics
