#include "experiments/regression/regression_pages.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "experiments/problems/robot_problems.h"
#include "experiments/report/trajectory_plot.h"
#include "models/input/input_error.h"
#include "models/robot/robot_model.h"
#include "models/robot/robot_yaml.h"
#include "tests/models/temporary_folder.h"

namespace possibility::experiments {
namespace {

using models::TemporaryFolder;

std::string Read(const std::filesystem::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

RegressionProblem Named(const std::string& name) {
  const auto problems = RegressionProblems();
  return *std::find_if(problems.begin(), problems.end(),
                       [&](const auto& problem) { return problem.name == name; });
}

TEST(RegressionPages, HaveTheTableAndAPictureForEachMotion) {
  RegressionProblem broken = Named("block_move");
  broken.name = "broken<>";
  broken.build = []() -> std::unique_ptr<collocation::OptimalControlProblem> {
    throw std::invalid_argument("no such thing");
  };
  const RegressionReport report =
      RunRegression({Named("block_move"), broken}, {}, [](int, const std::string&) {});
  const TemporaryFolder folder;
  WriteRegressionPages(report, folder.path());
  const std::string page = Read(folder.path() / "index.html");
  EXPECT_NE(page.find("<img src=\"block_move.svg\""), std::string::npos);
  EXPECT_NE(page.find("1 of 2 problems"), std::string::npos);
  EXPECT_NE(page.find("broken&lt;&gt;"), std::string::npos);
  EXPECT_EQ(page.find("broken<>"), std::string::npos);
  EXPECT_NE(page.find("no such thing"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "broken__.svg"));
  const std::string picture = Read(folder.path() / "block_move.svg");
  for (const char* title : {">Coordinates<", ">Rates<", ">Controls<", ">force<", ">x'<"}) {
    EXPECT_NE(picture.find(title), std::string::npos) << title;
  }
  EXPECT_THROW(WriteRegressionPages(report, folder.path() / "none"), InputError);
}

TEST(TrajectoryPlot, ShowsTheMotionWithItsKnots) {
  const RegressionRecord record = RunProblem(Named("block_move"), {});
  const std::vector<Plot> plots = TrajectoryPlots(record.solution);
  ASSERT_EQ(plots.size(), 3U);
  const PlotCurve& x = plots[0].curves.at(0);
  EXPECT_EQ(x.marker_x.size(), 21U);
  EXPECT_EQ(plots[0].rug.size(), 21U);
  EXPECT_TRUE(plots[0].lines.empty()) << "one phase has no boundaries";
  // x = 3 t^2 - 2 t^3, also between the knots.
  for (std::size_t i = 0; i + 1 < x.x.size(); ++i) {
    EXPECT_NEAR(x.y[i], x.x[i] * x.x[i] * (3 - 2 * x.x[i]), 1e-9);
  }
}

/// The stored solution of a neighbour starts the humanoid's squat as well. The neighbour is the
/// lighter robot.
TEST(WarmStart, OfAHeavierRobotsSquatHalvesTheIterations) {
  const auto robot =
      models::LoadRobotModel(POSSIBILITY_SOURCE_DIR "/models/drchubo1/drchubo1.yaml");
  auto heavier = robot;
  for (models::Link& link : heavier.links) link.inertial.mass *= 1.05;
  const auto squat = [](const models::RobotModel& model) {
    for (const RegressionProblem& problem : RobotProblems(model)) {
      if (problem.name == "drchubo1_squat_to_stand") return problem.build();
    }
    throw std::logic_error("no squat");
  };
  const auto neighbour = squat(robot), problem = squat(heavier);
  collocation::OptimalControlOptions options;
  options.solver.tolerance = 1e-10;
  const auto solved = SolveOptimalControl(*neighbour, options);
  const auto cold = SolveOptimalControl(*problem, options);
  const auto warm = SolveOptimalControl(*problem, Store(*neighbour, solved), options);
  ASSERT_TRUE(solved.succeeded() && cold.succeeded() && warm.succeeded()) << warm.message;
  EXPECT_GT(std::abs(cold.objective / solved.objective - 1), 1e-4);
  EXPECT_TRUE(warm.dual_start);
  EXPECT_NEAR(warm.objective, cold.objective, 1e-8 * cold.objective);
  EXPECT_LT(2 * warm.iterations, cold.iterations)
      << warm.iterations << " iterations, cold " << cold.iterations;
}

}  // namespace
}  // namespace possibility::experiments
