#include "experiments/examples/step_up_motion.h"

#include <utility>

#include "actions/motion/motion_builder.h"
#include "actions/motion/support_polygon.h"

namespace possibility::actions {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// The robot at rest, in the world.
struct StepUpMotion::State {
  PlanarPose before;           ///< stance that the step starts in
  std::vector<Vector3d> feet;  ///< centres of the patches, by limb
  Vector2d centre_of_mass;
  double root_height = 0;
  double lean = 0;
};

StepUpMotion::StepUpMotion(const models::RobotModel& robot, const LocomotionModel::GaitEntry& gait,
                           const StepUpSettings& settings)
    : robot_(&robot), gait_(&gait), walking_(robot, gait.stance), settings_(settings) {}

double StepUpMotion::ExpectedDuration(const PlanarPose& from) const {
  const double any_rise = settings_.clearance;  // it takes no longer to step higher
  double duration = 0;
  for (const MotionPhase& phase : Phases(from, 0, any_rise)) duration += phase.duration;
  return duration;
}

std::vector<Phase> StepUpMotion::Generate(const PlanarPose& from, double z, double rise,
                                          const CancellationToken& cancellation) const {
  Eigen::VectorXd guess = gait_->stance.q;
  guess.segment<2>(4) = from.position();
  return MotionBuilder(*robot_).Build(Phases(from, z, rise), guess, cancellation);
}

std::vector<MotionPhase> StepUpMotion::Phases(const PlanarPose& from, double z, double rise) const {
  const NominalStance& stance = gait_->stance;
  const double nominal_height = z + stance.gait->posture.root_height;
  const PlanarPose before = from * PlanarPose{settings_.approach, 0, 0};
  std::vector<MotionPhase> phases =
      walking_.Phases(PlanStrides(stance.gait->parameters, from, before), z, settings_.time_scale);

  State state{before, {}, before * stance.centre_of_mass, nominal_height, 0};
  for (const Vector3d& p_SF : stance.patch_centres) state.feet.push_back(before.At(z) * p_SF);
  const auto posture = [&](int bearing, const StepPosture& wanted, double ground) {
    State target = state;
    target.centre_of_mass = Over(bearing, state, wanted.ahead);
    target.root_height = nominal_height + ground + wanted.lift;
    target.lean = wanted.lean;
    return target;
  };
  constexpr int kFirst = 0, kSecond = 1;
  Shift(posture(kSecond, settings_.first_foot_up, 0), &state, &phases);
  Swing(kFirst, rise, state, &state, &phases);
  Shift(posture(kFirst, settings_.second_foot_leaves, rise), &state, &phases);
  Swing(kSecond, rise, posture(kFirst, settings_.second_foot_up, rise), &state, &phases);
  State end = state;
  end.centre_of_mass = from * PlanarPose{distance(), 0, 0} * stance.centre_of_mass;
  end.root_height = nominal_height + rise;
  end.lean = 0;
  Shift(end, &state, &phases);
  return phases;
}

Vector2d StepUpMotion::Over(int limb, const State& state, double ahead) const {
  const NominalStance& stance = gait_->stance;
  const Vector2d p_S = state.before.Inverse() * Vector2d(state.feet[limb].head<2>());
  const Vector2d offset = p_S - stance.patch_centres[limb].head<2>();
  std::vector<Vector2d> points;
  for (const Vector2d& p : stance.bearing_points[limb]) points.push_back(p + offset);
  const Vector2d preferred = stance.centre_of_mass + offset + Vector2d(ahead, 0);
  return state.before *
         SupportPolygon(points).Nearest(preferred, stance.gait->parameters.com_margin);
}

WholeBodyTask StepUpMotion::TaskOf(const State& state) const {
  const NominalStance& stance = gait_->stance;
  WholeBodyTask task;
  task.root_yaw = Constant(state.before.yaw);
  task.root_pitch = Constant(stance.gait->posture.root_pitch + state.lean);
  task.root_height = Constant(state.root_height);
  task.centre_of_mass = ConstantVector<Vector2d>(state.centre_of_mass);
  task.joints = ConstantVector<Eigen::VectorXd>(stance.q.tail(robot_->num_joints()));
  for (size_t limb = 0; limb < state.feet.size(); ++limb) {
    LimbTask foot;
    foot.limb = &stance.gait->limbs[limb];
    foot.position = ConstantVector<Vector3d>(state.feet[limb]);
    foot.yaw = Constant(state.before.yaw);
    foot.orientation = stance.patch_orientations[limb];
    task.limbs.push_back(foot);
  }
  return task;
}

std::vector<int> StepUpMotion::ContactsBut(int limb) const {
  std::vector<int> contacts;
  const std::vector<models::GaitLimb>& limbs = gait_->stance.gait->limbs;
  for (int i = 0; i < static_cast<int>(limbs.size()); ++i) {
    if (i != limb) contacts.push_back(limbs[i].contact);
  }
  return contacts;
}

void StepUpMotion::Shift(const State& target, State* state,
                         std::vector<MotionPhase>* phases) const {
  MotionPhase phase;
  phase.duration = settings_.time_scale * settings_.shift_time;
  phase.contacts = ContactsBut(-1);
  phase.task = [=, a = *state, duration = phase.duration, task = TaskOf(*state),
                pitch = gait_->stance.gait->posture.root_pitch](double t) mutable {
    const ScalarSignal s = RestToRest(t, duration);
    task.centre_of_mass = BlendVector<Vector2d>(a.centre_of_mass, target.centre_of_mass, s);
    task.root_height = Blend(a.root_height, target.root_height, s);
    task.root_pitch = Blend(pitch + a.lean, pitch + target.lean, s);
    return task;
  };
  phases->push_back(std::move(phase));
  *state = target;
}

void StepUpMotion::Swing(int limb, double rise, const State& target, State* state,
                         std::vector<MotionPhase>* phases) const {
  const Vector3d up(0, 0, rise + settings_.clearance);
  const Vector3d from = state->feet[limb];
  const Vector3d across = state->before.At(0).linear() * Vector3d(settings_.step, 0, 0);
  MoveFoot(limb, from + up, *state, settings_.lift_time, state, phases);
  MoveFoot(limb, from + up + across, target, settings_.carry_time, state, phases);
  MoveFoot(limb, from + across + Vector3d(0, 0, rise), *state, settings_.lift_time / 2, state,
           phases);
}

void StepUpMotion::MoveFoot(int limb, const Vector3d& p_WF, const State& target, double duration,
                            State* state, std::vector<MotionPhase>* phases) const {
  MotionPhase phase;
  phase.duration = settings_.time_scale * duration;
  phase.contacts = ContactsBut(limb);
  phase.task = [=, a = *state, length = phase.duration, task = TaskOf(*state),
                pitch = gait_->stance.gait->posture.root_pitch](double t) mutable {
    const ScalarSignal s = RestToRest(t, length);
    task.limbs[limb].position = BlendVector<Vector3d>(a.feet[limb], p_WF, s);
    task.centre_of_mass = BlendVector<Vector2d>(a.centre_of_mass, target.centre_of_mass, s);
    task.root_height = Blend(a.root_height, target.root_height, s);
    task.root_pitch = Blend(pitch + a.lean, pitch + target.lean, s);
    return task;
  };
  phases->push_back(std::move(phase));
  std::vector<Vector3d> feet = state->feet;
  feet[limb] = p_WF;
  *state = target;
  state->feet = std::move(feet);
}

}  // namespace possibility::actions
