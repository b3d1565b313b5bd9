// Conversions to and from a transcription's variables: guesses, trajectories, multipliers.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "collocation/transcription/transcription.h"

namespace possibility::collocation {
namespace {

double Clamped(double value, double lower, double upper) {
  return std::min(std::max(value, lower), upper);
}

using SeriesKey = std::tuple<int, std::string, int>;  // phase, name, output

}  // namespace

double Transcription::GuessOf(const Phase& phase, Variable variable, double share,
                              double duration) const {
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
    if (Holds(at, 0, 3)) intersect(&start, bounds);
    if (Holds(at, 1, 3)) intersect(&everywhere, bounds);
    if (Holds(at, 2, 3)) intersect(&end, bounds);
  }
  const bool start_is_fixed = start.lower == start.upper;
  const bool end_is_fixed = end.lower == end.upper;
  if (start_is_fixed && end_is_fixed) return start.lower + share * (end.lower - start.lower);
  if (start_is_fixed) return start.lower;
  if (end_is_fixed) return end.lower;
  return Clamped(0, everywhere.lower, everywhere.upper);
}

Eigen::VectorXd Transcription::InitialGuess() const {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(num_variables());
  for (std::size_t i = 0; i < parameters_.size(); ++i) {
    x[parameters_[i]] = problem_.parameters_[i].guess;
  }
  for (int p = 0; p < problem_.num_phases(); ++p) {
    const Phase& phase = problem_.phase(p);
    const PhaseLayout& layout = layouts_[p];
    double duration = layout.fixed_duration;
    if (layout.duration >= 0) {
      duration = phase.duration_guess_ ? phase.duration_guess_(0)
                                       : (phase.duration_.lower + phase.duration_.upper) / 2;
      x[layout.duration] = duration;
    }
    for (std::size_t k = 0; k < layout.points.size(); ++k) {
      const double share = layout.points[k].share;
      for (int c = 0; c < static_cast<int>(phase.coordinates_.size()); ++c) {
        for (int order = 0; order <= phase.order(); ++order) {
          const int index = layout.coordinates[k][c][order];
          if (index < 0) continue;
          x[index] = GuessOf(phase, {VariableKind::kCoordinate, p, c, order}, share, duration);
        }
      }
      for (int c = 0; c < static_cast<int>(phase.controls_.size()); ++c) {
        x[layout.controls[k][c]] =
            GuessOf(phase, {VariableKind::kControl, p, c, 0}, share, duration);
      }
    }
  }
  return x.cwiseQuotient(scale_).cwiseMax(lower_).cwiseMin(upper_);
}

void Transcription::CheckFits(const Trajectory& trajectory) const {
  const auto expect = [this](const std::string& where, const char* what, std::ptrdiff_t expected,
                             std::ptrdiff_t found) {
    if (expected == found) return;
    problem_.Fail(fmt::format("{}a guess has {} {}, expected {}", where, found, what, expected));
  };
  expect("", "phases", problem_.num_phases(), std::ssize(trajectory.phases));
  expect("", "parameters", std::ssize(parameters_), trajectory.parameters.size());
  for (int p = 0; p < problem_.num_phases(); ++p) {
    const Phase& phase = problem_.phase(p);
    const PhaseTrajectory& motion = trajectory.phases[p];
    const std::string where = fmt::format("phase '{}': ", phase.name());
    const auto points = (std::ssize(motion.mesh) - 1) * (motion.scheme.num_nodes() - 1) + 1;
    expect(where, "points", points, motion.controls.cols());
    expect(where, "controls", std::ssize(phase.controls_), motion.controls.rows());
    expect(where, "derivatives", phase.order(), std::ssize(motion.coordinates) - 1);
    for (const Eigen::MatrixXd& values : motion.coordinates) {
      expect(where, "points", points, values.cols());
      expect(where, "coordinates", std::ssize(phase.coordinates_), values.rows());
    }
  }
}

Eigen::VectorXd Transcription::GuessFrom(const Trajectory& trajectory) const {
  CheckFits(trajectory);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(num_variables());
  for (std::size_t i = 0; i < parameters_.size(); ++i) {
    x[parameters_[i]] = trajectory.parameters[static_cast<Eigen::Index>(i)];
  }
  for (int p = 0; p < problem_.num_phases(); ++p) {
    const PhaseLayout& layout = layouts_[p];
    const PhaseTrajectory& phase = trajectory.phases[p];
    if (layout.duration >= 0) x[layout.duration] = phase.duration;
    for (std::size_t k = 0; k < layout.points.size(); ++k) {
      const double share = layout.points[k].share;
      for (int order = 0; order <= problem_.phase(p).order(); ++order) {
        const Eigen::VectorXd values = phase.Coordinates(share, order);
        for (std::size_t c = 0; c < layout.coordinates[k].size(); ++c) {
          const int index = layout.coordinates[k][c][order];
          if (index >= 0) x[index] = values[static_cast<Eigen::Index>(c)];
        }
      }
      const Eigen::VectorXd controls = phase.Controls(share);
      for (std::size_t c = 0; c < layout.controls[k].size(); ++c) {
        x[layout.controls[k][c]] = controls[static_cast<Eigen::Index>(c)];
      }
    }
  }
  return x.cwiseQuotient(scale_).cwiseMax(lower_).cwiseMin(upper_);
}

