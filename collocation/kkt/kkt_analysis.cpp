#include "collocation/kkt/kkt_analysis.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>

#include "collocation/kkt/kkt_order.h"

namespace possibility::collocation {
namespace {

/// Multiplications per row with which no other order is tried: fronts of a dozen rows.
constexpr double kFewFlops = 300;

std::vector<int> Inverse(const std::vector<int>& permutation) {
  std::vector<int> inverse(permutation.size());
  for (int k = 0; k < static_cast<int>(permutation.size()); ++k) inverse[permutation[k]] = k;
  return inverse;
}

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

/// The same tree with the nodes in another order. `order`: new number -> old one.
std::vector<int> Renumbered(const std::vector<int>& parent, const std::vector<int>& order) {
  const std::vector<int> number = Inverse(order);
  std::vector<int> renumbered(parent.size(), -1);
  for (std::size_t j = 0; j < order.size(); ++j) {
    const int above = parent[order[j]];
    if (above >= 0) renumbered[j] = number[above];
  }
  return renumbered;
}

/// Columns that are eliminated together while fronts are being merged.
struct Group {
  int first_column = 0;  ///< those that it began with are consecutive
  int num_columns = 0;   ///< with those of merged groups
  int first_row = 0;     ///< in Groups::rows
  int num_rows = 0;
  int parent = -1;
  int merged_into = -1;
};

struct Groups {
  std::vector<Group> groups;  ///< children before parents
  std::vector<int> rows;      ///< below the groups' columns, one group after the other
};

/// Children of nodes, each node's in the order in which they were added.
class ChildLists {
 public:
  explicit ChildLists(int size) : first_(size, -1), last_(size, -1), next_(size, -1) {}

  void Add(int parent, int child) {
    (first_[parent] < 0 ? first_[parent] : next_[last_[parent]]) = child;
    last_[parent] = child;
    next_[child] = -1;
  }
  /// Empties a list and returns its first child.
  int Take(int parent) {
    last_[parent] = -1;
    return std::exchange(first_[parent], -1);
  }
  int first(int parent) const { return first_[parent]; }
  /// The sibling after a child, or -1.
  int next(int child) const { return next_[child]; }

 private:
  std::vector<int> first_, last_, next_;
};

/// Groups of consecutive columns with the same rows below them, column after column (positions in
/// postorder).
class FundamentalGroups {
 public:
  FundamentalGroups(const Graph& graph, const std::vector<int>& parent)
      : graph_(graph),
        parent_(parent),
        children_(static_cast<int>(parent.size())),
        group_with_row_(parent.size(), -1) {}

  Groups Find() {
    for (int j = 0; j < static_cast<int>(parent_.size()); ++j) {
      if (Continues(j)) {
        ++groups_.back().num_columns;
      } else {
        End();
        Begin(j);
      }
    }
    End();
    return {std::move(groups_), std::move(rows_)};
  }

 private:
  int last_group() const { return static_cast<int>(groups_.size()) - 1; }

  /// Whether column j has no row below it that the column before it does not have.
  bool Continues(int j) const {
    if (j == 0 || parent_[j - 1] != j) return false;
    const auto is_known = [&](int i) { return i <= j || group_with_row_[i] == last_group(); };
    for (int e = graph_.begin[j]; e < graph_.begin[j + 1]; ++e) {
      if (!is_known(graph_.neighbour[e])) return false;
    }
    for (int child = children_.first(j); child >= 0; child = children_.next(child)) {
      for (int k = 0; k < groups_[child].num_rows; ++k) {
        if (!is_known(rows_[groups_[child].first_row + k])) return false;
      }
    }
    return true;
  }

  void Begin(int j) {
    groups_.push_back({j, 1, static_cast<int>(rows_.size())});
    for (int e = graph_.begin[j]; e < graph_.begin[j + 1]; ++e) AddRow(graph_.neighbour[e]);
    for (int child = children_.first(j); child >= 0; child = children_.next(child)) {
      for (int k = 0; k < groups_[child].num_rows; ++k) {
        AddRow(rows_[groups_[child].first_row + k]);
      }
    }
  }

  void AddRow(int i) {
    if (i <= groups_.back().first_column || group_with_row_[i] == last_group()) return;
    group_with_row_[i] = last_group();
    rows_.push_back(i);
  }

