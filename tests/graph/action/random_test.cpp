#include "graph/action/random.h"

#include <gtest/gtest.h>

#include <vector>

namespace possibility::graph {
namespace {

TEST(Random, IsUniform) {
  RandomGenerator generator(11);
  std::vector<int> hits(7, 0);
  double sum = 0;
  for (int i = 0; i < 70000; ++i) {
    ++hits[UniformIndex(7, &generator)];
    const double real = UniformReal(-1, 3, &generator);
    ASSERT_TRUE(real >= -1 && real < 3);
    sum += real;
  }
  for (const int hit : hits) {
    EXPECT_NEAR(hit, 10000, 500);
  }
  EXPECT_NEAR(sum / 70000, 1, 0.03);
}

}  // namespace
}  // namespace possibility::graph
