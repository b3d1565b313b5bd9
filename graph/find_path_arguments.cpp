#include "graph/find_path_arguments.h"

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <string>

namespace possibility::graph {
namespace {

bool IsPoint(const Point& point, Eigen::Index size) {
  return point.size() == size && size > 0 && point.allFinite();
}

// Error messages are built out of line: the checks are on the path of answers that take a
// microsecond.

[[noreturn, gnu::cold]] void Throw(const std::string& complaint) {
  throw std::invalid_argument("FindPath: " + complaint);
}

[[noreturn, gnu::cold]] void ThrowMissing(const char* what) {
  Throw(std::string("there is no ") + what + ", expected at least one");
}

template <typename Number>
[[noreturn, gnu::cold]] void ThrowOutOfRange(const char* setting, Number value,
                                             const char* expected) {
  Throw(std::string(setting) + " is " + std::to_string(value) + ", expected " + expected);
}

[[noreturn, gnu::cold]] void ThrowNullAction(std::size_t action) {
  Throw("action " + std::to_string(action) + " is null, expected an action");
}

[[noreturn, gnu::cold]] void ThrowEmptyExplorer() {
  Throw("an explorer is empty, expected a function that makes one");
}

constexpr int kStart = -1;

/// `which`: kStart or the index of a goal.
[[noreturn, gnu::cold]] void ThrowNoPoint(int which, const Point& point, Eigen::Index size) {
  Throw((which == kStart ? "the start" : "goal " + std::to_string(which)) + " has " +
        std::to_string(point.size()) + " numbers, expected " + std::to_string(size) +
        " finite ones, at least one, as many as the start");
}

void CheckSettings(const FindPathSettings& settings) {
  if (!(settings.time_limit >= 0)) {
    ThrowOutOfRange("time_limit", settings.time_limit, "a number of seconds >= 0");
  }
  if (settings.max_transitions_per_cycle < 0) {
    ThrowOutOfRange("max_transitions_per_cycle", settings.max_transitions_per_cycle, ">= 0");
  }
  if (!(settings.confirmation_job_limit > 0)) {
    ThrowOutOfRange("confirmation_job_limit", settings.confirmation_job_limit,
                    "a number of seconds > 0");
  }
  if (settings.confirmation_threads < 0) {
    ThrowOutOfRange("confirmation_threads", settings.confirmation_threads, ">= 0");
  }
  if (!(settings.improvement_share >= 0 && settings.improvement_share <= 1)) {
    ThrowOutOfRange("improvement_share", settings.improvement_share, "a number from 0 to 1");
  }
  for (const ExplorerFactory& explorer : settings.explorers) {
    if (!explorer) ThrowEmptyExplorer();
  }
}

[[gnu::noinline]] void CheckSkipGrowth(const std::string& name, double probability,
                                       const std::vector<std::shared_ptr<const Action>>& actions) {
  if (std::none_of(actions.begin(), actions.end(),
                   [&](const auto& action) { return action->name() == name; })) {
    Throw("skip_growth names '" + name + "', expected the name of an action");
  }
  if (!(probability >= 0 && probability <= 1)) {
    ThrowOutOfRange(("skip_growth of " + name).c_str(), probability, "a probability");
  }
}

}  // namespace

[[gnu::hot]] void CheckFindPathArguments(const Point& start, const std::vector<Point>& goals,
                                         const std::vector<std::shared_ptr<const Action>>& actions,
                                         const FindPathSettings& settings) {
  if (actions.empty()) ThrowMissing("action");
  if (goals.empty()) ThrowMissing("goal");
  for (std::size_t i = 0; i < actions.size(); ++i) {
    if (!actions[i]) ThrowNullAction(i);
  }
  if (!IsPoint(start, start.size())) ThrowNoPoint(kStart, start, start.size());
  for (std::size_t i = 0; i < goals.size(); ++i) {
    if (!IsPoint(goals[i], start.size())) {
      ThrowNoPoint(static_cast<int>(i), goals[i], start.size());
    }
  }
  CheckSettings(settings);
  for (const auto& [name, probability] : settings.skip_growth) {
    CheckSkipGrowth(name, probability, actions);
  }
}

}  // namespace possibility::graph
