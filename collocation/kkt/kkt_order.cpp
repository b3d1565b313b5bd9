#include "collocation/kkt/kkt_order.h"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace possibility::collocation {
namespace {

/// For each row, the dual row that it is paired with, or -1.
std::vector<int> PairDualRows(int size, int num_dual, const std::vector<KktEdge>& edges) {
  const int first_dual = size - num_dual;
  const auto for_choices = [&](const auto& use) {  // use(dual row, weight, other row)
    for (const KktEdge& edge : edges) {
      const int dual = std::max(edge.row, edge.column), primal = std::min(edge.row, edge.column);
      if (dual >= first_dual && primal < first_dual && edge.weight > 0) {
        use(dual - first_dual, edge.weight, primal);
      }
    }
  };
  std::vector<int> begin(num_dual + 1, 0);
  for_choices([&](int dual, double, int) { ++begin[dual + 1]; });
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<std::pair<double, int>> choices(begin.back());
  std::vector<int> next(begin.begin(), begin.end() - 1);
  for_choices([&](int dual, double weight, int primal) {
    choices[next[dual]++] = {weight, primal};
  });
  // Rows with the fewest choices choose first.
  std::vector<int> turn(num_dual);
  std::iota(turn.begin(), turn.end(), 0);
  const auto count = [&begin](int dual) { return begin[dual + 1] - begin[dual]; };
  std::stable_sort(turn.begin(), turn.end(), [&](int a, int b) { return count(a) < count(b); });
  std::vector<int> partner(size, -1);
  for (const int dual : turn) {
    std::pair<double, int> best(0, -1);
    for (int k = begin[dual]; k < begin[dual + 1]; ++k) {
      if (partner[choices[k].second] < 0 && choices[k].first > best.first) best = choices[k];
    }
    if (best.second >= 0) partner[best.second] = first_dual + dual;
  }
  return partner;
}

}  // namespace

KktPairs::KktPairs(int size, int num_dual, const std::vector<KktEdge>& edges,
                   const std::vector<double>& times) {
  MakeNodes(size, PairDualRows(size, num_dual, edges));
  Connect(edges);
  if (!times.empty()) {
    RankTimes(times);
    DropFarCouplings();
  }
}

void KktPairs::MakeNodes(int size, const std::vector<int>& partner) {
  std::vector<bool> is_second(size, false);
  for (const int second : partner) {
    if (second >= 0) is_second[second] = true;
  }
  node_of_.assign(size, -1);
  for (int row = 0; row < size; ++row) {
    if (is_second[row]) continue;
    node_of_[row] = static_cast<int>(nodes_.size());
    if (partner[row] >= 0) node_of_[partner[row]] = node_of_[row];
    nodes_.push_back({row, partner[row]});
  }
}

void KktPairs::Connect(const std::vector<KktEdge>& edges) {
  connections_.reserve(edges.size());
  for (const KktEdge& edge : edges) {
    const auto [low, high] = std::minmax(node_of_[edge.row], node_of_[edge.column]);
    if (low != high) connections_.emplace_back(low, high);
  }
}

void KktPairs::RankTimes(const std::vector<double>& times) {
  std::vector<double> instants;
  for (const Node& node : nodes_) {
    if (!std::isnan(times[node.row])) instants.push_back(times[node.row]);
  }
  std::sort(instants.begin(), instants.end());
  instants.erase(std::unique(instants.begin(), instants.end()), instants.end());
  num_instants_ = static_cast<int>(instants.size());
  for (Node& node : nodes_) {
    if (std::isnan(times[node.row])) continue;
    const auto place = std::lower_bound(instants.begin(), instants.end(), times[node.row]);
    node.instant = static_cast<int>(place - instants.begin());
  }
}

/// Couplings of distant instants, such as those of a periodic motion, would pass over all
/// separators. One of their two ends is treated as a node without a time.
void KktPairs::DropFarCouplings() {
  const int farthest = std::max(4, num_instants_ / 4);
  for (const auto& [a, b] : connections_) {
    const int first = nodes_[a].instant;
    const int second = nodes_[b].instant;
    if (first < 0 || second < 0 || std::abs(first - second) <= farthest) continue;
    nodes_[first < second ? a : b].instant = -1;
  }
}

/// By instant: whether no coupling passes over it.
std::vector<bool> KktPairs::SeparatingInstants() const {
  std::vector<int> changes(num_instants_ + 1, 0);
  for (const auto& [a, b] : connections_) {
    const auto [first, last] = std::minmax(nodes_[a].instant, nodes_[b].instant);
    if (first < 0 || last - first < 2) continue;
    ++changes[first + 1];
    --changes[last];
  }
  std::vector<bool> separating(num_instants_);
  int passing = 0;
  for (int instant = 0; instant < num_instants_; ++instant) {
    passing += changes[instant];
    separating[instant] = passing == 0;
  }
  return separating;
}

