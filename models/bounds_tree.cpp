#include "models/bounds_tree.h"

#include <algorithm>
#include <numeric>

namespace possibility::models {

BoundsTree::BoundsTree(std::vector<Eigen::AlignedBox3d> items) {
  if (items.empty()) return;
  std::vector<int> order(items.size());
  std::iota(order.begin(), order.end(), 0);
  nodes_.reserve(2 * items.size());
  Build(order.begin(), order.end(), items);
}

int BoundsTree::Build(std::vector<int>::iterator first, std::vector<int>::iterator last,
                      const std::vector<Eigen::AlignedBox3d>& items) {
  const int index = static_cast<int>(nodes_.size());
  nodes_.emplace_back();
  Eigen::AlignedBox3d bounds, centres;
  for (auto it = first; it != last; ++it) {
    bounds.extend(items[*it]);
    centres.extend(items[*it].center());
  }
  nodes_[index].bounds = bounds;
  if (last - first == 1) {
    nodes_[index].item = *first;
    return index;
  }
  int axis = 0;
  centres.sizes().maxCoeff(&axis);
  const auto middle = first + (last - first) / 2;
  std::nth_element(first, middle, last,
                   [&](int i, int j) { return items[i].center()[axis] < items[j].center()[axis]; });
  const int left = Build(first, middle, items);
  const int right = Build(middle, last, items);
  nodes_[index].children = {left, right};
  return index;
}

}  // namespace possibility::models
