#include "collocation/study/stored_solution.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace possibility::collocation {
namespace {

/// Throws for the first name that is not the same in both lists.
void Compare(const std::string& where, const char* what, const std::vector<std::string>& expected,
             const std::vector<std::string>& found) {
  for (std::size_t i = 0; i < std::max(expected.size(), found.size()); ++i) {
    const auto quoted = [i](const std::vector<std::string>& names) {
      return i < names.size() ? fmt::format("'{}'", names[i]) : std::string("none");
    };
    if (i < expected.size() && i < found.size() && expected[i] == found[i]) continue;
    throw std::invalid_argument(fmt::format("{}: {} {} of the stored solution is {}, expected {}",
                                            where, what, i, quoted(found), quoted(expected)));
  }
}

}  // namespace

std::vector<Mesh> StoredSolution::Meshes() const {
  std::vector<Mesh> meshes;
  for (const PhaseTrajectory& phase : trajectory.phases) meshes.push_back(phase.mesh);
  return meshes;
}

void CheckSameQuantities(const OptimalControlProblem& problem, const StoredSolution& solution) {
  std::vector<std::string> expected, found;
  for (int p = 0; p < problem.num_phases(); ++p) expected.push_back(problem.phase(p).name());
  for (const PhaseNames& names : solution.phases) found.push_back(names.phase);
  Compare(problem.name(), "phase", expected, found);
  Compare(problem.name(), "parameter", problem.ParameterNames(), solution.parameters);
  for (int p = 0; p < problem.num_phases(); ++p) {
    const PhaseNames names = problem.phase(p).Names();
    const PhaseNames& stored = solution.phases[p];
    const std::string where = fmt::format("{}: phase '{}'", problem.name(), names.phase);
    if (names.order != stored.order) {
      throw std::invalid_argument(fmt::format("{}: the stored solution is of order {}, expected {}",
                                              where, stored.order, names.order));
    }
    Compare(where, "coordinate", names.coordinates, stored.coordinates);
    Compare(where, "control", names.controls, stored.controls);
    for (std::size_t i = 0; i < names.coordinates.size(); ++i) {
      const auto order = [i](const PhaseNames& of) {
        return of.orders.empty() ? of.order : of.orders[i];
      };
      if (order(names) == order(stored)) continue;
      throw std::invalid_argument(
          fmt::format("{}: '{}' of the stored solution is of order {}, expected {}", where,
                      names.coordinates[i], order(stored), order(names)));
    }
  }
}

bool HasSameQuantities(const OptimalControlProblem& problem, const StoredSolution& solution) {
  try {
    CheckSameQuantities(problem, solution);
    return true;
  } catch (const std::invalid_argument&) {
    return false;
  }
}

}  // namespace possibility::collocation
