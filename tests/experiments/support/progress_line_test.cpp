#include "experiments/support/progress_line.h"

#include <gtest/gtest.h>

namespace possibility::experiments {
namespace {

TEST(ProgressLine, HoldsOnlyWhatIsKnown) {
  actions::PlanProgress progress;
  progress.stage = "exploring";
  progress.graph.vertices = 12;
  progress.graph.edges = 30;
  progress.graph.jobs = 2;
  EXPECT_EQ(DescribeProgress(progress, 1.25, 60),
            "exploring  12 vertices  30 edges  2 jobs  1.2 / 60 s");
  progress.graph.best_route_seconds = 245.7;
  EXPECT_EQ(DescribeProgress(progress, 3, 60),
            "exploring  12 vertices  30 edges  2 jobs  best route 246 s  3.0 / 60 s");
  progress = {"verifying", {}, 0.4};
  EXPECT_EQ(DescribeProgress(progress, 4, 60), "verifying 40 %  4.0 / 60 s");
}

}  // namespace
}  // namespace possibility::experiments
