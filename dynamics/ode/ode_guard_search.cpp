#include "dynamics/ode/ode_guard_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace possibility::dynamics {

namespace {

void RequireFinite(double value, int guard, double time) {
  if (std::isfinite(value)) return;
  throw OdeError(
      "guard " + std::to_string(guard) + " is not finite at t = " + std::to_string(time) + " s",
      time, -1);
}

double Sign(double value) { return value > 0 ? 1 : value < 0 ? -1 : 0; }

}  // namespace

GuardSearch::GuardSearch(const OdeProblem& problem, const OdeSettings& settings)
    : problem_(problem),
      settings_(settings),
      searched_(problem.start_time),
      values_(problem.guards.size()),
      scratch_(problem.guards.size()) {
  if (problem.guards.empty()) return;
  Evaluate(problem.start_time, problem.start, &values_);
  for (int i = 0; i < static_cast<int>(values_.size()); ++i) {
    const double side = Sign(values_[i]);
    const bool is_beyond = problem.guards[i].beyond_is_zero && !Watched(i, side);
    sides_.push_back(std::abs(values_[i]) <= Zero(i) || is_beyond ? 0 : side);
  }
}

void GuardSearch::Evaluate(double time, const Eigen::VectorXd& state, Eigen::VectorXd* values) {
  ++evaluations_;
  problem_.guard_values(time, state, *values);
  for (int i = 0; i < static_cast<int>(values->size()); ++i) RequireFinite((*values)[i], i, time);
}

double GuardSearch::Zero(int guard) const {
  return std::max(problem_.guards[guard].zero, settings_.guard_zero);
}

double GuardSearch::ValueAt(const OdeTrajectory& trajectory, double time, int guard) {
  if (!problem_.guard_value) {
    Evaluate(time, trajectory.State(time), &scratch_);
    return scratch_[guard];
  }
  ++evaluations_;
  const double value = problem_.guard_value(time, trajectory.State(time), guard);
  RequireFinite(value, guard, time);
  return value;
}

bool GuardSearch::Watched(int guard, double from_side) const {
  switch (problem_.guards[guard].direction) {
    case GuardDirection::kFalling:
      return from_side > 0;
    case GuardDirection::kRising:
      return from_side < 0;
    case GuardDirection::kBoth:
      break;
  }
  return from_side != 0;
}

/// Handles a guard that counted as zero at the start and is not zero at `end`. The side to which it
/// left first tells whether it has crossed since or moved off in the watched direction.
std::optional<GuardSearch::Bracket> GuardSearch::LeaveZero(const OdeTrajectory& trajectory,
                                                           RootPoint begin, RootPoint end,
                                                           int guard) {
  const double side = Sign(end.value);
  for (double fraction = 1e-8; fraction < 1; fraction *= 10) {
    const double time = begin.at + fraction * (end.at - begin.at);
    const double value = ValueAt(trajectory, time, guard);
    if (std::abs(value) <= Zero(guard)) continue;
    if (Sign(value) != side && Watched(guard, Sign(value))) {
      return Bracket{guard, {time, value}, end, 0};
    }
    break;
  }
  const OdeGuard& spec = problem_.guards[guard];
  sides_[guard] = side;
  if (spec.fires_from_zero && spec.direction != GuardDirection::kBoth && Watched(guard, -side)) {
    if (const double level = side * spec.zero; spec.zero > settings_.guard_zero) {
      return Bracket{guard, {begin.at, begin.value - level}, {end.at, end.value - level}, level};
    }
    return Bracket{guard, {begin.at, -side}, {begin.at, side}, 0};
  }
  return std::nullopt;
}

std::vector<GuardSearch::Bracket> GuardSearch::Brackets(const OdeTrajectory& trajectory,
                                                        double end) {
  const double begin = std::exchange(searched_, end);
  const Eigen::VectorXd before = values_;
  Evaluate(end, trajectory.State(end), &values_);
  std::vector<Bracket> brackets;
  for (int i = 0; i < static_cast<int>(sides_.size()); ++i) {
    const RootPoint after{end, values_[i]};
    if (sides_[i] == 0) {
      if (std::abs(after.value) <= Zero(i)) continue;
      if (const auto bracket = LeaveZero(trajectory, {begin, before[i]}, after, i)) {
        brackets.push_back(*bracket);
      }
    } else if (sides_[i] * after.value <= 0) {
      if (Watched(i, sides_[i])) brackets.push_back({i, {begin, before[i]}, after, 0});
      if (after.value != 0) sides_[i] = Sign(after.value);
    }
  }
  return brackets;
}

double GuardSearch::Above(const OdeTrajectory& trajectory, double time, const Bracket& bracket) {
  return ValueAt(trajectory, time, bracket.guard) - bracket.level;
}

double GuardSearch::Root(const OdeTrajectory& trajectory, const Bracket& bracket) {
  const double rounding = 4 * std::numeric_limits<double>::epsilon() *
                          std::max(std::abs(bracket.before.at), std::abs(bracket.after.at));
  return BracketedRoot(bracket.before, bracket.after,
                       std::max(settings_.guard_resolution, rounding),
                       [&](double time) { return Above(trajectory, time, bracket); });
}

GuardCrossing GuardSearch::FirstCrossing(const OdeTrajectory& trajectory,
                                         const std::vector<Bracket>& brackets) {
  std::vector<std::pair<double, int>> roots;  // with the guard
  GuardCrossing crossing{std::numeric_limits<double>::infinity(), {}};
  for (Bracket bracket : brackets) {
    const double latest = crossing.time + settings_.simultaneous;
    if (latest < bracket.after.at) {
      // Most guards cross later than another one; their roots are not needed.
      if (latest <= bracket.before.at) continue;
      bracket.after = {latest, Above(trajectory, latest, bracket)};
      if (bracket.after.value * bracket.before.value > 0) continue;
    }
    roots.emplace_back(Root(trajectory, bracket), bracket.guard);
    crossing.time = std::min(crossing.time, roots.back().first);
  }
  for (const auto& [time, guard] : roots) {
    if (time <= crossing.time + settings_.simultaneous) crossing.guards.push_back(guard);
  }
  return crossing;
}

double GuardSearch::Spacing() const { return settings_.max_step / settings_.guard_samples; }

bool GuardSearch::IsDue(double time) const {
  // This part of the time since the start.
  constexpr double kShare = 0.5;
  const double soon = kShare * (time - problem_.start_time);
  const double spacing = std::isfinite(settings_.max_step) ? std::min(Spacing() / 2, soon) : 0;
  return time - searched_ >= spacing;
}

std::optional<GuardCrossing> GuardSearch::Search(const OdeTrajectory& trajectory) {
  if (problem_.guards.empty()) return std::nullopt;
  const double begin = searched_;
  const double length = trajectory.end_time() - begin;
  const int samples = std::isfinite(settings_.max_step)
                          ? std::max(1, static_cast<int>(std::ceil(length / Spacing())))
                          : settings_.guard_samples;
  for (int sample = 1; sample <= samples; ++sample) {
    const double end =
        sample == samples ? trajectory.end_time() : begin + length * sample / samples;
    const std::vector<Bracket> brackets = Brackets(trajectory, end);
    if (!brackets.empty()) return FirstCrossing(trajectory, brackets);
  }
  return std::nullopt;
}

}  // namespace possibility::dynamics
