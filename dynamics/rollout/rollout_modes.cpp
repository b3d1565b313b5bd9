#include "dynamics/rollout/rollout_modes.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <stdexcept>

namespace possibility::dynamics {

/// Changes requested by guards that fired, besides an end of the rollout.
struct RolloutModes::Changes {
  std::vector<int> touched, leaving;           ///< contacts; `leaving` may have repetitions
  std::optional<RolloutStance> same_contacts;  ///< next stance if no contact changes; none: same
};

std::shared_ptr<const HybridMode> RolloutModes::Make(RolloutStance made) {
  const auto stance = std::make_shared<const RolloutStance>(std::move(made));
  const auto guards = std::make_shared<const RolloutGuards>(stance, settings_, robot_);
  auto mode = std::make_shared<HybridMode>();
  mode->name = Describe(stance->held);
  mode->rate = [this, stance](double t, const auto& state, auto rate) {
    const int nq = robot_->nq(), nv = robot_->nv();
    rate.tail(nv) = robot_->Accelerate(t, state, *stance, nullptr);
    rate.head(nq) = robot_->model().ConfigurationRate(state.head(nq), state.tail(nv));
  };
  mode->jacobian = [this, stance](double t, const auto& state, auto jacobian) {
    robot_->DifferentiateRate(t, state, *stance, jacobian);
  };
  mode->positions = robot_->nq();
  for (int i = 0; i < guards->size(); ++i) {
    mode->guards.push_back(guards->Watched(i));
    mode->guard_names.push_back(guards->NameOf(i));
  }
  mode->guard_values = [guards](double t, const auto& state, auto values) {
    guards->Evaluate(t, state, values);
  };
  mode->guard_value = [guards](double t, const auto& state, int guard) {
    return guards->EvaluateOne(t, state, guard);
  };
  const std::weak_ptr<const HybridMode> self = mode;
  mode->reset = [this, self, guards](const HybridEvent& event) {
    return Reset(event, self.lock(), *guards);
  };
  stances_.emplace_back(mode.get(), stance);
  return mode;
}

const RolloutStance& RolloutModes::StanceOf(const HybridSegment& segment) const {
  const auto known = std::find_if(stances_.begin(), stances_.end(), [&](const auto& entry) {
    return entry.first == segment.mode.get();
  });
  if (known == stances_.end()) {
    throw std::invalid_argument("RobotSimulator: MotionAt: this is not the last rollout");
  }
  return *known->second;
}

std::string RolloutModes::Describe(const std::vector<int>& held) const {
  if (held.empty()) return "flight";
  std::string names;
  for (const int i : held) names += (names.empty() ? "" : ", ") + robot_->contact(i).name;
  return names + " held";
}

HybridTransition RolloutModes::Reset(const HybridEvent& event,
                                     const std::shared_ptr<const HybridMode>& mode,
                                     const RolloutGuards& guards) {
  Changes changes = ChangesBy(event, guards);
  std::optional<RolloutStance>& next = changes.same_contacts;
  HybridTransition transition;
  transition.state = event.before;
  const bool contacts_change = !changes.touched.empty() || !changes.leaving.empty();
  if (rollout_->end == RobotRolloutEnd::kTime && contacts_change) {
    robot_->NormaliseOrientation(&transition.state);
    next = events_->Pass(event.time, guards.stance(), changes.touched, changes.leaving,
                         &transition.state);
  }
  if (rollout_->end == RobotRolloutEnd::kTime) {
    transition.mode = next ? Make(std::move(*next)) : mode;
  } else {
    transition.reason = rollout_->reason;
  }
  return transition;
}

RolloutModes::Changes RolloutModes::ChangesBy(const HybridEvent& event,
                                              const RolloutGuards& guards) {
  using Kind = RolloutGuard::Kind;
  const RolloutStance& stance = guards.stance();
  Changes changes;
  const auto same_contacts = [&changes, &stance]() -> RolloutStance& {
    if (!changes.same_contacts) changes.same_contacts = stance;
    return *changes.same_contacts;
  };
  for (const int index : event.guards) {
    const RolloutGuard& guard = guards[index];
    switch (guard.kind) {
      case Kind::kTouchdown:
        if (robot_->Lands(guard.contact, event.before)) changes.touched.push_back(guard.contact);
        break;
      case Kind::kTipping:
        for (const int contact : guards.Tipping(guard)) changes.leaving.push_back(contact);
        break;
      case Kind::kUnjamming:
        changes.leaving.push_back(guard.contact);
        break;
      case Kind::kSlip:
        events_->EndWith(RobotRolloutEnd::kSlip,
                         fmt::format("the patch of '{}' slips", guards.PatchContact(guard).name));
        break;
      case Kind::kCalm:
        same_contacts().calm_since = stance.calm_since ? std::nullopt : std::optional(event.time);
        break;
      case Kind::kRest:
        events_->EndWith(RobotRolloutEnd::kAtRest,
                         fmt::format("kinetic energy below {:.3g} J for {:.3g} s",
                                     settings_.rest_energy, settings_.rest_time));
        break;
    }
  }
  return changes;
}

}  // namespace possibility::dynamics