/// By node: whether it belongs to a separator, the smaller of two sets: the nodes of a separating
/// instant that couple with later ones, or those that couple with earlier ones.
std::vector<bool> KktPairs::SeparatingNodes() const {
  std::vector<bool> with_later(nodes_.size(), false), with_earlier(nodes_.size(), false);
  for (const auto& [a, b] : connections_) {
    if (nodes_[a].instant < 0 || nodes_[b].instant < 0) continue;
    if (nodes_[a].instant == nodes_[b].instant) continue;
    const bool a_is_first = nodes_[a].instant < nodes_[b].instant;
    with_later[a_is_first ? a : b] = true;
    with_earlier[a_is_first ? b : a] = true;
  }
  std::vector<int> excess(num_instants_, 0);  // of nodes that couple with later ones
  for (std::size_t node = 0; node < nodes_.size(); ++node) {
    if (nodes_[node].instant < 0) continue;
    excess[nodes_[node].instant] += (with_later[node] ? 1 : 0) - (with_earlier[node] ? 1 : 0);
  }
  const std::vector<bool> separating = SeparatingInstants();
  std::vector<bool> result(nodes_.size(), false);
  for (std::size_t node = 0; node < nodes_.size(); ++node) {
    const int instant = nodes_[node].instant;
    if (instant < 0 || !separating[instant]) continue;
    result[node] = excess[instant] <= 0 ? with_later[node] : with_earlier[node];
  }
  return result;
}

/// These nodes, by approximate minimum degree in the graph of them alone.
std::vector<int> KktPairs::DegreeOrder(const std::vector<int>& nodes) const {
  std::vector<int> index(nodes_.size(), -1);
  for (std::size_t k = 0; k < nodes.size(); ++k) index[nodes[k]] = static_cast<int>(k);
  std::vector<Eigen::Triplet<char>> places;  // of the lower triangle
  places.reserve(connections_.size() + nodes.size());
  for (const auto& [low, high] : connections_) {
    if (index[low] >= 0 && index[high] >= 0) places.emplace_back(index[high], index[low], 1);
  }
  const int size = static_cast<int>(nodes.size());
  // Eigen's AMD takes a node without a diagonal entry for a dense one.
  for (int k = 0; k < size; ++k) places.emplace_back(k, k, 1);
  Eigen::SparseMatrix<char> graph(size, size);
  graph.setFromTriplets(places.begin(), places.end(), [](char, char) -> char { return 1; });
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
  Eigen::AMDOrdering<int>()(graph.selfadjointView<Eigen::Lower>(), order);
  std::vector<int> result(size);
  for (int k = 0; k < size; ++k) result[k] = nodes[order.indices()[k]];
  return result;
}

std::vector<int> KktPairs::RowsOf(const std::vector<int>& nodes) const {
  std::vector<int> rows;
  rows.reserve(node_of_.size());
  for (const int node : nodes) {
    rows.push_back(nodes_[node].row);
    if (nodes_[node].partner >= 0) rows.push_back(nodes_[node].partner);
  }
  return rows;
}

std::vector<int> KktPairs::OrderByDegree() const {
  std::vector<int> all(nodes_.size());
  std::iota(all.begin(), all.end(), 0);
  return RowsOf(DegreeOrder(all));
}

std::optional<std::vector<int>> KktPairs::OrderByTime() const {
  if (num_instants_ == 0) return std::nullopt;
  // A counting sort; nodes without a time come last.
  const auto bin = [this](const Node& node) {
    return node.instant < 0 ? num_instants_ : node.instant;
  };
  std::vector<int> next(num_instants_ + 2, 0);
  for (const Node& node : nodes_) ++next[bin(node) + 1];
  std::partial_sum(next.begin(), next.end(), next.begin());
  std::vector<int> order(nodes_.size());
  for (std::size_t node = 0; node < nodes_.size(); ++node) {
    order[next[bin(nodes_[node])]++] = static_cast<int>(node);
  }
  return RowsOf(order);
}

std::optional<std::vector<int>> KktPairs::OrderAlongTime() const {
  if (num_instants_ == 0) return std::nullopt;
  const std::vector<bool> separates = SeparatingNodes();
  std::vector<int> between, separators, timeless;
  for (int node = 0; node < static_cast<int>(nodes_.size()); ++node) {
    const bool has_time = nodes_[node].instant >= 0;
    (!has_time ? timeless : separates[node] ? separators : between).push_back(node);
  }
  if (separators.empty()) return std::nullopt;
  std::stable_sort(separators.begin(), separators.end(),
                   [this](int a, int b) { return nodes_[a].instant < nodes_[b].instant; });
  std::vector<int> order = DegreeOrder(between);
  order.insert(order.end(), separators.begin(), separators.end());
  order.insert(order.end(), timeless.begin(), timeless.end());
  return RowsOf(order);
}

}  // namespace possibility::collocation
