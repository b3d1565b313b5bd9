#include "actions/gait/quasi_static_gait.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "actions/wholebody/motion_error.h"
#include "actions/wholebody/support_polygon.h"

namespace possibility::actions {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Weight shifts below this get no phase of their own, m. Clearances that differ by less are equal,
/// m.
constexpr double kSameClearance = 1e-6;

constexpr double kNegligibleShift = 1e-4;

/// Factors that stretch durations, tried in turn until the motion keeps all limits.
constexpr double kTimeScales[] = {1, 1.4, 2};

Vector3d At(const PlanarPose& pose, const Vector3d& p, double z) {
  Vector3d result;
  result << pose * Vector2d(p.head<2>()), p.z() + z;
  return result;
}

}  // namespace

/// State of the robot, at rest, while the phases are laid out.
struct QuasiStaticGait::Progress {
  std::vector<PlanarPose> limbs;  ///< stance of each limb
  Vector2d centre_of_mass;
  double root_yaw = 0;
  double root_roll = 0;
  double z = 0;
  double time_scale = 1;
};

QuasiStaticGait::QuasiStaticGait(const models::RobotModel& robot, const NominalStance& stance)
    : robot_(&robot), stance_(&stance) {
  constexpr int kSome = 4;
  stride_time_ = DurationOfStridesAhead(kSome + 1) - DurationOfStridesAhead(kSome);
  stop_time_ = DurationOfStridesAhead(kSome) - kSome * stride_time_;
}

QuasiStaticGait::Progress QuasiStaticGait::AtRest(const PlanarPose& stance, double z) const {
  Progress progress;
  progress.limbs.assign(stance_->gait->limbs.size(), stance);
  progress.centre_of_mass = stance * stance_->centre_of_mass;
  progress.root_yaw = stance.yaw;
  progress.z = z;
  return progress;
}

std::vector<Phase> QuasiStaticGait::Motion(const std::vector<PlanarPose>& strides,
                                           double knot_spacing,
                                           const CancellationToken& cancellation) const {
  MotionSettings settings;
  settings.knot_spacing = knot_spacing;
  MotionBuilder builder(*robot_, settings);
  Eigen::VectorXd guess = stance_->q;
  guess.segment<2>(4) = strides.front().position();
  for (const double scale : kTimeScales) {
    try {
      return builder.Build(Phases(strides, 0, scale), guess, cancellation);
    } catch (const MotionError&) {
      if (scale == std::end(kTimeScales)[-1]) throw;
    }
  }
  return {};
}

MotionPhase QuasiStaticGait::Standing(const PlanarPose& stance, double z, double duration) const {
  MotionPhase phase;
  phase.duration = duration;
  for (const models::GaitLimb& limb : stance_->gait->limbs) phase.contacts.push_back(limb.contact);
  phase.task = [task = StandingTask(AtRest(stance, z))](double) { return task; };
  return phase;
}

std::vector<MotionPhase> QuasiStaticGait::Phases(const std::vector<PlanarPose>& strides, double z,
                                                 double time_scale) const {
  const int limb_count = static_cast<int>(stance_->gait->limbs.size());
  Progress progress = AtRest(strides.front(), z);
  progress.time_scale = time_scale;

  std::vector<MotionPhase> phases;
  for (size_t i = 0; i + 1 < strides.size(); ++i) {
    const PlanarPose& a = strides[i];
    const PlanarPose& b = strides[i + 1];
    const std::vector<int> order = SwingOrder(a, b);
    for (int j = 0; j < limb_count; ++j) {
      const PlanarPose reference = Interpolate(a, b, (j + 0.5) / limb_count);
      const bool begins = phases.empty();
      AppendShift({SupportedCentreOfMass(progress, order[j], reference),
                   RollFor(progress, order[j], reference)},
                  begins, &progress, &phases);
      AppendSwing(order[j], b, Interpolate(a, b, (j + 1.0) / limb_count).yaw, &progress, &phases);
    }
  }
  AppendShift({strides.back() * stance_->centre_of_mass, 0}, true, &progress, &phases);
  return phases;
}

