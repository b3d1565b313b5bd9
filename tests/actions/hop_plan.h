#pragma once

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <memory>
#include <vector>

#include "actions/motion/free_flight.h"
#include "actions/motion/phase_sequence.h"
#include "actions/wholebody/motion_builder.h"
#include "actions/wholebody/nominal_stance.h"
#include "dynamics/contact/contact_feasibility.h"
#include "dynamics/forward/forward_dynamics.h"
#include "models/robot/rotation_vector.h"
#include "tests/actions/standing_plan.h"

namespace possibility::actions::testing {

/// A robot that stands on both feet, hops a few millimetres straight up, lands flat on its soles,
/// all eight corners at once, and stands where it stood: phases push, flight and absorption, the
/// last of which begins with the impact.
class Hop {
 public:
  /// `left_foot`: m, how much higher the ground is under the left foot.
  explicit Hop(const models::RobotModel& robot, double left_foot = 0)
      : robot_(robot),
        stance_(SolveNominalStance(robot, robot.GaitNamed("walk"))),
        model_(dynamics::MultibodyModel::Spatial(robot)),
        builder_(robot, Settings()),
        solver_(robot) {
    for (std::size_t i = 0; i < stance_.gait->limbs.size(); ++i) {
      LimbTask limb;
      limb.limb = &stance_.gait->limbs[i];
      limb.position = ConstantVector<Eigen::Vector3d>(stance_.patch_centres[i]);
      limb.orientation = stance_.patch_orientations[i];
      if (i == 0) limb.position.value.z() += left_foot;
      limbs_.push_back(limb);
      soles_.push_back(limb.limb->contact);
      const models::ContactPatch& patch = robot.contacts[limb.limb->contact];
      for (const Eigen::Vector3d& p : patch.points) points_.push_back({patch.link, p});
    }
  }

  Segment Build() {
    Segment segment{"hop", {}};
    segment.phases.push_back(Push());
    segment.phases.push_back(Flight(segment.phases.back().knots.back()));
    Append(Absorb(segment.phases.back().knots.back()), &segment);
    return segment;
  }

 private:
  static constexpr double kPushTime = 0.6;
  static constexpr double kRise = 0.06;   // m, of the root while it pushes
  static constexpr double kSpeed = 0.35;  // m/s, of the root at take-off
  static constexpr double kFold = 0.05;   // s, in which the joints come to rest in flight
  static constexpr double kAbsorb = 0.4;  // s

  static MotionSettings Settings() {
    MotionSettings settings;
    settings.knot_spacing = 0.01;
    return settings;
  }

  WholeBodyTask Standing() const {
    WholeBodyTask task;
    task.root_pitch = Constant(stance_.gait->posture.root_pitch);
    task.root_height = Constant(stance_.q[6]);
    task.joints = ConstantVector<Eigen::VectorXd>(stance_.q.tail(robot_.num_joints()));
    task.limbs = limbs_;
    return task;
  }

  /// From rest at 0 to kRise with kSpeed and no acceleration.
  static ScalarSignal Rising(double t) {
    const ScalarSignal back = DyingOut<double>(kRise, -kSpeed, kPushTime - t, kPushTime);
    return {back.value, -back.rate, back.acceleration};
  }

  static void Append(Phase phase, Segment* segment) {
    std::vector<Phase> shifted = {std::move(phase)};
    ShiftTime(segment->phases.back().knots.back().t, &shifted);
    segment->phases.push_back(std::move(shifted.front()));
  }

  Phase Push() {
    MotionPhase phase;
    phase.duration = kPushTime;
    phase.contacts = soles_;
    phase.task = [this](double t) {
      WholeBodyTask task = Standing();
      task.root_height = Constant(stance_.q[6]);
      const ScalarSignal rise = Rising(t);
      task.root_height.value += rise.value;
      task.root_height.rate = rise.rate;
      task.root_height.acceleration = rise.acceleration;
      return task;
    };
    return builder_.Build({phase}, stance_.q).front();
  }

