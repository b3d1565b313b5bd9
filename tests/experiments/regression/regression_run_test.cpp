#include "experiments/regression/regression_run.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <stdexcept>

#include "experiments/regression/regression_comparison.h"

namespace possibility::experiments {
namespace {

/// A unit mass moved by 1 in 1 s from rest to rest. The least integral of force^2 is 12.
RegressionProblem BlockMove(std::vector<KnownOptimum> optima) {
  const auto problems = RegressionProblems();
  auto problem = *std::find_if(problems.begin(), problems.end(),
                               [](const auto& p) { return p.name == "block_move"; });
  problem.optima = std::move(optima);
  return problem;
}

TEST(RegressionProblems, HaveUniqueNamesASourceAndOptima) {
  std::set<std::string> names;
  for (const RegressionProblem& problem : RegressionProblems()) {
    EXPECT_TRUE(names.insert(problem.name).second) << problem.name;
    EXPECT_FALSE(problem.source.empty()) << problem.name;
    EXPECT_FALSE(problem.optima.empty()) << problem.name;
    EXPECT_EQ(problem.name.find_first_of(", "), std::string::npos) << problem.name;
    for (const KnownOptimum& optimum : problem.optima) {
      EXPECT_GT(optimum.tolerance, 0) << problem.name;
      EXPECT_LT(optimum.tolerance, 1e-2) << problem.name << ": a tolerance that tells nothing";
    }
  }
}

TEST(RegressionRun, NamesTheOptimumThatWasMet) {
  const RegressionRecord record =
      RunProblem(BlockMove({{"lower", 11.9, 1e-6}, {"true", 12, 1e-6}, {"upper", 12.1, 1e-6}}), {});
  EXPECT_EQ(record.status, "solved");
  EXPECT_TRUE(record.within_tolerance);
  EXPECT_EQ(record.nearest.name, "true");
  EXPECT_LT(record.relative_error, 1e-9);
  EXPECT_EQ(record.Json()["optimum"], "true");
  EXPECT_GT(record.variables, record.constraints);
  EXPECT_EQ(record.intervals, std::vector<int>{20});
  EXPECT_GT(record.evaluations.jacobian, 0);
}

TEST(RegressionRun, AMissIsMeasuredToTheNearestOptimum) {
  const RegressionReport report = RunRegression(
      {BlockMove({{"far", 15, 1e-6}, {"near", 12.5, 1e-6}})}, {}, [](int, const std::string&) {});
  const RegressionRecord& record = report.problems[0];
  EXPECT_FALSE(record.within_tolerance);
  EXPECT_EQ(record.nearest.name, "near");
  EXPECT_NEAR(record.relative_error, 0.5 / 12.5, 1e-8);
  EXPECT_TRUE(record.Json()["optimum"].is_null());
  EXPECT_EQ(report.Failures(), std::vector<std::string>{"block_move"});
  EXPECT_NE(report.Text().find("MISSES near"), std::string::npos);
}

TEST(RegressionRun, AProblemThatThrowsDoesNotEndTheRun) {
  RegressionProblem broken = BlockMove({{"global", 12, 1e-6}});
  broken.name = "broken";
  broken.build = []() -> std::unique_ptr<collocation::OptimalControlProblem> {
    throw std::invalid_argument("no such thing");
  };
  std::vector<std::string> heard;
  const RegressionReport report = RunRegression({broken, BlockMove({{"global", 12, 1e-6}})}, {},
                                                [&](int done, const std::string& name) {
                                                  EXPECT_EQ(done, static_cast<int>(heard.size()));
                                                  heard.push_back(name);
                                                });
  EXPECT_EQ(heard, (std::vector<std::string>{"broken", "block_move"}));
  EXPECT_EQ(report.problems[0].status, "error");
  EXPECT_EQ(report.problems[0].message, "no such thing");
  EXPECT_TRUE(report.problems[1].within_tolerance);
  // The written run can be read, including numbers that are not finite.
  const auto json = nlohmann::json::parse(report.Json().dump());
  EXPECT_FALSE(CompareRegressions(json, json).failed());
}

TEST(RegressionRun, SwingUpsAreProvedMinima) {
  RegressionOptions options;
  options.second_order_check = true;
  std::vector<RegressionProblem> problems = RegressionProblems();
  std::erase_if(problems, [](const RegressionProblem& problem) {
    return problem.name.find("pendulum") == std::string::npos && problem.name != "cart_pole";
  });
  ASSERT_GE(problems.size(), 2u);
  const RegressionReport report = RunRegression(problems, options, [](int, const std::string&) {});
  for (const RegressionRecord& record : report.problems) {
    EXPECT_EQ(record.stationary_point, collocation::StationaryPoint::kMinimum) << record.name;
    EXPECT_EQ(record.Json()["stationary_point"], "minimum");
    EXPECT_GT(record.seconds.second_order, 0);
  }
  const std::string text = report.Text();
  EXPECT_NE(text.find("global, minimum\n"), std::string::npos) << text;
  EXPECT_NE(text.find(fmt::format(", {} proved minima;", problems.size())), std::string::npos);
}

TEST(RegressionRun, WithoutTheCheckNoPointIsKnown) {
  const RegressionReport report =
      RunRegression({BlockMove({{"global", 12, 1e-6}})}, {}, [](int, const std::string&) {});
  EXPECT_EQ(report.problems[0].Json()["stationary_point"], "unknown");
  EXPECT_NE(report.Text().find("1 of 1 within tolerance;"), std::string::npos);
}

TEST(RegressionRun, OptionsReachTheSolver) {
  RegressionOptions options;
  options.scheme = collocation::Trapezoidal();
  options.intervals = 7;
  options.linear_solver = collocation::LinearSolver::kMumps;
  options.hessian = collocation::HessianMode::kLimitedMemory;
  const RegressionRecord record = RunProblem(BlockMove({{"global", 12, 1e-6}}), options);
  EXPECT_EQ(record.scheme, "trapezoidal");
  EXPECT_EQ(record.intervals, std::vector<int>{7});
  EXPECT_EQ(record.evaluations.hessian, 0);
  EXPECT_GT(record.relative_error, 1e-4);  // second order on a coarse mesh
  EXPECT_LT(record.relative_error, 0.1);
  const auto json = options.Json();
  EXPECT_EQ(json["solver"], "ipopt");
  EXPECT_EQ(json["linear_solver"], "mumps");
  EXPECT_EQ(json["hessian"], "limited_memory");
  EXPECT_EQ(json["intervals"], 7);
  EXPECT_EQ(json["coarse_first"], true);
  options.coarse_first = false;
  EXPECT_EQ(options.Json()["coarse_first"], false);
  EXPECT_FALSE(options.For(BlockMove({{"global", 12, 1e-6}})).coarse_first);
}

}  // namespace
}  // namespace possibility::experiments
