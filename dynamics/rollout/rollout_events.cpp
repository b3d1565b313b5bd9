#include "dynamics/rollout/rollout_events.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "dynamics/contact/bearing_points.h"

namespace possibility::dynamics {

namespace {

using Eigen::Matrix3Xd;
using Eigen::VectorXd;

// m/s: slower points rest on the ground instead of hitting it.
constexpr double kAtRest = 1e-7;

bool Contains(const std::vector<int>& indices, int index) {
  return std::binary_search(indices.begin(), indices.end(), index);
}

std::vector<int> Without(const std::vector<int>& indices, const std::vector<int>& removed) {
  std::vector<int> rest;
  std::set_difference(indices.begin(), indices.end(), removed.begin(), removed.end(),
                      std::back_inserter(rest));
  return rest;
}

std::vector<int> Picked(const std::vector<int>& indices, const std::vector<int>& picks) {
  std::vector<int> picked;
  picked.reserve(picks.size());
  for (const int pick : picks) picked.push_back(indices[pick]);
  return picked;
}

}  // namespace

RolloutStance RolloutEvents::Start(double time, VectorXd* state) {
  std::vector<int> touching;
  for (int i = 0; i < robot_->num_contacts(); ++i) {
    if (std::abs(robot_->Gap(i)) > settings_.touching) continue;
    if (robot_->Lands(i, *state)) touching.push_back(i);
  }
  RolloutStance stance = PassContactEvent(time, {}, touching, {}, state);
  CheckSlip(time, *state, stance);
  if (IsCalm(*state)) stance.calm_since = time;
  return stance;
}

RolloutStance RolloutEvents::Pass(double time, const RolloutStance& stance,
                                  std::vector<int> touched, std::vector<int> leaving,
                                  VectorXd* state) {
  robot_->SetState(*state);
  for (const int contact : stance.held) {
    if (!touched.empty() && !robot_->Lands(contact, *state)) leaving.push_back(contact);
  }
  std::sort(touched.begin(), touched.end());
  std::sort(leaving.begin(), leaving.end());
  leaving.erase(std::unique(leaving.begin(), leaving.end()), leaving.end());
  RolloutStance next = PassContactEvent(time, stance.held, touched, leaving, state);
  CheckSlip(time, *state, next);
  if (IsCalm(*state)) next.calm_since = stance.calm_since.value_or(time);
  return next;
}

void RolloutEvents::EndWith(RobotRolloutEnd end, std::string reason) {
  if (rollout_->end != RobotRolloutEnd::kTime) return;
  rollout_->end = end;
  rollout_->reason = std::move(reason);
}

/// Applies the impact of what has come down and selects the points that bear. Returns the new
/// stance. `held`: held before; `leaving`: points that do not bear.
RolloutStance RolloutEvents::PassContactEvent(double time, const std::vector<int>& held,
                                              const std::vector<int>& touched,
                                              const std::vector<int>& leaving, VectorXd* state) {
  std::vector<int> touching;
  std::set_union(held.begin(), held.end(), touched.begin(), touched.end(),
                 std::back_inserter(touching));
  if (touching.empty()) return MakeStance({}, {}, {}, *state);
  RobotContactEvent event;
  event.time = time;
  event.touched = touched;
  event.v_before = state->tail(robot_->nv());
  event.impulses.setZero(3, robot_->num_contacts());
  touching = PassImpact(Without(touching, leaving), &event, state);
  const std::vector<int> sinking = SelectHeld(touching, *state, &event);
  event.released = Without(held, event.held);
  event.v_after = state->tail(robot_->nv());
  rollout_->events.push_back(event);
  return MakeStance(event.held, event.jammed, sinking, *state);
}

/// Returns the points that are at rest afterwards.
std::vector<int> RolloutEvents::PassImpact(const std::vector<int>& touching,
                                           RobotContactEvent* event, VectorXd* state) {
  UnilateralContacts contacts = robot_->UnilateralVelocities(touching);
  contacts.staying = settings_.rest_speed;
  if (contacts.unconstrained.size() == 0 ||
      contacts.unconstrained.lpNorm<Eigen::Infinity>() <= kAtRest) {
    return touching;
  }
  std::vector<int> bearing = Picked(touching, SelectBearingPoints(contacts).points);
  const Impact& impact = robot_->Hit(bearing);
  event->energy_lost = impact.energy_lost;
  for (size_t i = 0; i < bearing.size(); ++i) {
    event->impulses.col(bearing[i]) = impact.impulses.col(i);
  }
  RecordFriction(bearing, impact, event);
  state->tail(robot_->nv()) = impact.velocity;
  robot_->SetState(*state);
  return bearing;
}

void RolloutEvents::RecordFriction(const std::vector<int>& bearing, const Impact& impact,
                                   RobotContactEvent* event) {
  for (const ContactPatchBalance& patch : robot_->PatchesOf(bearing)) {
    const RolloutContact& contact = robot_->ContactOf(patch, bearing);
    const double utilisation = patch.FrictionUtilisation(impact.impulses, contact.friction);
    event->friction_utilisation = std::max(event->friction_utilisation, utilisation);
    if (utilisation <= 1 || !settings_.ends_at_slip) continue;
    EndWith(RobotRolloutEnd::kSlip,
            fmt::format("'{}' slips when it hits the ground: {:.3g} of its friction is needed",
                        contact.name, utilisation));
  }
}

std::vector<int> RolloutEvents::SelectHeld(std::vector<int> touching, const VectorXd& state,
                                           RobotContactEvent* event) {
  std::vector<int> sinking;
  while (!touching.empty()) {
    const BearingSelection bearing =
        SelectBearingPoints(robot_->UnilateralAccelerations(event->time, state, touching));
    event->held = Picked(touching, bearing.points);
    event->jammed = Picked(touching, bearing.jammed);
    std::vector<int> yielding;
    std::copy_if(event->jammed.begin(), event->jammed.end(), std::back_inserter(yielding),
                 [this](int contact) { return MaySink(contact); });
    if (yielding.empty()) break;
    touching = Without(touching, yielding);
    sinking.insert(sinking.end(), yielding.begin(), yielding.end());
    event->held.clear();
    event->jammed.clear();
  }
  std::sort(sinking.begin(), sinking.end());
  return sinking;
}

bool RolloutEvents::MaySink(int contact) {
  return settings_.jam_depth > 0 && robot_->Gap(contact) > kContactSlack - settings_.jam_depth;
}

RolloutStance RolloutEvents::MakeStance(const std::vector<int>& held,
                                        const std::vector<int>& jammed,
                                        const std::vector<int>& sinking, const VectorXd& state) {
  RolloutStance stance;
  stance.held = held;
  stance.jammed = jammed;
  stance.has_landed = !rollout_->events.empty();
  stance.points = robot_->HeldWhereTheyAre(held);
  stance.patches = robot_->PatchesOf(held);
  stance.slack.assign(robot_->num_contacts(), 0.0);
  stance.passes.assign(robot_->num_contacts(), false);
  for (int i = 0; i < robot_->num_contacts(); ++i) {
    if (Contains(held, i)) continue;
    stance.free.push_back(i);
    const double gap = robot_->Gap(i);
    // A point far below its plane has passed it beside the ground.
    stance.passes[i] = robot_->contact(i).lands &&
                       (std::abs(gap) > settings_.touching || !robot_->Lands(i, state));
    if (stance.passes[i] || gap > kContactSlack) continue;
    stance.slack[i] = Contains(sinking, i) ? std::max(settings_.jam_depth, kContactSlack)
                                           : kContactSlack + std::max(0.0, -gap);
  }
  return stance;
}

void RolloutEvents::CheckSlip(double time, const VectorXd& state, const RolloutStance& stance) {
  if (!settings_.ends_at_slip || stance.held.empty()) return;
  Matrix3Xd forces;
  robot_->Accelerate(time, state, stance, &forces);
  for (const ContactPatchBalance& patch : stance.patches) {
    const RolloutContact& contact = robot_->ContactOf(patch, stance.held);
    const double utilisation = patch.FrictionUtilisation(forces, contact.friction);
    if (utilisation <= 1) continue;
    EndWith(RobotRolloutEnd::kSlip,
            fmt::format("the patch of '{}' slips: {:.3g} of its friction is needed", contact.name,
                        utilisation));
  }
}

bool RolloutEvents::IsCalm(const VectorXd& state) {
  return robot_->KineticEnergy(state.tail(robot_->nv())) < settings_.rest_energy;
}

}  // namespace possibility::dynamics
