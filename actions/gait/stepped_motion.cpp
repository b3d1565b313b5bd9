#include "actions/gait/stepped_motion.h"

#include <utility>

#include "actions/gait/stride.h"
#include "actions/wholebody/support_polygon.h"

namespace possibility::actions {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kNone = -1;

SteppedMotion::SteppedMotion(const models::RobotModel& robot, const NominalStance& stance,
                             double time_scale)
    : robot_(&robot), nominal_(&stance), walking_(robot, stance), time_scale_(time_scale) {
  state_.feet = stance.patch_centres;
  state_.centre_of_mass = stance.centre_of_mass;
  state_.root_height = stance.gait->posture.root_height;
}

SteppedMotion& SteppedMotion::Walk(double distance) {
  const PlanarPose to{distance, 0, 0};
  phases_ = walking_.Phases(PlanStrides(nominal_->gait->parameters, {}, to), 0, time_scale_);
  state_.stance = to;
  for (Vector3d& foot : state_.feet) foot.x() += distance;
  state_.centre_of_mass.x() += distance;
  return *this;
}

SteppedMotion& SteppedMotion::Shift(const BodyShift& to, double duration) {
  State target = state_;
  Hold(to, &target);
  Append(target, duration, kNone);
  return *this;
}

SteppedMotion& SteppedMotion::Swing(int limb, const SteppedSwing& swing, const BodyShift& to) {
  State target = state_;
  target.feet[limb].z() += swing.rise + swing.clearance;
  Append(target, swing.lift_time, limb);
  target.feet[limb].x() += swing.ahead;
  Hold(to, &target);
  Append(target, swing.cross_time, limb);
  target.feet[limb].z() -= swing.clearance;
  Append(target, swing.lift_time / 2, limb);
  return *this;
}

SteppedMotion& SteppedMotion::Rest(double duration) {
  Vector3d moved = Vector3d::Zero();
  for (std::size_t i = 0; i < state_.feet.size(); ++i) {
    moved +=
        (state_.feet[i] - nominal_->patch_centres[i]) / static_cast<double>(state_.feet.size());
  }
  State target = state_;
  target.centre_of_mass = nominal_->centre_of_mass + moved.head<2>();
  target.root_height = nominal_->gait->posture.root_height + moved.z();
  target.lean = 0;
  Append(target, duration, kNone);
  return *this;
}

double SteppedMotion::duration() const {
  double sum = 0;
  for (const MotionPhase& phase : phases_) sum += phase.duration;
  return sum;
}

std::vector<Phase> SteppedMotion::Build(const CancellationToken& cancellation) const {
  return MotionBuilder(*robot_).Build(phases_, nominal_->q, cancellation);
}

double SteppedMotion::GroundOf(int limb) const {
  return state_.feet[limb].z() - nominal_->patch_centres[limb].z();
}

void SteppedMotion::Hold(const BodyShift& shift, State* state) const {
  const Vector2d moved = (state_.feet[shift.over] - nominal_->patch_centres[shift.over]).head<2>();
  std::vector<Vector2d> points;
  for (const Vector2d& p : nominal_->bearing_points[shift.over]) points.push_back(p + moved);
  const Vector2d preferred = nominal_->centre_of_mass + moved + Vector2d(shift.ahead, 0);
  const models::Gait& gait = *nominal_->gait;
  state->centre_of_mass = SupportPolygon(points).Nearest(preferred, gait.parameters.com_margin);
  state->root_height = gait.posture.root_height + GroundOf(shift.over) + shift.lift;
  state->lean = shift.lean;
}

WholeBodyTask SteppedMotion::TaskOf(const State& state) const {
  WholeBodyTask task;
  task.root_yaw = Constant(0);
  task.root_pitch = Constant(nominal_->gait->posture.root_pitch + state.lean);
  task.root_height = Constant(state.root_height);
  task.centre_of_mass = ConstantVector<Vector2d>(state.centre_of_mass);
  task.joints = ConstantVector<Eigen::VectorXd>(nominal_->q.tail(robot_->num_joints()));
  for (std::size_t i = 0; i < state.feet.size(); ++i) {
    LimbTask& limb = task.limbs.emplace_back();
    limb.limb = &nominal_->gait->limbs[i];
    limb.position = ConstantVector<Vector3d>(state.feet[i]);
    limb.yaw = Constant(0);
    limb.orientation = nominal_->patch_orientations[i];
  }
  return task;
}

void SteppedMotion::Append(const State& to, double duration, int swinging) {
  MotionPhase phase;
  phase.duration = time_scale_ * duration;
  for (int i = 0; i < static_cast<int>(state_.feet.size()); ++i) {
    if (i != swinging) phase.contacts.push_back(nominal_->gait->limbs[i].contact);
  }
  phase.task = [a = state_, b = to, time = phase.duration, task = TaskOf(state_),
                pitch = nominal_->gait->posture.root_pitch](double t) mutable {
    const ScalarSignal s = RestToRest(t, time);
    task.centre_of_mass = BlendVector<Vector2d>(a.centre_of_mass, b.centre_of_mass, s);
    task.root_height = Blend(a.root_height, b.root_height, s);
    task.root_pitch = Blend(pitch + a.lean, pitch + b.lean, s);
    for (std::size_t i = 0; i < a.feet.size(); ++i) {
      task.limbs[i].position = BlendVector<Vector3d>(a.feet[i], b.feet[i], s);
    }
    return task;
  };
  phases_.push_back(std::move(phase));
  state_ = to;
}

}  // namespace possibility::actions
