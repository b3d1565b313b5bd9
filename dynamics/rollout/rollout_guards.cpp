#include "dynamics/rollout/rollout_guards.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace possibility::dynamics {

namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Kind = RolloutGuard::Kind;

/// A state so near to one that has been evaluated (rad and m; rad/s and m/s) has gaps that differ
/// by some 1e-6 m and forces that differ by some newtons. The integrator's corrections are smaller.
constexpr double kNearby = 1e-6;
constexpr double kNearbySpeed = 5e-4;
/// Guards that are farther from zero, m and as a share of the weight, have the same sign at both.
constexpr double kClearGap = 2e-5;
constexpr double kClear = 0.02;

std::vector<RolloutGuard> GuardsOf(const RolloutStance& stance,
                                   const RobotRolloutSettings& settings) {
  std::vector<RolloutGuard> guards;
  for (const int contact : stance.free) {
    guards.push_back({Kind::kTouchdown, contact, -1, -1});
  }
  for (int patch = 0; patch < static_cast<int>(stance.patches.size()); ++patch) {
    const int edges = static_cast<int>(stance.patches[patch].edges.size());
    for (int edge = 0; edge < edges; ++edge) {
      guards.push_back({Kind::kTipping, -1, patch, edge});
    }
    if (settings.ends_at_slip) guards.push_back({Kind::kSlip, -1, patch, -1});
  }
  for (const int contact : stance.jammed) {
    guards.push_back({Kind::kUnjamming, contact, -1, -1});
  }
  if (settings.rest_energy > 0) {
    guards.push_back({Kind::kCalm, -1, -1, -1});
    if (stance.calm_since) guards.push_back({Kind::kRest, -1, -1, -1});
  }
  return guards;
}

}  // namespace

RolloutGuards::RolloutGuards(std::shared_ptr<const RolloutStance> stance,
                             const RobotRolloutSettings& settings, RolloutDynamics* robot)
    : stance_(std::move(stance)),
      settings_(settings),
      robot_(robot),
      guards_(GuardsOf(*stance_, settings_)) {}

OdeGuard RolloutGuards::Watched(int index) const {
  const RolloutGuard& guard = guards_[index];
  const bool passes = guard.kind == Kind::kTouchdown && stance_->passes[guard.contact];
  const bool rises =
      guard.kind == Kind::kUnjamming || (guard.kind == Kind::kCalm && stance_->calm_since);
  OdeGuard watched{rises ? GuardDirection::kRising : GuardDirection::kFalling, !passes};
  // A patch that carries almost nothing may be selected although it pulls by a rounding error. It
  // would stick to the ground.
  watched.beyond_is_zero = guard.kind == Kind::kTipping && !IsJammed(guard.patch);
  if (guard.kind == Kind::kTouchdown) watched.zero = stance_->slack[guard.contact];
  return watched;
}

bool RolloutGuards::IsJammed(int patch) const {
  const std::vector<int>& points = stance_->patches[patch].points;
  return std::any_of(points.begin(), points.end(), [this](int point) {
    return std::binary_search(stance_->jammed.begin(), stance_->jammed.end(), stance_->held[point]);
  });
}

std::string RolloutGuards::NameOf(int index) const {
  const RolloutGuard& guard = guards_[index];
  switch (guard.kind) {
    case Kind::kTouchdown:
      return fmt::format("touchdown of '{}'", robot_->contact(guard.contact).name);
    case Kind::kTipping:
      return fmt::format("tipping of the patch of '{}'", PatchContact(guard).name);
    case Kind::kUnjamming:
      return fmt::format("release of the jammed '{}'", robot_->contact(guard.contact).name);
    case Kind::kSlip:
      return fmt::format("slip of the patch of '{}'", PatchContact(guard).name);
    case Kind::kCalm:
      return "kinetic energy at its bound";
    case Kind::kRest:
      break;
  }
  return "at rest";
}

