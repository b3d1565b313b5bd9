#include "models/shapes/bounds_tree.h"

#include <algorithm>
#include <numeric>

namespace possibility::models {
namespace {

/// An item that spans more than this part of a node gets its own leaf beside all others. Otherwise
/// every node on the path down to it would be as large. (Example: a floor under ten thousand
/// obstacles.)
constexpr double kLargePart = 0.5;

}  // namespace

BoundsTree::BoundsTree(std::vector<Eigen::AlignedBox3d> items) {
  if (items.empty()) return;
  std::vector<int> order(items.size());
  std::iota(order.begin(), order.end(), 0);
  nodes_.reserve(2 * items.size());
  Build(order.begin(), order.end(), 0, items);
}

int BoundsTree::Build(std::vector<int>::iterator first, std::vector<int>::iterator last,
                      int set_apart, const std::vector<Eigen::AlignedBox3d>& items) {
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
  const auto size = [&](int i) { return items[i].sizes()[axis]; };
  const auto largest =
      std::max_element(first, last, [&](int i, int j) { return size(i) < size(j); });
  const bool splits_off =
      set_apart < kMaxSetApart && size(*largest) > kLargePart * bounds.sizes()[axis];
  auto middle = first + 1;
  if (splits_off) {
    std::iter_swap(first, largest);
    ++set_apart;
  } else {
    middle = first + (last - first) / 2;
    std::nth_element(first, middle, last, [&](int i, int j) {
      return items[i].center()[axis] < items[j].center()[axis];
    });
  }
  const int left = Build(first, middle, set_apart, items);
  const int right = Build(middle, last, set_apart, items);
  nodes_[index].children = {left, right};
  return index;
}

}  // namespace possibility::models
