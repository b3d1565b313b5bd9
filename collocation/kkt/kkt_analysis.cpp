#include "collocation/kkt/kkt_analysis.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "collocation/kkt/kkt_order.h"

namespace possibility::collocation {
namespace {

/// Multiplications per row with which no other order is tried: fronts of a dozen rows.
constexpr double kFewFlops = 300;

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
  bool merged = false;
};

/// Groups of consecutive columns with the same rows below them (positions in postorder).
std::vector<Group> FundamentalGroups(const Graph& graph, const std::vector<int>& parent) {
  const int size = static_cast<int>(parent.size());
  // The rows below all columns, one column after the other; children as linked lists.
  std::vector<int> below, begin(size + 1, 0), first_child(size, -1), sibling(size, -1);
  std::vector<int> mark(size, -1), group_of(size);
  std::vector<Group> groups;
  const auto count = [&](int j) { return begin[j + 1] - begin[j]; };
  for (int j = 0; j < size; ++j) {
    mark[j] = j;
    const auto add = [&](int i) {
      if (i > j && mark[i] != j) {
        mark[i] = j;
        below.push_back(i);
      }
    };
    for (int e = graph.begin[j]; e < graph.begin[j + 1]; ++e) add(graph.neighbour[e]);
    for (int child = first_child[j]; child >= 0; child = sibling[child]) {
      for (int k = begin[child]; k < begin[child + 1]; ++k) add(below[k]);
    }
    begin[j + 1] = static_cast<int>(below.size());
    const bool continues = j > 0 && parent[j - 1] == j && count(j - 1) == count(j) + 1;
    if (!continues) groups.emplace_back();
    group_of[j] = static_cast<int>(groups.size()) - 1;
    groups.back().columns.push_back(j);
    groups.back().rows.assign(below.begin() + begin[j], below.end());
    if (parent[j] >= 0) {
      sibling[j] = first_child[parent[j]];
      first_child[parent[j]] = j;
    }
  }
  for (Group& group : groups) {
    const int up = parent[group.columns.back()];
    group.parent = up < 0 ? -1 : group_of[up];
  }
  return groups;
}

/// What it saves to eliminate a child's columns in its parent's front, in multiplications: the
/// child passes on nothing, but its columns become as long as the parent's.
double SavedByMerging(const Group& child, const Group& parent) {
  constexpr double kPerMovedEntry = 50;   // written, read and added
  constexpr double kPerStoredEntry = 50;  // copied, and read by several solves
  constexpr double kPerFront = 1000;
  const auto columns = static_cast<double>(child.columns.size());
  const auto rows = static_cast<double>(child.rows.size());
  const auto rows_there = static_cast<double>(parent.columns.size() + parent.rows.size());
  const double longer = rows_there - rows;
  const double multiplications = columns * longer * (columns + rows + rows_there) / 2;
  return kPerFront + kPerMovedEntry * rows * rows / 2 - kPerStoredEntry * columns * longer -
         multiplications;
}

/// Merges groups into their parents where that saves time.
void MergeSmallGroups(std::vector<Group>* groups) {
  std::vector<std::vector<int>> children(groups->size());
  for (int g = 0; g < static_cast<int>(groups->size()); ++g) {
    Group& group = (*groups)[g];
    std::vector<int> kept;
    for (size_t next = 0; next < children[g].size(); ++next) {
      Group& child = (*groups)[children[g][next]];
      if (SavedByMerging(child, group) <= 0) {
        kept.push_back(children[g][next]);
        continue;
      }
      group.columns.insert(group.columns.end(), child.columns.begin(), child.columns.end());
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
  if (analysis.Flops() < kFewFlops * size) return analysis;
  if (const auto order = pairs.OrderAlongTime()) {
    KktAnalysis along_time = FrontsOf(*order, edges, cancellation);
    if (along_time.Flops() < analysis.Flops()) return along_time;
  }
  return analysis;
}

}  // namespace possibility::collocation