std::vector<int> RolloutGuards::Tipping(const RolloutGuard& guard) const {
  const ContactPatchBalance& patch = stance_->patches[guard.patch];
  const VectorXd& levers = patch.edges[guard.edge].levers;
  std::vector<int> tipping;
  for (size_t i = 0; i < patch.points.size(); ++i) {
    if (levers[i] > 0) tipping.push_back(stance_->held[patch.points[i]]);
  }
  return tipping;
}

bool RolloutGuards::ForcesServe(double t, const Eigen::Ref<const VectorXd>& state) const {
  return robot_->IsNearLastAcceleration(t, state, *stance_, kNearby, kNearbySpeed) &&
         std::all_of(guards_.begin(), guards_.end(), [&](const RolloutGuard& guard) {
           if (guard.kind == Kind::kTouchdown) return true;
           if (guard.kind != Kind::kTipping && guard.kind != Kind::kSlip) return false;
           return std::abs(Value(t, state, robot_->forces(), guard)) > kClear * robot_->weight();
         });
}

bool RolloutGuards::GapsServe(double t, const Eigen::Ref<const VectorXd>& state) const {
  return robot_->IsNearLastAcceleration(t, state, *stance_, kNearby, kNearbySpeed) &&
         std::all_of(stance_->free.begin(), stance_->free.end(),
                     [&](int contact) { return std::abs(robot_->Gap(contact)) > kClearGap; });
}

void RolloutGuards::Evaluate(double t, const Eigen::Ref<const VectorXd>& state,
                             Eigen::Ref<VectorXd> values) const {
  Matrix3Xd forces;
  bool gaps_serve = GapsServe(t, state);
  if (ForcesServe(t, state)) {
    forces = robot_->forces();
  } else if (stance_->points.empty()) {
    if (!HasOnlyGaps()) robot_->SetState(state);
  } else {
    robot_->Accelerate(t, state, *stance_, &forces);
    gaps_serve = true;
  }
  for (size_t i = 0; i < guards_.size(); ++i) {
    const RolloutGuard& guard = guards_[i];
    values[i] = guard.kind == Kind::kTouchdown && gaps_serve ? robot_->Gap(guard.contact)
                                                             : Value(t, state, forces, guard);
  }
}

double RolloutGuards::EvaluateOne(double t, const Eigen::Ref<const VectorXd>& state,
                                  int index) const {
  const RolloutGuard& guard = guards_[index];
  Matrix3Xd forces;
  if (guard.kind != Kind::kTouchdown) {
    if (stance_->points.empty()) {
      robot_->SetState(state);
    } else {
      robot_->Accelerate(t, state, *stance_, &forces);
    }
  }
  return Value(t, state, forces, guard);
}

bool RolloutGuards::HasOnlyGaps() const {
  return std::all_of(guards_.begin(), guards_.end(),
                     [](const RolloutGuard& guard) { return guard.kind == Kind::kTouchdown; });
}

double RolloutGuards::Value(double t, const Eigen::Ref<const VectorXd>& state,
                            const Matrix3Xd& forces, const RolloutGuard& guard) const {
  switch (guard.kind) {
    case Kind::kTouchdown:
      return robot_->GapAt(state, guard.contact);
    case Kind::kTipping: {
      const ContactPatchBalance& patch = stance_->patches[guard.patch];
      return patch.Moment(patch.edges[guard.edge], forces);
    }
    case Kind::kUnjamming:
      return robot_->AccelerationIfLetGo(*stance_, guard.contact);
    case Kind::kSlip: {
      const ContactPatchBalance& patch = stance_->patches[guard.patch];
      const Vector3d force = patch.Resultant(forces);
      const double normal = patch.normal_W.dot(force);
      return PatchContact(guard).friction * normal - (force - normal * patch.normal_W).norm();
    }
    case Kind::kCalm:
      return robot_->KineticEnergy(state.tail(robot_->nv())) - settings_.rest_energy;
    case Kind::kRest:
      break;
  }
  return *stance_->calm_since + settings_.rest_time - t;
}

const RolloutContact& RolloutGuards::PatchContact(const RolloutGuard& guard) const {
  return robot_->ContactOf(stance_->patches[guard.patch], stance_->held);
}

}  // namespace possibility::dynamics
