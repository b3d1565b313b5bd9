#include "dynamics/ode/ode_guard_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

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
      values_(problem.guards.size()) {
  if (problem.guards.empty()) return;
  Evaluate(problem.start_time, problem.start, &values_);
  for (int i = 0; i < static_cast<int>(values_.size()); ++i) {
    const double side = Sign(values_[i]);
    const bool is_beyond = problem.guards[i].beyond_is_zero && !Watched(i, side);
    sides_.push_back(std::abs(values_[i]) <= settings.guard_zero || is_beyond ? 0 : side);
  }
}

void GuardSearch::Evaluate(double time, const Eigen::VectorXd& state, Eigen::VectorXd* values) {
  ++evaluations_;
  problem_.guard_values(time, state, *values);
  for (int i = 0; i < static_cast<int>(values->size()); ++i) RequireFinite((*values)[i], i, time);
}

double GuardSearch::ValueAt(const OdeTrajectory& trajectory, double time, int guard) {
  if (!problem_.guard_value) {
    Evaluate(time, trajectory.State(time), &values_);
    return values_[guard];
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
                                                           double begin, double end, int guard) {
  const double side = Sign(ValueAt(trajectory, end, guard));
  for (double fraction = 1e-8; fraction < 1; fraction *= 10) {
    const double time = begin + fraction * (end - begin);
    const double value = ValueAt(trajectory, time, guard);
    if (std::abs(value) <= settings_.guard_zero) continue;
    if (Sign(value) != side && Watched(guard, Sign(value))) {
      return Bracket{guard, Sign(value), time, end};
    }
    break;
  }
  const OdeGuard& spec = problem_.guards[guard];
  sides_[guard] = side;
  if (spec.fires_from_zero && spec.direction != GuardDirection::kBoth && Watched(guard, -side)) {
    return Bracket{guard, -side, begin, begin};
  }
  return std::nullopt;
}

std::vector<GuardSearch::Bracket> GuardSearch::Brackets(const OdeTrajectory& trajectory,
                                                        double begin, double end) {
  Evaluate(end, trajectory.State(end), &values_);
  const Eigen::VectorXd values = values_;
  std::vector<Bracket> brackets;
  for (int i = 0; i < static_cast<int>(sides_.size()); ++i) {
    if (sides_[i] == 0) {
      if (std::abs(values[i]) <= settings_.guard_zero) continue;
      if (const auto bracket = LeaveZero(trajectory, begin, end, i)) brackets.push_back(*bracket);
    } else if (sides_[i] * values[i] <= 0) {
      if (Watched(i, sides_[i])) brackets.push_back({i, sides_[i], begin, end});
      if (values[i] != 0) sides_[i] = Sign(values[i]);
    }
  }
  return brackets;
}

/// Illinois' false position (Dowell & Jarratt 1971); every third step bisects.
double GuardSearch::Root(const OdeTrajectory& trajectory, Bracket bracket) {
  double low = bracket.before, high = bracket.after;
  if (low == high) return high;
  double at_low = bracket.side * ValueAt(trajectory, low, bracket.guard);
  double at_high = bracket.side * ValueAt(trajectory, high, bracket.guard);
  // Neighbouring pieces agree only to the local error, so this one may begin beyond zero.
  if (at_low <= 0) return low;
  const double resolution =
      std::max(settings_.guard_resolution, 4 * std::numeric_limits<double>::epsilon() *
                                               std::max(std::abs(low), std::abs(high)));
  bool moved_low = false, moved_high = false;
  for (int iteration = 1; high - low > resolution && at_high != 0; ++iteration) {
    const double share = iteration % 3 == 0 ? 0.5 : at_low / (at_low - at_high);
    const double time =
        std::clamp(low + (high - low) * share, low + resolution / 4, high - resolution / 4);
    if (time <= low || time >= high) break;
    const double value = bracket.side * ValueAt(trajectory, time, bracket.guard);
    if (value > 0) {
      low = time;
      at_low = value;
      if (moved_low) at_high /= 2;
    } else {
      high = time;
      at_high = value;
      if (moved_high) at_low /= 2;
    }
    moved_low = value > 0;
    moved_high = !moved_low;
  }
  return high;
}

double GuardSearch::Spacing() const { return settings_.max_step / settings_.guard_samples; }

bool GuardSearch::IsDue(double time) const {
  // This part of the time since the start.
  constexpr double kShare = 0.125;
  const double soon = kShare * (time - problem_.start_time);
  const double spacing = std::isfinite(settings_.max_step) ? std::min(Spacing(), soon) : 0;
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
    const double from = searched_;
    searched_ = sample == samples ? trajectory.end_time() : begin + length * sample / samples;
    const std::vector<Bracket> brackets = Brackets(trajectory, from, searched_);
    if (brackets.empty()) continue;
    std::vector<double> roots;
    roots.reserve(brackets.size());
    for (const Bracket& bracket : brackets) roots.push_back(Root(trajectory, bracket));
    GuardCrossing crossing;
    crossing.time = *std::min_element(roots.begin(), roots.end());
    for (size_t i = 0; i < roots.size(); ++i) {
      if (roots[i] <= crossing.time + settings_.simultaneous) {
        crossing.guards.push_back(brackets[i].guard);
      }
    }
    return crossing;
  }
  return std::nullopt;
}

}  // namespace possibility::dynamics
