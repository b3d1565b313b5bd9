#include "experiments/regression/work_precision.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "experiments/report/svg_plot.h"

namespace possibility::experiments {
namespace {

RegressionProblem SuiteProblem(const std::string& name) {
  const auto problems = RegressionProblems();
  return *std::find_if(problems.begin(), problems.end(),
                       [&](const auto& problem) { return problem.name == name; });
}

/// Halving the intervals' length divides the error of the trapezoidal rule by 4.
TEST(WorkPrecision, ShowsTheOrderOfTheTrapezoidalRule) {
  int meshes = 0;
  const auto points = MeasureWorkPrecision(SuiteProblem("block_move"), {}, [&](int done, int all) {
    EXPECT_EQ(done, meshes++);
    EXPECT_EQ(all, 15);
  });
  ASSERT_EQ(points.size(), 15U);
  EXPECT_EQ(meshes, 15);
  std::map<std::string, std::vector<WorkPrecisionPoint>> by_scheme;
  for (const WorkPrecisionPoint& point : points) {
    EXPECT_EQ(point.status, "solved");
    EXPECT_GT(point.seconds, 0);
    by_scheme[point.scheme].push_back(point);
  }
  ASSERT_EQ(by_scheme.size(), 3U);
  const auto& trapezoidal = by_scheme["trapezoidal"];
  for (std::size_t i = 1; i < trapezoidal.size(); ++i) {
    EXPECT_EQ(trapezoidal[i].intervals, 2 * trapezoidal[i - 1].intervals);
    const double order =
        std::log2(trapezoidal[i - 1].relative_error / trapezoidal[i].relative_error);
    EXPECT_NEAR(order, 2, 0.1) << trapezoidal[i].intervals;
  }
  for (const WorkPrecisionPoint& point : by_scheme["hermite_simpson"]) {
    EXPECT_LT(point.relative_error, 1e-8) << "a cubic is exact";
  }
}

TEST(WorkPrecision, ASchemeAndIntervalsReplaceTheDefaults) {
  RegressionOptions options;
  options.scheme = collocation::Trapezoidal();
  options.intervals = 8;
  options.work_precision = true;
  const RegressionReport report =
      RunRegression({SuiteProblem("block_move")}, options, [](int, const std::string&) {});
  std::vector<int> intervals;
  for (const WorkPrecisionPoint& point : report.problems[0].work_precision) {
    EXPECT_EQ(point.scheme, "trapezoidal");
    intervals.push_back(point.intervals);
  }
  EXPECT_EQ(intervals, (std::vector<int>{2, 4, 8, 16, 32}));
  EXPECT_EQ(report.Json()["problems"][0]["work_precision"].size(), 5U);
}

TEST(WorkPrecision, TheMeshesAreNotRefined) {
  RegressionProblem refined = SuiteProblem("block_move");
  refined.mesh_tolerance = 1e-12;
  RegressionOptions options;
  options.scheme = collocation::Trapezoidal();
  options.intervals = 4;
  const auto points = MeasureWorkPrecision(refined, options, [](int, int) {});
  EXPECT_GT(points[1].relative_error, 1e-3) << "not refined";
}

TEST(WorkPrecision, ThePlotLeavesOutWhatWasNotSolved) {
  RegressionRecord record;
  record.nearest = {"global", 12, 1e-6};
  record.work_precision = {{"trapezoidal", 5, "solved", 1e-2, 3, 0.01},
                           {"trapezoidal", 10, "infeasible", 0.5, 9, 0.04},
                           {"hermite_simpson", 5, "solved", 0, 3, 0.02}};
  const Plot plot = WorkPrecisionPlot(record);
  ASSERT_EQ(plot.curves.size(), 3U);
  EXPECT_EQ(plot.curves[0].label, "hermite_simpson");
  EXPECT_GT(plot.curves[0].y[0], 0) << "an exact answer stays on the axis";
  EXPECT_TRUE(std::isnan(plot.curves[1].y[1]));
  EXPECT_EQ(plot.curves[2].y, std::vector<double>(2, 1e-6));
}

}  // namespace
}  // namespace possibility::experiments
