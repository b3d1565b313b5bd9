#include "actions/sagittal/stance_motion.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "actions/motion/phase_sequence.h"
#include "actions/wholebody/motion_collision.h"
#include "actions/wholebody/motion_error.h"
#include "models/robot/rotation_vector.h"

namespace possibility::actions {
namespace {

using collocation::PhaseTrajectory;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

// A phase that turns joints to where the plan begins lasts for so long, or for as long as they need
// at this share of their speed limits: a gait may turn them in its last steps as well.
constexpr double kPreparation = 1.0;  // s
constexpr double kPreparationSpeed = 0.9;
constexpr double kKnotSpacing = 0.01;         // s
constexpr double kPreparationSpacing = 0.02;  // s: the root rests
constexpr double kUnbounded = 20;             // m
constexpr double kCorrection = 0.5;    // s, time until the motion is as planned, if there is time
constexpr double kTurningSpeed = 0.6;  // of a joint's speed limit, while it turns to the plan

Eigen::Quaterniond Orientation(const VectorXd& q) { return {q[0], q[1], q[2], q[3]}; }

std::vector<int> ContactsOf(const models::Gait& gait) {
  std::vector<int> contacts;
  for (const models::GaitLimb& limb : gait.limbs) contacts.push_back(limb.contact);
  return contacts;
}

Signal<VectorXd> Planar(const PhaseTrajectory& plan, double t) {
  const double s = std::clamp(t / plan.duration, 0.0, 1.0);
  return {plan.Coordinates(s, 0), plan.Coordinates(s, 1), plan.Coordinates(s, 2)};
}

/// `turn` followed by exp(phi(t)).
LinkTurn TurnedOnBy(const Signal<Vector3d>& phi, const LinkTurn& turn) {
  const Eigen::Matrix3d R = models::Exponential(phi.value).toRotationMatrix();
  const Eigen::Matrix3d J = models::LeftJacobian(phi.value);
  const Vector3d own = J * phi.rate;
  const Vector3d carried = R * turn.angular_velocity;
  LinkTurn result;
  result.orientation = R * turn.orientation;
  result.angular_velocity = own + carried;
  result.angular_acceleration = J * phi.acceleration +
                                models::LeftJacobianRate(phi.value, phi.rate) * phi.rate +
                                own.cross(carried) + R * turn.angular_acceleration;
  return result;
}

/// Converts a signal of the remaining time into a signal of time.
Signal<VectorXd> Reversed(const Signal<VectorXd>& signal) {
  return {signal.value, -signal.rate, signal.acceleration};
}

ScalarSignal Entry(const Signal<VectorXd>& signal, int i) {
  return {signal.value[i], signal.rate[i], signal.acceleration[i]};
}

ScalarSignal Entry(const Signal<Vector3d>& signal, int i) {
  return {signal.value[i], signal.rate[i], signal.acceleration[i]};
}

}  // namespace

StanceMotion::StanceMotion(const models::RobotModel& robot, const SagittalModel& model,
                           const NominalStance& launch, const NominalStance& landing)
    : robot_(robot),
      model_(model),
      launch_(launch),
      landing_(landing),
      feet_(ContactsOf(*launch.gait)),
      all_(ContactsOf(*landing.gait)),
      solver_(robot) {
  settings_.knot_spacing = kKnotSpacing;
  // A heel unloads to zero before it lifts.
  settings_.normal_reserve = 0;
  // The planar plan's reserve is for effects that only the whole robot has.
  settings_.friction_margin = 0.88;
  settings_.torque_margin = 0.99;
  settings_.speed_margin = 0.99;
}

Support StanceMotion::LaunchFeet() const { return SupportOf(launch_, feet_, 0, 0); }

Support StanceMotion::LandingFeet(double distance, double height) const {
  return SupportOf(landing_, feet_, distance, height);
}

Support StanceMotion::LandingAll(double distance, double height) const {
  Support all = SupportOf(landing_, all_, distance, height);
  for (const int contact : all.contacts) {
    if (std::find(feet_.begin(), feet_.end(), contact) == feet_.end()) {
      all.coming_down.push_back(contact);
    }
  }
  return all;
}

Support StanceMotion::SupportOf(const NominalStance& stance, const std::vector<int>& contacts,
                                double x, double z) const {
  Support support;
  for (std::size_t i = 0; i < stance.gait->limbs.size(); ++i) {
    const int contact = stance.gait->limbs[i].contact;
    if (std::find(contacts.begin(), contacts.end(), contact) == contacts.end()) continue;
    LimbTask limb;
    limb.limb = &stance.gait->limbs[i];
    limb.position = ConstantVector<Vector3d>(stance.patch_centres[i] + Vector3d(x, 0, z));
    limb.yaw = Constant(0);
    limb.orientation = stance.patch_orientations[i];
    support.limbs.push_back(limb);
    const models::ContactPatch& patch = robot_.contacts[contact];
    support.contacts.push_back(contact);
    support.names.push_back(patch.name);
    for (const Vector3d& p_L : patch.points) support.points.push_back({patch.link, p_L});
  }
  return support;
}

Support StanceMotion::Toes() const {
  constexpr double kSame = 1e-6;  // m
  Support toes;
  for (std::size_t limb = 0; limb < launch_.gait->limbs.size(); ++limb) {
    const models::ContactPatch& patch = robot_.contacts[launch_.gait->limbs[limb].contact];
    const std::vector<Vector2d>& points = launch_.bearing_points[limb];
    double foremost = -std::numeric_limits<double>::infinity();
    for (const Vector2d& p : points) foremost = std::max(foremost, p.x());
    std::vector<int> chosen;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (points[i].x() < foremost - kSame) continue;
      chosen.push_back(static_cast<int>(i));
      toes.points.push_back({patch.link, patch.points[i]});
    }
    toes.names.push_back(fmt::format("{}[{}]", patch.name, fmt::join(chosen, ",")));
  }
  return toes;
}

