#include "collocation/problem/element_slots.h"

#include <algorithm>

namespace possibility::collocation {

int ElementSlots::At(int row, int column) {
  const auto [slot, is_new] = slots_.try_emplace({row, column}, pattern_.size());
  if (is_new) pattern_.Add(row, column);
  return slot->second;
}

int ElementSlots::AtLower(int i, int j) { return At(std::max(i, j), std::min(i, j)); }

}  // namespace possibility::collocation
