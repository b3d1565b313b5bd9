#include "collocation/kkt/kkt_analysis.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "collocation/kkt/kkt_order.h"

namespace possibility::collocation {
namespace {

/// Neighbours of every row, compressed.
struct Graph {
  std::vector<int> begin;
  std::vector<int> neighbour;
};

Graph MakeGraph(int size, const std::vector<KktEdge>& edges, const std::vector<int>& label) {
  Graph graph;
  graph.begin.assign(size + 1, 0);
  for (const KktEdge& edge : edges) {
    ++graph.begin[label[edge.row] + 1];
    ++graph.begin[label[edge.column] + 1];
  }
  std::partial_sum(graph.begin.begin(), graph.begin.end(), graph.begin.begin());
  graph.neighbour.resize(2 * edges.size());
  std::vector<int> next(graph.begin.begin(), graph.begin.end() - 1);
  for (const KktEdge& edge : edges) {
    graph.neighbour[next[label[edge.row]]++] = label[edge.column];
    graph.neighbour[next[label[edge.column]]++] = label[edge.row];
  }
  return graph;
}

/// Parent of each position in the elimination tree, or -1 (Liu 1990, with path compression).
std::vector<int> EliminationTree(const Graph& graph) {
  const int size = static_cast<int>(graph.begin.size()) - 1;
  std::vector<int> parent(size, -1), ancestor(size, -1);
  for (int j = 0; j < size; ++j) {
    for (int e = graph.begin[j]; e < graph.begin[j + 1]; ++e) {
      for (int i = graph.neighbour[e]; i >= 0 && i < j;) {
        const int next = ancestor[i];
        ancestor[i] = j;
        if (next < 0) parent[i] = j;
        i = next;
      }
    }
  }
  return parent;
}

/// Nodes of a forest, children before parents and each subtree contiguous.
std::vector<int> Postorder(const std::vector<int>& parent) {
  const int size = static_cast<int>(parent.size());
  std::vector<int> first_child(size, -1), sibling(size, -1), stack, order;
  for (int j = size - 1; j >= 0; --j) {
    if (parent[j] < 0) continue;
    sibling[j] = first_child[parent[j]];
    first_child[parent[j]] = j;
  }
  order.reserve(size);
  for (int root = 0; root < size; ++root) {
    if (parent[root] >= 0) continue;
    stack.push_back(root);
    while (!stack.empty()) {
      const int j = stack.back();
      if (first_child[j] >= 0) {
        stack.push_back(first_child[j]);
        first_child[j] = sibling[first_child[j]];
      } else {
        stack.pop_back();
        order.push_back(j);
      }
    }
  }
  return order;
}

/// Columns that are eliminated together while fronts are being merged.
struct Group {
  std::vector<int> columns;
  std::vector<int> rows;
  int parent = -1;
  double zeros = 0;  // stored entries that the pattern does not have
  bool merged = false;
};

/// Groups of consecutive columns with the same rows below them (positions in postorder).
std::vector<Group> FundamentalGroups(const Graph& graph, const std::vector<int>& parent) {
  const int size = static_cast<int>(parent.size());
  std::vector<std::vector<int>> below(size), children(size);
  std::vector<int> mark(size, -1);
  std::vector<bool> continues(size, false);  // column j belongs to the group of j + 1
  for (int j = 0; j < size; ++j) {
    mark[j] = j;
    auto add = [&](int i) {
      if (i > j && mark[i] != j) {
        mark[i] = j;
        below[j].push_back(i);
      }
    };
    for (int e = graph.begin[j]; e < graph.begin[j + 1]; ++e) add(graph.neighbour[e]);
    for (const int child : children[j]) {
      for (const int i : below[child]) add(i);
    }
    if (j > 0 && parent[j - 1] == j && below[j - 1].size() == below[j].size() + 1) {
      continues[j - 1] = true;
      below[j - 1] = {};
    }
    if (parent[j] >= 0) children[parent[j]].push_back(j);
  }
  std::vector<Group> groups;
  std::vector<int> group_of(size);
  for (int j = 0; j < size; ++j) {
    if (j == 0 || !continues[j - 1]) groups.emplace_back();
    group_of[j] = static_cast<int>(groups.size()) - 1;
    groups.back().columns.push_back(j);
    if (!continues[j]) groups.back().rows = std::move(below[j]);
  }
  for (Group& group : groups) {
    const int up = parent[group.columns.back()];
    group.parent = up < 0 ? -1 : group_of[up];
  }
  return groups;
}

/// Whether a front with this many columns may store this large a share of zeros. Small fronts cost
/// more in bookkeeping than in arithmetic.
bool WorthMerging(double columns, double rows, double zeros) {
  const double entries = columns * (columns + 1) / 2 + columns * rows;
  const double share = zeros / entries;
  return columns <= 4 || (columns <= 16 && share < 0.4) || (columns <= 48 && share < 0.1) ||
         share < 0.05;
}

/// Merges groups into their parents where that stores few zeros.
void MergeSmallGroups(std::vector<Group>* groups) {
  std::vector<std::vector<int>> children(groups->size());
  for (int g = 0; g < static_cast<int>(groups->size()); ++g) {
    Group& group = (*groups)[g];
    std::vector<int> kept;
    for (size_t next = 0; next < children[g].size(); ++next) {
      Group& child = (*groups)[children[g][next]];
      const double all = static_cast<double>(group.columns.size() + group.rows.size());
      const double zeros = group.zeros + child.zeros +
                           static_cast<double>(child.columns.size()) *
                               (all - static_cast<double>(child.rows.size()));
      const auto columns = static_cast<double>(child.columns.size() + group.columns.size());
      if (!WorthMerging(columns, static_cast<double>(group.rows.size()), zeros)) {
        kept.push_back(children[g][next]);
        continue;
      }
      group.columns.insert(group.columns.end(), child.columns.begin(), child.columns.end());
      group.zeros = zeros;
      child.merged = true;
      const std::vector<int>& orphans = children[children[g][next]];
      for (const int orphan : orphans) (*groups)[orphan].parent = g;
      kept.insert(kept.end(), orphans.begin(), orphans.end());
    }
    children[g] = std::move(kept);
    std::sort(group.columns.begin(), group.columns.end());
    if (group.parent >= 0) children[group.parent].push_back(g);
  }
  // Children are merged before their parents, so a parent is never a merged group.
}

/// Numbers the columns group by group and finds each front's rows in its parent.
void LayOutFronts(const std::vector<Group>& groups, KktAnalysis* analysis,
                  const std::vector<int>& old_variable_at) {
  std::vector<int> index_of(groups.size(), -1), alive, parent;
  for (int g = 0; g < static_cast<int>(groups.size()); ++g) {
    if (groups[g].merged) continue;
    index_of[g] = static_cast<int>(alive.size());
    alive.push_back(g);
  }
  for (const int g : alive) {
    parent.push_back(groups[g].parent < 0 ? -1 : index_of[groups[g].parent]);
  }
  const std::vector<int> order = Postorder(parent);
  std::vector<int> rank(order.size()), new_position(old_variable_at.size());
  analysis->fronts.resize(order.size());
  analysis->variable_at.clear();
  for (int f = 0; f < static_cast<int>(order.size()); ++f) {
    rank[order[f]] = f;
    KktFront& front = analysis->fronts[f];
    const Group& group = groups[alive[order[f]]];
    front.first_column = static_cast<int>(analysis->variable_at.size());
    front.num_columns = static_cast<int>(group.columns.size());
    for (const int column : group.columns) {
      new_position[column] = static_cast<int>(analysis->variable_at.size());
      analysis->variable_at.push_back(old_variable_at[column]);
    }
  }
  for (int f = 0; f < static_cast<int>(order.size()); ++f) {
    KktFront& front = analysis->fronts[f];
    for (const int row : groups[alive[order[f]]].rows) front.rows.push_back(new_position[row]);
    std::sort(front.rows.begin(), front.rows.end());
    if (parent[order[f]] >= 0) {
      front.parent = rank[parent[order[f]]];
      ++analysis->fronts[front.parent].num_children;
    }
  }
  for (KktFront& front : analysis->fronts) {
    if (front.parent < 0) continue;
    const KktFront& up = analysis->fronts[front.parent];
    auto next = up.rows.begin();
    for (const int row : front.rows) {
      if (row < up.first_column + up.num_columns) {
        front.rows_in_parent.push_back(row - up.first_column);
      } else {
        next = std::lower_bound(next, up.rows.end(), row);
        front.rows_in_parent.push_back(up.num_columns + static_cast<int>(next - up.rows.begin()));
      }
    }
  }
}

std::vector<int> Inverse(const std::vector<int>& permutation) {
  std::vector<int> inverse(permutation.size());
  for (int k = 0; k < static_cast<int>(permutation.size()); ++k) inverse[permutation[k]] = k;
  return inverse;
}

/// Groups the rows into fronts. `variable_at`: elimination position -> row.
KktAnalysis FrontsOf(const std::vector<int>& variable_at, const std::vector<KktEdge>& edges,
                     const CancellationToken& cancellation) {
  auto step = [&cancellation](auto result) {
    cancellation.ThrowIfCancelled();
    return result;
  };
  const std::vector<int> parent = step(EliminationTree(
      MakeGraph(static_cast<int>(variable_at.size()), edges, Inverse(variable_at))));
  std::vector<int> reordered;
  reordered.reserve(variable_at.size());
  for (const int position : Postorder(parent)) reordered.push_back(variable_at[position]);
  const Graph graph =
      step(MakeGraph(static_cast<int>(variable_at.size()), edges, Inverse(reordered)));
  std::vector<Group> groups = step(FundamentalGroups(graph, EliminationTree(graph)));
  MergeSmallGroups(&groups);
  KktAnalysis analysis;
  LayOutFronts(groups, &analysis, reordered);
  analysis.position_of = Inverse(analysis.variable_at);
  return step(std::move(analysis));
}

}  // namespace

double KktAnalysis::Flops() const {
  double flops = 0;
  for (const KktFront& front : fronts) {
    const auto size =
        static_cast<double>(front.num_columns) + static_cast<double>(front.rows.size());
    for (int k = 0; k < front.num_columns; ++k) flops += (size - k) * (size - k);
  }
  return flops;
}

KktAnalysis AnalyseKkt(int size, int num_dual, const std::vector<KktEdge>& edges,
                       const std::vector<double>& times, const CancellationToken& cancellation) {
  const KktPairs pairs(size, num_dual, edges, times);
  cancellation.ThrowIfCancelled();
  KktAnalysis analysis = FrontsOf(pairs.OrderByDegree(), edges, cancellation);
  if (const auto order = pairs.OrderAlongTime()) {
    KktAnalysis along_time = FrontsOf(*order, edges, cancellation);
    if (along_time.Flops() < analysis.Flops()) return along_time;
  }
  return analysis;
}

}  // namespace possibility::collocation
