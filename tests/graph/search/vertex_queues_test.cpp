#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "graph/action/random.h"
#include "graph/search/sorted_vertex_queue.h"
#include "graph/search/transition_queue.h"

namespace possibility::graph {
namespace {

TEST(SortedVertexQueue, PopsByDistanceThenNumber) {
  SortedVertexQueue queue;
  queue.Insert(2, 5);
  queue.Insert(1, 9);
  queue.Insert(2, 3);
  EXPECT_EQ(queue.PopFront(), 9);
  EXPECT_EQ(queue.Front(), 3);
  EXPECT_EQ(queue.PopFront(), 3);
  EXPECT_EQ(queue.PopFront(), 5);
  EXPECT_TRUE(queue.empty());
}

TEST(TransitionQueue, PopsEveryVertexOnceInRandomOrder) {
  RandomGenerator generator(1);
  std::vector<int> first_pops(5, 0);
  for (int round = 0; round < 5000; ++round) {
    TransitionQueue queue;
    for (const VertexId v : {0, 1, 2, 3, 4, 3, 0}) {
      queue.Insert(v);
    }
    EXPECT_EQ(queue.size(), 5);
    ++first_pops[*queue.PopRandom(&generator)];
    std::set<VertexId> rest;
    while (const auto v = queue.PopRandom(&generator)) {
      rest.insert(*v);
      queue.Insert(*v);
    }
    EXPECT_EQ(rest.size(), 4);
  }
  for (const int pops : first_pops) {
    EXPECT_NEAR(pops, 1000, 150);  // five standard deviations
  }
}

}  // namespace
}  // namespace possibility::graph