  /// Ends the last group: its own columns are rows of its first column, but not below the group.
  void End() {
    if (groups_.empty()) return;
    Group& group = groups_.back();
    const int last = group.first_column + group.num_columns - 1;
    rows_.erase(std::remove_if(rows_.begin() + group.first_row, rows_.end(),
                               [last](int i) { return i <= last; }),
                rows_.end());
    group.num_rows = static_cast<int>(rows_.size()) - group.first_row;
    if (parent_[last] >= 0) children_.Add(parent_[last], last_group());
  }

  const Graph& graph_;
  const std::vector<int>& parent_;
  ChildLists children_;              ///< groups below a column
  std::vector<int> group_with_row_;  ///< the last group that has a row
  std::vector<Group> groups_;
  std::vector<int> rows_;
};

/// Groups with the group of each one's parent. `parent`: of the columns.
Groups FindGroups(const Graph& graph, const std::vector<int>& parent) {
  Groups found = FundamentalGroups(graph, parent).Find();
  std::vector<int> group_of(parent.size());
  for (int g = 0; g < static_cast<int>(found.groups.size()); ++g) {
    const auto first = group_of.begin() + found.groups[g].first_column;
    std::fill(first, first + found.groups[g].num_columns, g);
  }
  for (Group& group : found.groups) {
    const int above = parent[group.first_column + group.num_columns - 1];
    group.parent = above < 0 ? -1 : group_of[above];
  }
  return found;
}

/// What it saves to eliminate a child's columns in its parent's front, in multiplications: the
/// child passes on nothing, but its columns become as long as the parent's.
double SavedByMerging(const Group& child, const Group& parent) {
  constexpr double kPerMovedEntry = 50;   // written, read and added
  constexpr double kPerStoredEntry = 50;  // copied, and read by several solves
  constexpr double kPerFront = 1000;
  const double columns = child.num_columns, rows = child.num_rows;
  const double rows_there = parent.num_columns + parent.num_rows;
  const double longer = rows_there - rows;
  const double multiplications = columns * longer * (columns + rows + rows_there) / 2;
  return kPerFront + kPerMovedEntry * rows * rows / 2 - kPerStoredEntry * columns * longer -
         multiplications;
}

/// Merges groups into their parents where that saves time.
void MergeSmallGroups(std::vector<Group>* groups) {
  ChildLists children(static_cast<int>(groups->size()));
  for (int g = 0; g < static_cast<int>(groups->size()); ++g) {
    Group& group = (*groups)[g];
    for (int next = children.Take(g); next >= 0;) {
      const int c = std::exchange(next, children.next(next));
      Group& child = (*groups)[c];
      if (SavedByMerging(child, group) <= 0) {
        children.Add(g, c);
        continue;
      }
      group.num_columns += child.num_columns;
      child.merged_into = g;
      for (int orphan = children.Take(c); orphan >= 0;) {
        const int o = std::exchange(orphan, children.next(orphan));
        (*groups)[o].parent = g;
        children.Add(g, o);
      }
    }
    if (group.parent >= 0) children.Add(group.parent, g);
  }
  // Children are merged before their parents, so a parent is never a merged group.
}

/// Numbers the columns front by front; returns old column -> new position.
std::vector<int> NumberColumns(const Groups& groups, const std::vector<int>& front_of,
                               const std::vector<int>& old_variable_at, KktAnalysis* analysis) {
  int columns = 0;
  std::vector<int> next(analysis->fronts.size());  // of a front's columns
  for (std::size_t f = 0; f < next.size(); ++f) {
    analysis->fronts[f].first_column = next[f] = columns;
    columns += analysis->fronts[f].num_columns;
  }
  analysis->variable_at.resize(old_variable_at.size());
  std::vector<int> new_position(old_variable_at.size());
  for (std::size_t g = 0; g < groups.groups.size(); ++g) {
    const Group& group = groups.groups[g];
    const std::size_t end =
        g + 1 < groups.groups.size() ? groups.groups[g + 1].first_column : old_variable_at.size();
    for (std::size_t column = group.first_column; column < end; ++column) {
      new_position[column] = next[front_of[g]]++;
      analysis->variable_at[new_position[column]] = old_variable_at[column];
    }
  }
  return new_position;
}

/// By group: the front that it is part of, in an order of fronts with children before parents.
std::vector<int> NumberFronts(const std::vector<Group>& groups, std::vector<KktFront>* fronts) {
  const int size = static_cast<int>(groups.size());
  std::vector<int> index_of(size, -1), alive, parent;
  for (int g = 0; g < size; ++g) {
    if (groups[g].merged_into >= 0) continue;
    index_of[g] = static_cast<int>(alive.size());
    alive.push_back(g);
  }
  for (const int g : alive) {
    parent.push_back(groups[g].parent < 0 ? -1 : index_of[groups[g].parent]);
  }
  const std::vector<int> order = Postorder(parent);
  std::vector<int> front_of(size);
  fronts->resize(order.size());
  for (int f = 0; f < static_cast<int>(order.size()); ++f) front_of[alive[order[f]]] = f;
  for (int g = size - 1; g >= 0; --g) {  // what a group is merged into comes after it
    if (groups[g].merged_into >= 0) front_of[g] = front_of[groups[g].merged_into];
  }
  for (const int g : alive) {
    KktFront& front = (*fronts)[front_of[g]];
    front.num_columns = groups[g].num_columns;
    if (groups[g].parent < 0) continue;
    front.parent = front_of[groups[g].parent];
    ++(*fronts)[front.parent].num_children;
  }
  return front_of;
}

void FindRowsInParents(std::vector<KktFront>* fronts) {
  for (KktFront& front : *fronts) {
    if (front.parent < 0) continue;
    const KktFront& up = (*fronts)[front.parent];
    front.rows_in_parent.reserve(front.rows.size());
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

/// Numbers the columns group by group and finds each front's rows in its parent.
void LayOutFronts(const Groups& groups, KktAnalysis* analysis,
                  const std::vector<int>& old_variable_at) {
  const std::vector<int> front_of = NumberFronts(groups.groups, &analysis->fronts);
  const std::vector<int> new_position = NumberColumns(groups, front_of, old_variable_at, analysis);
  for (std::size_t g = 0; g < groups.groups.size(); ++g) {
    const Group& group = groups.groups[g];
    if (group.merged_into >= 0) continue;
    std::vector<int>& rows = analysis->fronts[front_of[g]].rows;
    rows.reserve(group.num_rows);
    for (int k = group.first_row; k < group.first_row + group.num_rows; ++k) {
      rows.push_back(new_position[groups.rows[k]]);
    }
    std::sort(rows.begin(), rows.end());
  }
  FindRowsInParents(&analysis->fronts);
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
  const std::vector<int> postorder = Postorder(parent);
  std::vector<int> reordered;
  reordered.reserve(variable_at.size());
  for (const int position : postorder) reordered.push_back(variable_at[position]);
  const Graph graph =
      step(MakeGraph(static_cast<int>(variable_at.size()), edges, Inverse(reordered)));
  Groups groups = step(FindGroups(graph, Renumbered(parent, postorder)));
  MergeSmallGroups(&groups.groups);
  KktAnalysis analysis;
  LayOutFronts(groups, &analysis, reordered);
  analysis.position_of = Inverse(analysis.variable_at);
  return step(std::move(analysis));
}

}  // namespace

double KktAnalysis::Flops() const {
  double flops = 0;
  for (const KktFront& front : fronts) {
    const double size = front.size();
    for (int k = 0; k < front.num_columns; ++k) flops += (size - k) * (size - k);
  }
  return flops;
}

std::size_t KktAnalysis::FactorEntries() const {
  std::size_t entries = 0;
  for (const KktFront& front : fronts) {
    const auto columns = static_cast<std::size_t>(front.num_columns);
    entries += columns * (columns - 1) / 2 + columns * front.rows.size();
  }
  return entries;
}

KktAnalysis AnalyseKkt(int size, int num_dual, const std::vector<KktEdge>& edges,
                       const std::vector<double>& times, const CancellationToken& cancellation) {
  const KktPairs pairs(size, num_dual, edges, times);
  cancellation.ThrowIfCancelled();
  std::optional<KktAnalysis> best;
  double least = 0;
  const auto consider = [&](const std::optional<std::vector<int>>& order) {
    if (!order) return;
    KktAnalysis analysis = FrontsOf(*order, edges, cancellation);
    const double flops = analysis.Flops();
    if (best && least <= flops) return;
    best = std::move(analysis);
    least = flops;
  };
  const double few = kFewFlops * size;
  consider(pairs.OrderByTime());
  if (best && least < few) return *std::move(best);
  consider(pairs.OrderByDegree());
  if (least >= few) consider(pairs.OrderAlongTime());
  return *std::move(best);
}

}  // namespace possibility::collocation
