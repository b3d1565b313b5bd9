#include "actions/transition_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "models/input_error.h"

namespace possibility::actions {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// Shared patches may disagree by no more than this about where they stand, m.
constexpr double kAlignmentTolerance = 1e-6;

int LimbOfContact(const models::Gait& gait, int contact) {
  for (size_t i = 0; i < gait.limbs.size(); ++i) {
    if (gait.limbs[i].contact == contact) return static_cast<int>(i);
  }
  return -1;
}

}  // namespace

TransitionMotion::TransitionMotion(const models::RobotModel& robot,
                                   const models::Transition& transition, const NominalStance& from,
                                   const NominalStance& to)
    : robot_(&robot), from_(&from), to_(&to) {
  AlignStances();
  SolveStops(transition);
}

void TransitionMotion::AlignStances() {
  Vector2d sum = Vector2d::Zero();
  std::vector<Vector2d> offsets;
  for (size_t i = 0; i < to_->gait->limbs.size(); ++i) {
    const int limb = LimbOfContact(*from_->gait, to_->gait->limbs[i].contact);
    if (limb < 0) continue;
    offsets.push_back((from_->patch_centres[limb] - to_->patch_centres[i]).head<2>());
    sum += offsets.back();
  }
  if (offsets.empty()) {
    throw InputError(fmt::format("{}: transitions: {} and {} share no contact",
                                 robot_->file.string(), from_->gait->name, to_->gait->name));
  }
  const Vector2d mean = sum / static_cast<double>(offsets.size());
  for (const Vector2d& offset : offsets) {
    if ((offset - mean).norm() > kAlignmentTolerance) {
      throw InputError(fmt::format(
          "{}: transitions: the contacts shared by {} and {} stand {:.6f} m differently apart",
          robot_->file.string(), from_->gait->name, to_->gait->name, (offset - mean).norm()));
    }
  }
  displacement_ = {mean.x(), mean.y(), 0};
}

LimbTask TransitionMotion::BearingLimb(int contact, const PlanarPose& stance, double z) const {
  const int in_from = LimbOfContact(*from_->gait, contact);
  const NominalStance& owner = in_from >= 0 ? *from_ : *to_;
  const int limb = in_from >= 0 ? in_from : LimbOfContact(*to_->gait, contact);
  if (limb < 0) {
    throw InputError(fmt::format("{}: transitions: contact {} belongs to neither {} nor {}",
                                 robot_->file.string(), robot_->contacts[contact].name,
                                 from_->gait->name, to_->gait->name));
  }
  const PlanarPose frame = in_from >= 0 ? stance : stance * displacement_;
  LimbTask task;
  task.limb = &owner.gait->limbs[limb];
  Vector3d position;
  position << frame * Vector2d(owner.patch_centres[limb].head<2>()),
      owner.patch_centres[limb].z() + z;
  task.position = ConstantVector<Vector3d>(position);
  task.yaw = Constant(frame.yaw);
  task.orientation = owner.patch_orientations[limb];
  return task;
}

void TransitionMotion::SolveStops(const models::Transition& transition) {
  const Vector2d target_com = displacement_ * to_->centre_of_mass;
  Stop start;
  start.root_height = from_->gait->posture.root_height;
  start.root_pitch = from_->gait->posture.root_pitch;
  start.centre_of_mass = from_->centre_of_mass;
  start.joints = from_->q.tail(robot_->num_joints());
  stops_ = {start};

  WholeBodySolver solver(*robot_);
  VectorXd q = from_->q;
  for (size_t i = 0; i < transition.keyframes.size(); ++i) {
    const models::TransitionKeyframe& keyframe = transition.keyframes[i];
    const bool last = i + 1 == transition.keyframes.size();
    Stop stop;
    stop.duration = keyframe.duration;
    stop.contacts = keyframe.contacts;
    stop.root_height = keyframe.root_height;
    stop.root_pitch = keyframe.root_pitch;
    stop.centre_of_mass = target_com;
    if (keyframe.com_x) {
      stop.centre_of_mass = {*keyframe.com_x, from_->centre_of_mass.y()};
    }
    stop.joints = stops_.back().joints;
    for (const auto& [joint, value] : keyframe.joints) stop.joints[joint] = value;
    if (last) {
      stop.root_height = to_->gait->posture.root_height;
      stop.root_pitch = to_->gait->posture.root_pitch;
      stop.centre_of_mass = target_com;
      stop.joints = to_->q.tail(robot_->num_joints());
    }
    // A patch that bears in the next motion touches down at the end of this one.
    std::set<int> bearing(keyframe.contacts.begin(), keyframe.contacts.end());
    if (!last) {
      const std::vector<int>& next = transition.keyframes[i + 1].contacts;
      bearing.insert(next.begin(), next.end());
    }
    WholeBodyTask task;
    task.root_pitch = Constant(stop.root_pitch);
    task.root_height = Constant(stop.root_height);
    task.centre_of_mass = ConstantVector<Vector2d>(stop.centre_of_mass);
    task.joints = ConstantVector<VectorXd>(stop.joints);
    for (int contact : bearing) task.limbs.push_back(BearingLimb(contact, PlanarPose(), 0));
    q.tail(robot_->num_joints()) = stop.joints;
    try {
      q = solver.Solve(task, q).q;
    } catch (const MotionError& error) {
      throw InputError(fmt::format("{}: transitions: {} to {}: keyframe {} cannot be reached: {}",
                                   robot_->file.string(), transition.from, transition.to, i + 1,
                                   error.what()));
    }
    stop.joints = q.tail(robot_->num_joints());
    stops_.push_back(stop);
  }
}

std::vector<MotionPhase> TransitionMotion::Phases(const PlanarPose& stance, double z,
                                                  double time_scale) const {
  std::vector<MotionPhase> phases;
  for (size_t i = 1; i < stops_.size(); ++i) {
    const Stop& a = stops_[i - 1];
    const Stop& b = stops_[i];
    MotionPhase phase;
    phase.duration = time_scale * b.duration;
    phase.contacts = b.contacts;
    WholeBodyTask task;
    task.root_yaw = Constant(stance.yaw);
    for (int contact : b.contacts) task.limbs.push_back(BearingLimb(contact, stance, z));
    const Vector2d com_a = stance * a.centre_of_mass;
    const Vector2d com_b = stance * b.centre_of_mass;
    phase.task = [=, duration = phase.duration](double t) mutable {
      const ScalarSignal s = RestToRest(t, duration);
      task.root_pitch = Blend(a.root_pitch, b.root_pitch, s);
      task.root_height = Blend(a.root_height + z, b.root_height + z, s);
      task.centre_of_mass = BlendVector<Vector2d>(com_a, com_b, s);
      task.joints = BlendVector<VectorXd>(a.joints, b.joints, s);
      return task;
    };
    phases.push_back(std::move(phase));
  }
  return phases;
}

double TransitionMotion::ExpectedDuration() const {
  double duration = 0;
  for (const Stop& stop : stops_) duration += stop.duration;
  return duration;
}

}  // namespace possibility::actions
