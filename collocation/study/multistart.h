#pragma once

#include <map>
#include <string>
#include <vector>

#include "collocation/problem/optimal_control_problem.h"
#include "collocation/study/optimal_control.h"
#include "common/cancellation_token.h"

namespace possibility::collocation {

struct MultistartSettings {
  int starts = 10;  ///< the first is the problem's own guess
  /// How far the other guesses depart from it, in scales of the quantities. Coordinates depart by
  /// waves that vanish at the ends of their phases, with their derivatives.
  double noise = 1;
  unsigned seed = 1;
  /// Motions that differ by less everywhere, in scales of the coordinates, are one extremal.
  double same = 1e-2;
};

/// A solution, and how many starts led to it.
struct Extremal {
  OptimalControlResult result;  ///< of the first of them
  int count = 1;
};

struct MultistartResult {
  std::vector<Extremal> extremals;      ///< the least objective first
  std::map<std::string, int> failures;  ///< messages of the other starts, and their numbers
  bool cancelled = false;               ///< starts are missing
};

/// Solves a problem from several guesses and tells its solutions apart by their motions: mirror
/// images have one objective. Depends on the seed alone. With options.second_order_check, each
/// result says whether it is a minimum.
/// @throws std::invalid_argument as SolveOptimalControl does, or if a setting is not positive
/// (noise may be 0).
MultistartResult SolveFromManyStarts(const OptimalControlProblem& problem,
                                     const OptimalControlOptions& options = {},
                                     const MultistartSettings& settings = {},
                                     const CancellationToken& cancellation = {});

/// A line for each extremal and for each failure: "12.0001: 7 starts, a minimum".
std::string Summary(const MultistartResult& result);

}  // namespace possibility::collocation
