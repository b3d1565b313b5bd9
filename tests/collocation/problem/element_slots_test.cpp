#include "collocation/problem/element_slots.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <utility>

namespace possibility::collocation {
namespace {

TEST(ElementSlotsTest, EveryElementHasOneSlotAndSlotsAreNumberedAsTheyAppear) {
  std::mt19937 random(1);
  for (const int range : {1, 3, 30, 3000}) {
    std::uniform_int_distribution<int> index(0, range);
    ElementSlots slots;
    std::map<std::pair<int, int>, int> expected;
    for (int i = 0; i < 5000; ++i) {
      const int row = index(random), column = index(random);
      const auto [known, is_new] =
          expected.try_emplace({row, column}, static_cast<int>(expected.size()));
      ASSERT_EQ(slots.At(row, column), known->second);
    }
    ASSERT_EQ(slots.pattern().size(), static_cast<int>(expected.size()));
    for (const auto& [element, slot] : expected) {
      EXPECT_EQ(slots.pattern().rows[slot], element.first);
      EXPECT_EQ(slots.pattern().columns[slot], element.second);
    }
  }
}

TEST(ElementSlotsTest, BothTrianglesOfASymmetricMatrixShareTheLower) {
  ElementSlots slots;
  EXPECT_EQ(slots.AtLower(2, 5), slots.AtLower(5, 2));
  EXPECT_EQ(slots.At(5, 2), 0);
  EXPECT_EQ(slots.At(2, 5), 1);
}

}  // namespace
}  // namespace possibility::collocation