std::vector<int> QuasiStaticGait::SwingOrder(const PlanarPose& a, const PlanarPose& b) const {
  std::vector<int> order(stance_->gait->limbs.size());
  std::iota(order.begin(), order.end(), 0);
  std::vector<int> other = order;
  std::rotate(other.begin(), other.begin() + static_cast<int>(order.size()) / 2, other.end());
  // Rounding must not decide between mirror-image orders: one after the other, they make the same
  // limb swing twice in a row.
  return ClearanceAfterSwing(order.front(), a, b) >=
                 ClearanceAfterSwing(other.front(), a, b) - kSameClearance
             ? order
             : other;
}

double QuasiStaticGait::ClearanceAfterSwing(int limb, const PlanarPose& a,
                                            const PlanarPose& b) const {
  const SupportPolygon swung(Placed(limb, b));
  double clearance = std::numeric_limits<double>::infinity();
  for (size_t other = 0; other < stance_->gait->limbs.size(); ++other) {
    if (static_cast<int>(other) == limb) continue;
    const std::vector<Vector2d> points = Placed(static_cast<int>(other), a);
    const SupportPolygon standing(points);
    for (const Vector2d& p : points) clearance = std::min(clearance, -swung.Margin(p));
    for (const Vector2d& p : swung.vertices()) clearance = std::min(clearance, -standing.Margin(p));
  }
  return clearance;
}

std::vector<Vector2d> QuasiStaticGait::Placed(int limb, const PlanarPose& at) const {
  std::vector<Vector2d> points;
  for (const Vector2d& p : stance_->bearing_points[limb]) points.push_back(at * p);
  return points;
}

Vector2d QuasiStaticGait::SupportedCentreOfMass(const Progress& progress, int swinging,
                                                const PlanarPose& reference) const {
  std::vector<Vector2d> points;
  for (size_t limb = 0; limb < progress.limbs.size(); ++limb) {
    if (static_cast<int>(limb) == swinging) continue;
    const std::vector<Vector2d> placed = Placed(static_cast<int>(limb), progress.limbs[limb]);
    points.insert(points.end(), placed.begin(), placed.end());
  }
  return SupportPolygon(points).Nearest(reference * stance_->centre_of_mass,
                                        stance_->gait->parameters.com_margin);
}

double QuasiStaticGait::RollFor(const Progress& progress, int swinging,
                                const PlanarPose& reference) const {
  const double sway = stance_->gait->parameters.sway;
  if (sway == 0) return 0;
  double aside = 0;  // m, to the left, of the limbs that bear
  for (size_t limb = 0; limb < progress.limbs.size(); ++limb) {
    if (static_cast<int>(limb) == swinging) continue;
    const Vector2d centre = stance_->patch_centres[limb].head<2>();
    aside += (reference.Inverse() * (progress.limbs[limb] * centre)).y();
  }
  return aside > 0 ? -sway : sway;
}

LimbTask QuasiStaticGait::StandingLimb(int limb, const PlanarPose& at, double z) const {
  LimbTask task;
  task.limb = &stance_->gait->limbs[limb];
  task.position = ConstantVector<Vector3d>(At(at, stance_->patch_centres[limb], z));
  task.yaw = Constant(at.yaw);
  task.orientation = stance_->patch_orientations[limb];
  return task;
}

WholeBodyTask QuasiStaticGait::StandingTask(const Progress& progress) const {
  WholeBodyTask task;
  task.root_yaw = Constant(progress.root_yaw);
  task.root_pitch = Constant(stance_->gait->posture.root_pitch);
  if (stance_->gait->parameters.sway != 0) {
    task.root_turn = TurnedBy(task.root_yaw, task.root_pitch, Constant(progress.root_roll));
  }
  task.root_height = Constant(stance_->gait->posture.root_height + progress.z);
  task.centre_of_mass = ConstantVector<Vector2d>(progress.centre_of_mass);
  task.joints = ConstantVector<Eigen::VectorXd>(stance_->q.tail(robot_->num_joints()));
  for (size_t limb = 0; limb < progress.limbs.size(); ++limb) {
    task.limbs.push_back(StandingLimb(static_cast<int>(limb), progress.limbs[limb], progress.z));
  }
  return task;
}