  Phase Flight(const Knot& from) {
    const Eigen::Index n = robot_.num_joints();
    dynamics::MultibodyDynamics dynamics(model_);
    dynamics.SetState(from.q, from.v);
    const double speed = dynamics.Centroidal().momentum[5] / robot_.TotalMass();
    const double duration = 2 * speed / dynamics::kGravity;
    Eigen::VectorXd correction = Eigen::VectorXd::Zero(n);
    const JointMotion joints = [&](double t) {
      return ConstantVector<Eigen::VectorXd>(from.q.tail(n)) +
             DyingOut<Eigen::VectorXd>(Eigen::VectorXd::Zero(n), from.v.tail(n), t, kFold) +
             BlendVector<Eigen::VectorXd>(Eigen::VectorXd::Zero(n), correction,
                                          RestToRest(t, duration));
    };
    constexpr int kIntervals = 16;
    FreeFlight flight(model_);
    flight.TakeOff(from.q, from.v);
    for (int round = 0; round < 80; ++round) {
      const Knot landing = flight.Land(joints, duration, kIntervals);
      correction += (OnSoles(landing).q - landing.q).tail(n);
    }
    Phase phase;
    phase.knots = flight.Fly(joints, duration, kIntervals);
    for (Knot& knot : phase.knots) knot.t += from.t;
    return phase;
  }

  WholeBodyState OnSoles(const Knot& knot) {
    WholeBodyTask task = Standing();
    task.root_turn.emplace().orientation =
        Eigen::Quaterniond(knot.q[0], knot.q[1], knot.q[2], knot.q[3]).toRotationMatrix();
    task.root_height = Constant(knot.q[6]);
    task.root_position = ConstantVector<Eigen::Vector2d>(knot.q.segment<2>(4));
    return solver_.Solve(task, knot.q);
  }

  /// Times from 0. The root's turn is small and only about one axis at first order: yaw and roll
  /// are left to die out with the pitch, as a rotation vector whose rate is the angular velocity.
  Phase Absorb(const Knot& touchdown) {
    const Eigen::Index n = robot_.num_joints();
    dynamics::ForwardDynamics forward(model_);
    forward.SetState(touchdown.q, touchdown.v);
    const dynamics::Impact impact = forward.Hit(points_);
    const Eigen::VectorXd v = impact.velocity;
    const Eigen::Matrix3Xd impulses =
        dynamics::CheckImpact(&forward, impact, points_, robot_.friction).impulses;
    const Eigen::AngleAxisd turn(
        Eigen::Quaterniond(touchdown.q[0], touchdown.q[1], touchdown.q[2], touchdown.q[3]));
    const Eigen::Vector3d phi = turn.angle() * turn.axis();
    MotionPhase phase;
    phase.duration = kAbsorb;
    phase.contacts = soles_;
    phase.task = [=, this](double t) {
      WholeBodyTask task = Standing();
      task.root_turn = Turned(phi, v.head<3>(), t);
      const auto dying = DyingOut<Eigen::VectorXd>(touchdown.q.tail(n + 3) - stance_.q.tail(n + 3),
                                                   v.tail(n + 3), t, kAbsorb);
      task.root_position = {stance_.q.segment<2>(4) + dying.value.head<2>(), dying.rate.head<2>(),
                            dying.acceleration.head<2>()};
      task.root_height = {stance_.q[6] + dying.value[2], dying.rate[2], dying.acceleration[2]};
      task.joints = {stance_.q.tail(n) + dying.value.tail(n), dying.rate.tail(n),
                     dying.acceleration.tail(n)};
      return task;
    };
    Phase result = builder_.Build({phase}, touchdown.q).front();
    result.impulses = impulses;
    return result;
  }

  /// exp(phi(t)) with phi the quintic that dies out, begun at `phi` with angular velocity `omega`.
  static LinkTurn Turned(const Eigen::Vector3d& phi, const Eigen::Vector3d& omega, double t) {
    const Eigen::Vector3d rate = models::LeftJacobian(phi).inverse() * omega;
    const Signal<Eigen::Vector3d> left = DyingOut<Eigen::Vector3d>(phi, rate, t, kAbsorb);
    const double angle = left.value.norm();
    LinkTurn turn;
    if (angle > 0) {
      turn.orientation = Eigen::AngleAxisd(angle, left.value / angle).toRotationMatrix();
    }
    turn.angular_velocity = models::LeftJacobian(left.value) * left.rate;
    turn.angular_acceleration = models::LeftJacobian(left.value) * left.acceleration +
                                models::LeftJacobianRate(left.value, left.rate) * left.rate;
    return turn;
  }

  const models::RobotModel& robot_;
  NominalStance stance_;
  std::shared_ptr<const dynamics::MultibodyModel> model_;
  MotionBuilder builder_;
  WholeBodySolver solver_;
  std::vector<LimbTask> limbs_;
  std::vector<int> soles_;
  std::vector<dynamics::ContactPoint> points_;
};

inline VerifierSubject HopPlan(const std::string& robot_yaml) {
  VerifierSubject subject = PlanWithoutMotion(robot_yaml);
  subject.scenario.actions = {"walk", "hop"};
  subject.plan.segments = {Hop(subject.robot).Build()};
  return subject;
}

}  // namespace possibility::actions::testing
