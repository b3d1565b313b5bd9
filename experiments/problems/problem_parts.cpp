#include "experiments/problems/problem_parts.h"

namespace possibility::experiments {

void FixAll(collocation::Phase& phase, collocation::At end,
            std::initializer_list<std::pair<collocation::Variable, double>> values) {
  for (const auto& [variable, value] : values) phase.Fix(variable, value, end);
}

void MinimiseDuration(collocation::OptimalControlProblem& problem, collocation::Phase& phase,
                      collocation::Bounds bounds) {
  phase.SetDuration(bounds);
  problem.AddCost({phase.duration(), collocation::At::kEnd});
}

std::vector<KnownOptimum> OneOptimum(double objective, double tolerance) {
  return {{"global", objective, tolerance}};
}

}  // namespace possibility::experiments
