#pragma once

#include <Eigen/Geometry>
#include <array>
#include <utility>
#include <vector>

namespace possibility::models {

/// A static binary tree over axis-aligned boxes. Immutable; safe to share.
class BoundsTree {
 public:
  BoundsTree() = default;
  explicit BoundsTree(std::vector<Eigen::AlignedBox3d> items);

  /// Calls `visit(item)` for every item whose box comes within `limit` (m, >= 0) of `bounds`, near
  /// subtrees first. `visit` returns the limit from then on; a negative limit ends the search.
  template <typename Visitor>
  void VisitNear(const Eigen::AlignedBox3d& bounds, double limit, const Visitor& visit) const;

 private:
  struct Node {
    Eigen::AlignedBox3d bounds;
    int item = -1;  ///< leaves only
    std::array<int, 2> children = {-1, -1};
  };
  /// Most splits on a path from the root that set apart a single item.
  static constexpr int kMaxSetApart = 16;
  /// All other splits halve the items, so the depth stays below 32 + kMaxSetApart for any int
  /// count.
  static constexpr int kMaxDepth = 64;

  int Build(std::vector<int>::iterator first, std::vector<int>::iterator last, int set_apart,
            const std::vector<Eigen::AlignedBox3d>& items);

  std::vector<Node> nodes_;  ///< nodes_[0] is the root
};

template <typename Visitor>
void BoundsTree::VisitNear(const Eigen::AlignedBox3d& bounds, double limit,
                           const Visitor& visit) const {
  if (nodes_.empty()) return;
  struct Entry {
    int node;
    double squared_distance;
  };
  const auto entry = [&](int node) {
    return Entry{node, nodes_[node].bounds.squaredExteriorDistance(bounds)};
  };
  std::array<Entry, kMaxDepth> stack;
  int size = 0;
  stack[size++] = entry(0);
  while (size > 0 && !(limit < 0)) {
    const Entry top = stack[--size];
    if (top.squared_distance > limit * limit) continue;
    const Node& node = nodes_[top.node];
    if (node.item >= 0) {
      limit = visit(node.item);
      continue;
    }
    Entry near = entry(node.children[0]);
    Entry far = entry(node.children[1]);
    if (far.squared_distance < near.squared_distance) std::swap(near, far);
    stack[size++] = far;
    stack[size++] = near;
  }
}

}  // namespace possibility::models
