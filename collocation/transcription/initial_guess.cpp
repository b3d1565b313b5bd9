#include "collocation/transcription/initial_guess.h"

#include <algorithm>

namespace possibility::collocation {
namespace {

double Clamped(double value, double lower, double upper) {
  return std::min(std::max(value, lower), upper);
}

double GuessOf(const Phase& phase, Variable variable, double share, double duration) {
  const Phase::Quantity& quantity = phase.Find(variable);
  if (quantity.guess) return quantity.guess(share);
  if (variable.kind == VariableKind::kCoordinate && variable.order > 0) {
    // The slope of the guess one order below.
    Variable below = variable;
    --below.order;
    constexpr double kStep = 1e-4;
    const double before = std::max(0.0, share - kStep);
    const double after = std::min(1.0, share + kStep);
    return (GuessOf(phase, below, after, duration) - GuessOf(phase, below, before, duration)) /
           ((after - before) * duration);
  }
  Bounds start, end, everywhere;
  const auto intersect = [](Bounds* bounds, const Bounds& with) {
    bounds->lower = std::max(bounds->lower, with.lower);
    bounds->upper = std::min(bounds->upper, with.upper);
  };
  for (const auto& [at, bounds] : quantity.bounds) {
    if (HoldsAt(at, 0, 3)) intersect(&start, bounds);
    if (HoldsAt(at, 1, 3)) intersect(&everywhere, bounds);
    if (HoldsAt(at, 2, 3)) intersect(&end, bounds);
  }
  const bool start_is_fixed = start.lower == start.upper;
  const bool end_is_fixed = end.lower == end.upper;
  if (start_is_fixed && end_is_fixed) return start.lower + share * (end.lower - start.lower);
  if (start_is_fixed) return start.lower;
  if (end_is_fixed) return end.lower;
  return Clamped(0, everywhere.lower, everywhere.upper);
}

}  // namespace

Eigen::VectorXd InitialGuess(const VariableLayout& layout) {
  const OptimalControlProblem& problem = layout.problem();
  Eigen::VectorXd x = Eigen::VectorXd::Zero(layout.num_variables());
  for (std::size_t i = 0; i < layout.parameters().size(); ++i) {
    x[layout.parameters()[i]] = problem.parameters()[i].guess;
  }
  for (int p = 0; p < problem.num_phases(); ++p) {
    const Phase& phase = problem.phase(p);
    const PhaseLayout& phase_layout = layout.phase(p);
    double duration = phase_layout.fixed_duration;
    if (phase_layout.duration >= 0) {
      duration = phase.duration_guess()
                     ? phase.duration_guess()(0)
                     : (phase.duration_bounds().lower + phase.duration_bounds().upper) / 2;
      x[phase_layout.duration] = duration;
    }
    for (std::size_t k = 0; k < phase_layout.points.size(); ++k) {
      const double share = phase_layout.points[k].share;
      for (int c = 0; c < static_cast<int>(phase.coordinates().size()); ++c) {
        for (int order = 0; order <= phase.OrderOf(c); ++order) {
          const int index = phase_layout.coordinates[k][c][order];
          if (index < 0) continue;
          x[index] = GuessOf(phase, phase.Coordinate(c, order), share, duration);
        }
      }
      for (int c = 0; c < static_cast<int>(phase.controls().size()); ++c) {
        const int index = phase_layout.controls[k][c];
        if (index >= 0) x[index] = GuessOf(phase, phase.Control(c), share, duration);
      }
    }
  }
  return layout.ScaledWithinBounds(x);
}

}  // namespace possibility::collocation
