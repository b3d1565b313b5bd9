#include "graph/search/find_path_arguments.h"

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <string>

namespace possibility::graph {
namespace {

[[noreturn]] void Throw(const std::string& complaint) {
  throw std::invalid_argument("FindPath: " + complaint);
}

template <typename Number>
[[noreturn]] void ThrowOutOfRange(const std::string& setting, Number value, const char* expected) {
  Throw(setting + " is " + std::to_string(value) + ", expected " + expected);
}

/// `name`: "the start" or "goal 3".
void CheckPoint(const std::string& name, const Point& point, Eigen::Index size) {
  if (point.size() == size && size > 0 && point.allFinite()) return;
  Throw(name + " has " + std::to_string(point.size()) + " numbers, expected " +
        std::to_string(size) + " finite ones, at least one, as many as the start");
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
    if (!explorer) Throw("an explorer is empty, expected a function that makes one");
  }
}

void CheckSkipGrowth(const std::string& name, double probability,
                     const std::vector<std::shared_ptr<const Action>>& actions) {
  if (std::none_of(actions.begin(), actions.end(),
                   [&](const auto& action) { return action->name() == name; })) {
    Throw("skip_growth names '" + name + "', expected the name of an action");
  }
  if (!(probability >= 0 && probability <= 1)) {
    ThrowOutOfRange("skip_growth of " + name, probability, "a probability");
  }
}

}  // namespace

void CheckFindPathArguments(const Point& start, const std::vector<Point>& goals,
                            const std::vector<std::shared_ptr<const Action>>& actions,
                            const FindPathSettings& settings) {
  if (actions.empty()) Throw("there is no action, expected at least one");
  if (goals.empty()) Throw("there is no goal, expected at least one");
  for (std::size_t i = 0; i < actions.size(); ++i) {
    if (!actions[i]) Throw("action " + std::to_string(i) + " is null, expected an action");
  }
  CheckPoint("the start", start, start.size());
  for (std::size_t i = 0; i < goals.size(); ++i) {
    CheckPoint("goal " + std::to_string(i), goals[i], start.size());
  }
  CheckSettings(settings);
  for (const auto& [name, probability] : settings.skip_growth) {
    CheckSkipGrowth(name, probability, actions);
  }
}

}  // namespace possibility::graph
