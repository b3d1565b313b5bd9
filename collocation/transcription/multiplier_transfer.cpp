#include "collocation/transcription/multiplier_transfer.h"

#include <algorithm>
#include <map>
#include <string>
#include <tuple>

namespace possibility::collocation {
namespace {

using SeriesKey = std::tuple<int, std::string, int>;  // phase, name, output

}  // namespace

std::vector<MultiplierSeries> SeriesOf(const std::vector<PlacedName>& names,
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

bool HasScheme(const Trajectory& trajectory, const TranscriptionScheme& scheme) {
  const auto is_same = [&](const PhaseTrajectory& phase) {
    return phase.scheme.nodes == scheme.nodes && phase.scheme.separated == scheme.separated &&
           phase.scheme.value_at_start == scheme.value_at_start &&
           phase.scheme.value_at_end == scheme.value_at_end;
  };
  return std::all_of(trajectory.phases.begin(), trajectory.phases.end(), is_same);
}

std::optional<Eigen::VectorXd> Transferred(const std::vector<MultiplierSeries>& series,
                                           const Trajectory& from, const VariableLayout& layout,
                                           const std::vector<PlacedName>& names,
                                           const std::vector<double>& scales, bool all) {
  std::vector<MeshPoints> old_points, points;
  for (std::size_t p = 0; p < from.phases.size(); ++p) {
    old_points.emplace_back(from.phases[p].mesh, layout.scheme());
    points.emplace_back(layout.phase(static_cast<int>(p)).mesh, layout.scheme());
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

}  // namespace possibility::collocation