std::vector<Phase> StanceMotion::Begin(const std::function<Phase(const Knot& from)>& follow) const {
  Knot standing;
  standing.q = launch_.q;
  standing.v = VectorXd::Zero(robot_.nv());
  try {
    Phase phase = follow(standing);
    if (!Hits(phase)) return {phase};
  } catch (const MotionError&) {
    // Too quick for the joints, or too much for balance.
  }
  std::vector<Phase> motion = {Prepare()};
  Append(follow(motion.front().knots.back()), &motion);
  return motion;
}

bool StanceMotion::Hits(const Phase& phase) const {
  models::Environment environment;
  models::Obstacle& ground = environment.obstacles.emplace_back();
  ground.name = "ground";
  ground.shape = models::Shape::Box({kUnbounded, kUnbounded, 1});
  ground.X_WO.translation().z() = -0.5;
  ground.is_ground = true;
  const models::CollisionChecker checker(robot_, environment);
  return !FirstHit(robot_, environment, checker, {phase}).empty() ||
         !FirstSelfHit(robot_, checker, {phase}).empty();
}

double StanceMotion::TurningTime(const VectorXd& offset, double speed_share) const {
  double time = 0;
  for (Eigen::Index j = 0; j < offset.size(); ++j) {
    const double speed = speed_share * robot_.joints[j].velocity;
    // The quintic's peak rate is 15/8 of its mean.
    time = std::max(time, 15.0 / 8 * std::abs(offset[j]) / speed);
  }
  return time;
}

VectorXd StanceMotion::ReadyJoints() const {
  return model_.reduction().ExpandConfiguration(model_.ready()).tail(robot_.num_joints());
}

bool StanceMotion::NeedsPreparation() const {
  constexpr double kSame = 1e-6;  // rad, of stances that are symmetric up to their solver's error
  return (ReadyJoints() - launch_.q.tail(robot_.num_joints())).lpNorm<Eigen::Infinity>() > kSame;
}

Phase StanceMotion::Prepare() const {
  const VectorXd from = launch_.q.tail(robot_.num_joints());
  const VectorXd to = ReadyJoints();
  const double duration = std::max(kPreparation, TurningTime(to - from, kPreparationSpeed));
  WholeBodyTask task;
  task.root_yaw = Constant(0);
  task.root_pitch = Constant(launch_.gait->posture.root_pitch);
  task.root_height = Constant(launch_.q[6]);
  task.root_position = ConstantVector<Vector2d>(launch_.q.segment<2>(4));
  task.limbs = LaunchFeet().limbs;
  MotionPhase phase;
  phase.duration = duration;
  phase.contacts = feet_;
  phase.task = [=](double t) mutable {
    task.joints = BlendVector<VectorXd>(from, to, RestToRest(t, duration));
    return task;
  };
  MotionSettings settings = settings_;
  settings.knot_spacing = kPreparationSpacing;
  return MotionBuilder(robot_, settings).Build({phase}, launch_.q).front();
}

Signal<VectorXd> StanceMotion::Joints(const PhaseTrajectory& plan, double t) const {
  const Signal<VectorXd> planar = Planar(plan, t);
  const int n = robot_.num_joints();
  const dynamics::SagittalReduction& reduction = model_.reduction();
  return {reduction.ExpandConfiguration(planar.value).tail(n),
          reduction.ExpandVelocity(planar.rate).tail(n),
          reduction.ExpandVelocity(planar.acceleration).tail(n)};
}