Trajectory Transcription::TrajectoryOf(const Eigen::VectorXd& scaled) const {
  const Eigen::VectorXd x = Scaled(scaled);
  Trajectory trajectory;
  trajectory.parameters.resize(static_cast<Eigen::Index>(parameters_.size()));
  for (std::size_t i = 0; i < parameters_.size(); ++i) {
    trajectory.parameters[static_cast<Eigen::Index>(i)] = x[parameters_[i]];
  }
  double begin = 0;
  for (int p = 0; p < problem_.num_phases(); ++p) {
    const Phase& problem_phase = problem_.phase(p);
    const PhaseLayout& layout = layouts_[p];
    PhaseTrajectory phase;
    phase.begin = begin;
    phase.duration = DurationOf(p, x);
    phase.mesh = layout.mesh;
    phase.scheme = scheme_;
    begin += phase.duration;
    const auto points = static_cast<Eigen::Index>(layout.points.size());
    const auto n = static_cast<Eigen::Index>(problem_phase.coordinates_.size());
    phase.coordinates.assign(problem_phase.order() + 1, Eigen::MatrixXd(n, points));
    phase.controls.resize(static_cast<Eigen::Index>(problem_phase.controls_.size()), points);
    for (int k = 0; k < points; ++k) {
      for (int order = 0; order <= problem_phase.order(); ++order) {
        for (int c = 0; c < n; ++c) {
          phase.coordinates[order](c, k) =
              FormOf({VariableKind::kCoordinate, p, c, order}, p, k).Value(x);
        }
      }
      for (int c = 0; c < phase.controls.rows(); ++c) {
        phase.controls(c, k) = x[layout.controls[k][c]];
      }
    }
    trajectory.phases.push_back(std::move(phase));
  }
  return trajectory;
}

std::vector<MultiplierSeries> Transcription::SeriesOf(const std::vector<PlacedName>& names,
                                                      const std::vector<double>& scales,
                                                      const Eigen::VectorXd& multipliers) {
  std::vector<MultiplierSeries> series;
  std::map<SeriesKey, std::size_t> known;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const PlacedName& name = names[i];
    const auto [entry, is_new] =
        known.try_emplace({name.phase, name.name, name.output}, series.size());
    if (is_new) series.push_back({name.phase, name.name, name.output, {}, {}});
    series[entry->second].points.push_back(name.point);
    series[entry->second].values.push_back(multipliers[static_cast<Eigen::Index>(i)] / scales[i]);
  }
  return series;
}

Multipliers Transcription::MultipliersOf(const SolverResult& solution) const {
  const auto without_zeros = [](std::vector<MultiplierSeries> series) {
    std::erase_if(series, [](const MultiplierSeries& s) {
      return std::all_of(s.values.begin(), s.values.end(), [](double v) { return v == 0; });
    });
    return series;
  };
  return {SeriesOf(row_names_, row_scales_, solution.constraint_multipliers),
          without_zeros(SeriesOf(variable_names_, scales_, solution.lower_multipliers)),
          without_zeros(SeriesOf(variable_names_, scales_, solution.upper_multipliers))};
}

bool Transcription::HasSchemeOf(const Trajectory& trajectory) const {
  const auto is_same = [this](const PhaseTrajectory& phase) {
    return phase.scheme.nodes == scheme_.nodes && phase.scheme.separated == scheme_.separated;
  };
  return std::all_of(trajectory.phases.begin(), trajectory.phases.end(), is_same);
}

std::optional<Eigen::VectorXd> Transcription::Transferred(
    const std::vector<MultiplierSeries>& series, const Trajectory& from,
    const std::vector<PlacedName>& names, const std::vector<double>& scales, bool all) const {
  std::vector<MeshPoints> old_points, points;
  for (std::size_t p = 0; p < layouts_.size(); ++p) {
    old_points.emplace_back(from.phases[p].mesh, scheme_);
    points.emplace_back(layouts_[p].mesh, scheme_);
  }
  std::map<SeriesKey, const MultiplierSeries*> known;
  for (const MultiplierSeries& one : series) known[{one.phase, one.name, one.output}] = &one;
  std::map<SeriesKey, MultiplierInterpolation> interpolations;
  Eigen::VectorXd multipliers = Eigen::VectorXd::Zero(std::ssize(names));
  for (std::size_t i = 0; i < names.size(); ++i) {
    const PlacedName& name = names[i];
    const SeriesKey key{name.phase, name.name, name.output};
    const auto found = known.find(key);
    const bool is_known = found != known.end() && !found->second->values.empty();
    if (!is_known && all) return std::nullopt;
    if (!is_known) continue;
    double value = found->second->values.front();
    if (name.phase >= 0) {
      const auto& interpolation =
          interpolations.try_emplace(key, *found->second, old_points[name.phase], name.is_defect);
      value = interpolation.first->second.At(points[name.phase], name.point);
    }
    multipliers[static_cast<Eigen::Index>(i)] = value * scales[i];
  }
  return multipliers;
}

bool Transcription::AddMultipliers(const Multipliers& multipliers, const Trajectory& trajectory,
                                   SolverGuess* guess) const {
  CheckFits(trajectory);
  if (!HasSchemeOf(trajectory)) return false;
  auto rows = Transferred(multipliers.constraints, trajectory, row_names_, row_scales_, true);
  if (!rows) return false;
  guess->constraint_multipliers = std::move(*rows);
  guess->lower_multipliers =
      *Transferred(multipliers.lower, trajectory, variable_names_, scales_, false);
  guess->upper_multipliers =
      *Transferred(multipliers.upper, trajectory, variable_names_, scales_, false);
  return true;
}

}  // namespace possibility::collocation