void QuasiStaticGait::AppendShift(const Balance& target, bool is_end, Progress* progress,
                                  std::vector<MotionPhase>* phases) const {
  const Balance from{progress->centre_of_mass, progress->root_roll};
  const double distance = (target.centre_of_mass - from.centre_of_mass).norm();
  // The robot stands on all its limbs where the motion begins and ends.
  if (distance < kNegligibleShift && target.roll == from.roll && !is_end) return;
  const models::GaitParameters& parameters = stance_->gait->parameters;
  MotionPhase phase;
  phase.duration =
      progress->time_scale * std::max(parameters.minimum_shift_time,
                                      RestToRestDuration(distance, parameters.com_acceleration));
  for (const models::GaitLimb& limb : stance_->gait->limbs) phase.contacts.push_back(limb.contact);
  phase.task = [task = StandingTask(*progress), from, target,
                duration = phase.duration](double t) mutable {
    const ScalarSignal s = RestToRest(t, duration);
    task.centre_of_mass = BlendVector<Vector2d>(from.centre_of_mass, target.centre_of_mass, s);
    if (task.root_turn) {
      task.root_turn = TurnedBy(task.root_yaw, task.root_pitch, Blend(from.roll, target.roll, s));
    }
    return task;
  };
  phases->push_back(std::move(phase));
  progress->centre_of_mass = target.centre_of_mass;
  progress->root_roll = target.roll;
}

void QuasiStaticGait::AppendSwing(int limb, const PlanarPose& to, double root_yaw,
                                  Progress* progress, std::vector<MotionPhase>* phases) const {
  const models::GaitParameters& parameters = stance_->gait->parameters;
  MotionPhase phase;
  phase.duration = progress->time_scale * parameters.swing_time;
  for (size_t other = 0; other < progress->limbs.size(); ++other) {
    if (static_cast<int>(other) != limb) {
      phase.contacts.push_back(stance_->gait->limbs[other].contact);
    }
  }
  const LimbTask from = StandingLimb(limb, progress->limbs[limb], progress->z);
  const LimbTask target = StandingLimb(limb, to, progress->z);
  phase.task = [=, task = StandingTask(*progress), from_yaw = progress->root_yaw,
                roll = progress->root_roll, clearance = parameters.clearance,
                duration = phase.duration](double t) mutable {
    const ScalarSignal s = RestToRest(t, duration);
    const ScalarSignal lift = Bump(t, duration);
    LimbTask& swing = task.limbs[limb];
    swing.position = BlendVector<Vector3d>(from.position.value, target.position.value, s);
    swing.position.value.z() += clearance * lift.value;
    swing.position.rate.z() += clearance * lift.rate;
    swing.position.acceleration.z() += clearance * lift.acceleration;
    swing.yaw = Blend(from.yaw.value, target.yaw.value, s);
    task.root_yaw = Blend(from_yaw, root_yaw, s);
    if (task.root_turn) task.root_turn = TurnedBy(task.root_yaw, task.root_pitch, Constant(roll));
    return task;
  };
  phases->push_back(std::move(phase));
  progress->limbs[limb] = to;
  progress->root_yaw = root_yaw;
}

double QuasiStaticGait::ExpectedDuration(int strides) const {
  return strides == 0 ? 0 : strides * stride_time_ + stop_time_;
}

double QuasiStaticGait::DurationOfStridesAhead(int count) const {
  std::vector<PlanarPose> strides;
  for (int i = 0; i <= count; ++i) strides.push_back({i * stance_->gait->parameters.forward, 0, 0});
  double duration = 0;
  for (const MotionPhase& phase : Phases(strides, 0, 1)) duration += phase.duration;
  return duration;
}

}  // namespace possibility::actions
