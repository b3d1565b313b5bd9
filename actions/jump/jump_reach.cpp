#include "actions/jump/jump_reach.h"

#include <algorithm>
#include <cmath>

namespace possibility::actions {
namespace {

/// Range of a fair jump, in leg lengths.
constexpr double kFairlyShort = 0.5;
constexpr double kFairlyFar = 1.4;

constexpr int kFirstStride = 4;

double GridStep(int steps) { return steps * JumpLibrary::kDistanceStep; }

bool IsPossible(const JumpTask& task, JumpLibrary* library, const CancellationToken& cancellation) {
  const JumpAnswer found = library->FindOrSolve(task, cancellation);
  if (found.cancelled) throw Cancelled();
  return found.jump != nullptr;
}

/// The last possible distance, in grid steps: steps of kFirstStride up to the first impossible
/// distance, then bisection. `shortest` - 1 if none is possible.
int Farthest(int shortest, int guess, int limit, const std::function<bool(int)>& is_possible) {
  int possible = shortest - 1;
  int impossible = limit + 1;
  int next = std::min(guess, limit);
  while (impossible - possible > 1) {
    (is_possible(next) ? possible : impossible) = next;
    const int middle = (possible + impossible) / 2;
    next = impossible > limit ? std::min(possible + kFirstStride, limit) : middle;
  }
  return possible;
}

}  // namespace

JumpReach GuessReach(const JumpSolver& solver, const std::vector<double>& heights) {
  const double leg = solver.model().leg().length / JumpLibrary::kDistanceStep;
  JumpReach reach;
  for (const double height : heights) {
    reach.rows.push_back({height, GridStep(std::max(1, static_cast<int>(kFairlyShort * leg))),
                          GridStep(std::max(1, static_cast<int>(kFairlyFar * leg)))});
  }
  return reach;
}

JumpReach DeriveFarthest(const JumpReach& guess, JumpLibrary* library,
                         const CancellationToken& cancellation) {
  const auto steps = [](double distance) {
    return static_cast<int>(std::floor(distance / JumpLibrary::kDistanceStep + 1e-6));
  };
  JumpReach reach = guess;
  for (JumpReach::Row& row : reach.rows) {
    const auto bounds = library->reach().Distances(row.height);
    const int limit = bounds ? steps(bounds->second) : 0;
    row.farthest =
        GridStep(Farthest(steps(row.shortest), steps(row.farthest), limit, [&](int distance) {
          return IsPossible({GridStep(distance), row.height}, library, cancellation);
        }));
  }
  return reach;
}

FlightBounds BoundFlight(const JumpSettings& settings, const NaturalUnits& units) {
  // Distance from take-off or touchdown, where the feet reach the ground, whichever is nearer in
  // time.
  const double farthest =
      settings.limits.max_base_speed * JumpProblem::kLongestHalfFlight * units.time();
  return {farthest, farthest};
}

}  // namespace possibility::actions
