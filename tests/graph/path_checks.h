#pragma once

#include <gtest/gtest.h>

#include <cstddef>

#include "graph/search/find_path.h"

namespace possibility::graph::test {

/// Whether there is a path, of edges end to end from `start` to `goal`.
inline void ExpectPath(const PathResult& result, const Point& start, const Point& goal) {
  ASSERT_EQ(result.status, PathStatus::kFound);
  ASSERT_FALSE(result.path.empty());
  EXPECT_EQ(result.path.front().points.from, start);
  EXPECT_EQ(result.path.back().points.to, goal);
  for (std::size_t i = 1; i < result.path.size(); ++i) {
    EXPECT_EQ(result.path[i].points.from, result.path[i - 1].points.to);
  }
}

inline void ExpectSamePath(const PathResult& a, const PathResult& b) {
  ASSERT_EQ(a.path.size(), b.path.size());
  for (std::size_t i = 0; i < a.path.size(); ++i) {
    EXPECT_EQ(a.path[i].action, b.path[i].action);
    EXPECT_EQ(a.path[i].points.to, b.path[i].points.to);
  }
}

/// The same path, counters and explored graph.
inline void ExpectSameResult(const PathResult& a, const PathResult& b) {
  ExpectSamePath(a, b);
  EXPECT_EQ(a.counters, b.counters);
  ASSERT_EQ(a.graph.vertices.size(), b.graph.vertices.size());
  for (std::size_t i = 0; i < a.graph.vertices.size(); ++i) {
    EXPECT_EQ(a.graph.vertices[i], b.graph.vertices[i]);
  }
  ASSERT_EQ(a.graph.edges.size(), b.graph.edges.size());
  for (std::size_t i = 0; i < a.graph.edges.size(); ++i) {
    EXPECT_EQ(a.graph.edges[i].from, b.graph.edges[i].from);
    EXPECT_EQ(a.graph.edges[i].to, b.graph.edges[i].to);
    EXPECT_EQ(a.graph.edges[i].action, b.graph.edges[i].action);
  }
}

}  // namespace possibility::graph::test
