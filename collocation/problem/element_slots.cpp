#include "collocation/problem/element_slots.h"

#include <algorithm>
#include <cstdint>

namespace possibility::collocation {

int ElementSlots::At(int row, int column) {
  if (2 * static_cast<std::size_t>(pattern_.size() + 1) > table_.size()) Grow();
  int& slot = Place(row, column);
  if (slot < 0) {
    slot = pattern_.size();
    pattern_.Add(row, column);
  }
  return slot;
}

int ElementSlots::AtLower(int i, int j) { return At(std::max(i, j), std::min(i, j)); }

/// Fibonacci hashing with linear probing (Knuth 1973, 6.4).
int& ElementSlots::Place(int row, int column) {
  const std::uint64_t key = static_cast<std::uint64_t>(static_cast<std::uint32_t>(row)) << 32 |
                            static_cast<std::uint32_t>(column);
  const std::size_t mask = table_.size() - 1;
  for (std::size_t at = key * 0x9e3779b97f4a7c15U >> shift_;; at = (at + 1) & mask) {
    const int slot = table_[at];
    if (slot < 0 || (pattern_.rows[slot] == row && pattern_.columns[slot] == column)) {
      return table_[at];
    }
  }
}

void ElementSlots::Grow() {
  constexpr std::size_t kFirst = 16;
  const std::size_t size = std::max(kFirst, 2 * table_.size());
  shift_ = 64;
  for (std::size_t places = size; places > 1; places /= 2) --shift_;
  table_.assign(size, -1);
  for (int slot = 0; slot < pattern_.size(); ++slot) {
    Place(pattern_.rows[slot], pattern_.columns[slot]) = slot;
  }
}

}  // namespace possibility::collocation
