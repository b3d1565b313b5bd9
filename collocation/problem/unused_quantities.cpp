// What a problem names but does not use: forgotten dynamics and the like.
#include "collocation/problem/unused_quantities.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace possibility::collocation {

namespace {

using Quantities = std::vector<Phase::Quantity>;

/// The arguments of all constraints and costs of a problem.
class Arguments {
 public:
  explicit Arguments(const OptimalControlProblem& problem) {
    for (int p = 0; p < problem.num_phases(); ++p) {
      for (const auto& constraint : problem.phase(p).constraints()) Add(constraint.arguments);
      for (const auto& cost : problem.phase(p).costs()) Add(cost.arguments);
      for (const auto& integral : problem.phase(p).integrals()) Add(integral.arguments);
    }
    for (const auto& link : problem.links()) Add(link.arguments);
    for (const auto& cost : problem.costs()) Add(cost.arguments);
  }

  bool Contains(Variable variable) const {
    return std::find(all_.begin(), all_.end(), variable) != all_.end();
  }

 private:
  void Add(const std::vector<Variable>& arguments) {
    all_.insert(all_.end(), arguments.begin(), arguments.end());
  }
  void Add(const std::vector<VariableAt>& arguments) {
    for (const VariableAt& end : arguments) all_.push_back(end.variable);
  }

  std::vector<Variable> all_;
};

/// Whether bounds replace dynamics: the highest derivative is limited, as where it is the control,
/// or the coordinate or a derivative is held. Bounds at an end alone leave the motion free.
bool BoundsGovern(const Quantities& orders) {
  for (const Phase::Quantity& quantity : orders) {
    const bool is_highest = &quantity == &orders.back();
    for (const auto& [at, bounds] : quantity.bounds) {
      if (at == At::kStart || at == At::kEnd) continue;
      const bool is_finite = bounds.lower > -kInfinity || bounds.upper < kInfinity;
      if (bounds.lower == bounds.upper || (is_highest && is_finite)) return true;
    }
  }
  return false;
}

void CheckPhase(const Phase& phase, const Arguments& arguments) {
  for (int i = 0; i < static_cast<int>(phase.coordinates().size()); ++i) {
    const int order = phase.OrderOf(i);
    const Quantities& orders = phase.coordinates()[i];
    if (arguments.Contains(phase.Coordinate(i, order)) || BoundsGovern(orders)) continue;
    phase.Fail(
        fmt::format("no dynamics, constraint or cost contains the derivative of order {} of '{}'",
                    order, orders.front().name));
  }
  for (int i = 0; i < static_cast<int>(phase.controls().size()); ++i) {
    if (arguments.Contains(phase.Control(i))) continue;
    phase.Fail(fmt::format("no dynamics, constraint or cost contains the control '{}'",
                           phase.controls()[i].name));
  }
}

}  // namespace

void CheckEverythingIsUsed(const OptimalControlProblem& problem) {
  const Arguments arguments(problem);
  for (int p = 0; p < problem.num_phases(); ++p) CheckPhase(problem.phase(p), arguments);
  for (int i = 0; i < static_cast<int>(problem.parameters().size()); ++i) {
    if (arguments.Contains(problem.ParameterVariable(i))) continue;
    problem.Fail(fmt::format("no dynamics, constraint or cost contains the parameter '{}'",
                             problem.parameters()[i].name));
  }
}

}  // namespace possibility::collocation
