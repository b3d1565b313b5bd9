#include "collocation/transcription/multipliers.h"

#include <algorithm>

namespace possibility::collocation {

MeshPoints::MeshPoints(const std::vector<double>& mesh, const TranscriptionScheme& scheme)
    : per_interval(scheme.num_nodes() - 1) {
  const std::size_t intervals = mesh.size() - 1;
  const Eigen::VectorXd node_weights = scheme.weights();
  weights.assign(intervals * per_interval + 1, 0);
  for (std::size_t i = 0; i < intervals; ++i) {
    const double length = mesh[i + 1] - mesh[i];
    for (int node = 0; node <= per_interval; ++node) {
      if (node < per_interval) shares.push_back(mesh[i] + scheme.nodes[node] * length);
      weights[i * per_interval + node] += length * node_weights[node];
    }
  }
  shares.push_back(mesh.back());
}

MultiplierInterpolation::MultiplierInterpolation(const MultiplierSeries& series,
                                                 const MeshPoints& from, bool is_defect)
    : is_defect_(is_defect),
      is_single_(series.points.size() == 1),
      by_node_(is_single_ ? 1 : from.per_interval) {
  for (std::size_t i = 0; i < series.points.size(); ++i) {
    const int point = series.points[i];
    const int node = is_single_ ? 0 : point % from.per_interval;
    by_node_[node].shares.push_back(from.shares[point]);
    const double weight = from.weights[point];
    by_node_[node].values.push_back(IsDensity(node, weight) ? series.values[i] / weight
                                                            : series.values[i]);
  }
}

double MultiplierInterpolation::At(const MeshPoints& to, int point) const {
  const int node = is_single_ ? 0 : point % to.per_interval;
  const auto& [shares, values] = by_node_[node];
  if (shares.empty()) return 0;
  const double share = to.shares[point];
  const auto after = static_cast<std::size_t>(
      std::lower_bound(shares.begin(), shares.end(), share) - shares.begin());
  double value = values[std::min(after, values.size() - 1)];
  if (after > 0 && after < shares.size()) {
    const double weight = (share - shares[after - 1]) / (shares[after] - shares[after - 1]);
    value = weight * value + (1 - weight) * values[after - 1];
  }
  return IsDensity(node, to.weights[point]) ? value * to.weights[point] : value;
}

}  // namespace possibility::collocation