Knot StanceMotion::PlannedKnot(const PhaseTrajectory& plan, double s) const {
  Knot knot;
  knot.q = model_.reduction().ExpandConfiguration(plan.Coordinates(s));
  knot.v = model_.reduction().ExpandVelocity(plan.Coordinates(s, 1));
  return knot;
}

WholeBodyState StanceMotion::StateAt(const Knot& knot, const Support& support) {
  const int n = robot_.num_joints();
  WholeBodyTask task;
  LinkTurn& turn = task.root_turn.emplace();
  turn.orientation = Orientation(knot.q).toRotationMatrix();
  turn.angular_velocity = knot.v.head<3>();
  task.root_height = {knot.q[6], knot.v[5], 0};
  task.root_position = {knot.q.segment<2>(4), knot.v.segment<2>(3), Vector2d::Zero()};
  task.joints = {knot.q.tail(n), knot.v.tail(n), VectorXd::Zero(n)};
  task.limbs = support.limbs;
  return solver_.Solve(task, knot.q);
}

Phase StanceMotion::Follow(const PhaseTrajectory& plan, const Knot& from,
                           const Support& support) const {
  const VectorXd none = VectorXd::Zero(robot_.num_joints());
  return Follow(plan, from, support, none, none);
}

Phase StanceMotion::FollowUntilPlaced(const PhaseTrajectory& plan, const Knot& from,
                                      const Support& support, const Support& arriving) {
  const int n = robot_.num_joints();
  const Knot planned = PlannedKnot(plan, 1);
  const WholeBodyState placed = StateAt(planned, arriving);
  return Follow(plan, from, support, placed.q.tail(n) - planned.q.tail(n),
                placed.v.tail(n) - planned.v.tail(n));
}

Phase StanceMotion::Follow(const PhaseTrajectory& plan, const Knot& from, const Support& support,
                           const VectorXd& end_offset, const VectorXd& end_rate) const {
  const int n = robot_.num_joints();
  const Signal<VectorXd> planned = Planar(plan, 0);
  const Signal<VectorXd> planned_joints = Joints(plan, 0);
  const LinkTurn planned_turn = TurnedBy(Constant(0), Entry(planned, 0));
  const Vector3d turned_off = models::RotationVector(Orientation(from.q).toRotationMatrix() *
                                                     planned_turn.orientation.transpose());
  const Vector3d turning_off =
      models::LeftJacobian(turned_off).inverse() *
      (from.v.head<3>() -
       models::Exponential(turned_off).toRotationMatrix() * planned_turn.angular_velocity);
  const Vector3d place_off = from.q.segment<3>(4) - Vector3d(planned.value[1], 0, planned.value[2]);
  const Vector3d velocity_off =
      from.v.segment<3>(3) - Vector3d(planned.rate[1], 0, planned.rate[2]);
  const VectorXd joints_off = from.q.tail(n) - planned_joints.value;
  const VectorXd rates_off = from.v.tail(n) - planned_joints.rate;
  const double duration = plan.duration;
  const double settled = std::min(kCorrection, duration);
  const double turned =
      std::min(std::max(kCorrection, TurningTime(joints_off, kTurningSpeed)), duration);

  MotionPhase phase;
  phase.duration = duration;
  phase.contacts = support.contacts;
  phase.coming_down = support.coming_down;
  phase.task = [=, this, &plan, &support](double t) {
    const Signal<VectorXd> planar = Planar(plan, t);
    const Signal<Vector3d> turn = DyingOut<Vector3d>(turned_off, turning_off, t, settled);
    const Signal<Vector3d> shift = DyingOut<Vector3d>(place_off, velocity_off, t, settled);
    WholeBodyTask task;
    task.root_turn = TurnedOnBy(turn, TurnedBy(Constant(0), Entry(planar, 0)));
    const ScalarSignal x = Entry(shift, 0) + Entry(planar, 1);
    const ScalarSignal y = Entry(shift, 1);
    task.root_position = {Vector2d(x.value, y.value), Vector2d(x.rate, y.rate),
                          Vector2d(x.acceleration, y.acceleration)};
    task.root_height = Entry(shift, 2) + Entry(planar, 2);
    task.joints = Joints(plan, t) + DyingOut<VectorXd>(joints_off, rates_off, t, turned) +
                  Reversed(DyingOut<VectorXd>(end_offset, -end_rate, duration - t, duration));
    task.limbs = support.limbs;
    return task;
  };
  return MotionBuilder(robot_, settings_).Build({phase}, from.q).front();
}

}  // namespace possibility::actions
