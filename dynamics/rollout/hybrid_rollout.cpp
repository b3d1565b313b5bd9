#include "dynamics/rollout/hybrid_rollout.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace possibility::dynamics {

namespace {

void CheckMode(const HybridMode& mode) {
  if (mode.guards.empty()) return;
  if (mode.guard_names.size() != mode.guards.size()) {
    throw std::invalid_argument(fmt::format("RollOut: mode '{}' has {} guards and {} names",
                                            mode.name, mode.guards.size(),
                                            mode.guard_names.size()));
  }
  if (!mode.reset) {
    throw std::invalid_argument(
        fmt::format("RollOut: mode '{}' has guards but no reset", mode.name));
  }
}

class Runner {
 public:
  Runner(std::shared_ptr<const HybridMode> mode, const Eigen::Ref<const Eigen::VectorXd>& state,
         double start_time, double end_time, const HybridSettings& settings)
      : settings_(settings), end_time_(end_time), mode_(std::move(mode)) {
    rollout_.time = start_time;
    rollout_.state = state;
  }

  HybridRollout Run() {
    while (RunSegment()) {
    }
    return std::move(rollout_);
  }

 private:
  /// False once the rollout has ended.
  bool RunSegment() {
    if (!mode_) throw std::invalid_argument("RollOut: no mode");
    CheckMode(*mode_);
    OdeSolution solution = Integrate(Problem(), settings_.integration);
    AddStatistics(solution.statistics);
    rollout_.segments.push_back({mode_, std::move(solution.trajectory)});
    rollout_.time = solution.time;
    rollout_.state = solution.state;
    if (solution.end == OdeEnd::kTime) return End(HybridEnd::kTime, "the time is over");
    if (solution.end == OdeEnd::kCancelled) return End(HybridEnd::kCancelled, "cancelled");
    return PassEvent(solution);
  }

  OdeProblem Problem() const {
    OdeProblem problem;
    problem.rate = mode_->rate;
    problem.start_time = rollout_.time;
    problem.jacobian = mode_->jacobian;
    problem.positions = mode_->positions;
    problem.end_time = end_time_;
    problem.start = rollout_.state;
    problem.guards = mode_->guards;
    problem.guard_values = mode_->guard_values;
    problem.guard_value = mode_->guard_value;
    for (const int guard : watched_) problem.guards[guard].fires_from_zero = false;
    return problem;
  }

  bool PassEvent(const OdeSolution& solution) {
    HybridEvent event;
    event.time = solution.time;
    event.segment = static_cast<int>(rollout_.segments.size()) - 1;
    event.guards = solution.guards;
    event.before = solution.state;
    HybridTransition transition = mode_->reset(event);
    const bool ends = transition.mode == nullptr;
    if (ends && transition.state.size() == 0) transition.state = event.before;
    const bool merely_watched = transition.mode == mode_ && transition.state == event.before;
    watched_ = merely_watched ? event.guards : std::vector<int>();
    event.after = transition.state;
    rollout_.state = std::move(transition.state);
    rollout_.events.push_back(std::move(event));
    if (ends) {
      return End(HybridEnd::kReset, transition.reason.empty() ? LastGuards() : transition.reason);
    }
    if (IsZeno()) return EndAtZeno();
    mode_ = std::move(transition.mode);
    return true;
  }

  bool IsZeno() const {
    const std::vector<HybridEvent>& events = rollout_.events;
    const size_t count = std::max(settings_.zeno_events, 1);
    return events.size() >= count &&
           events.back().time - events[events.size() - count].time <= settings_.zeno_time;
  }

  bool EndAtZeno() {
    const std::string reason =
        fmt::format("{} events within {:.3g} s, the last: {}", settings_.zeno_events,
                    settings_.zeno_time, LastGuards());
    if (settings_.end_at_zeno) return End(HybridEnd::kZeno, reason);
    throw OdeError(fmt::format("rollout gave up at t = {:.9g} s: {}", rollout_.time, reason),
                   rollout_.time, -1);
  }

  std::string LastGuards() const {
    std::string names;
    for (const int guard : rollout_.events.back().guards) {
      if (!names.empty()) names += ", ";
      names += mode_->guard_names[guard];
    }
    return fmt::format("{} in mode '{}'", names, mode_->name);
  }

  bool End(HybridEnd end, std::string reason) {
    rollout_.end = end;
    rollout_.reason = std::move(reason);
    return false;
  }

  void AddStatistics(const OdeStatistics& statistics) {
    rollout_.statistics.steps += statistics.steps;
    rollout_.statistics.rate_evaluations += statistics.rate_evaluations;
    rollout_.statistics.jacobian_evaluations += statistics.jacobian_evaluations;
    rollout_.statistics.guard_evaluations += statistics.guard_evaluations;
    rollout_.statistics.error_test_failures += statistics.error_test_failures;
  }

  const HybridSettings& settings_;
  double end_time_;
  std::shared_ptr<const HybridMode> mode_;
  std::vector<int> watched_;
  HybridRollout rollout_;
};

}  // namespace

const HybridSegment& HybridRollout::SegmentAt(double t) const {
  for (auto segment = segments.rbegin(); segment != segments.rend(); ++segment) {
    if (segment->trajectory.start_time() <= t) return *segment;
  }
  if (segments.empty()) throw std::invalid_argument("HybridRollout: it has no segments");
  return segments.front();
}

Eigen::VectorXd HybridRollout::State(double t) const { return SegmentAt(t).trajectory.State(t); }

HybridRollout RollOut(std::shared_ptr<const HybridMode> mode,
                      const Eigen::Ref<const Eigen::VectorXd>& state, double start_time,
                      double end_time, const HybridSettings& settings) {
  return Runner(std::move(mode), state, start_time, end_time, settings).Run();
}

}  // namespace possibility::dynamics
