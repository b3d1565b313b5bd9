#include "collocation/study/stored_solution.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>

#include "collocation/study/optimal_control.h"
#include "collocation/study/stored_solution_reader.h"
#include "collocation/study/stored_solution_writer.h"
#include "models/input/input_error.h"
#include "tests/collocation/study/neighbouring_problems.h"
#include "tests/message_of.h"
#include "tests/models/temporary_folder.h"

namespace possibility::collocation {
namespace {

using models::TemporaryFolder;

/// Tight tolerances, so that optima agree more closely than the solver's usual tolerance.
OptimalControlOptions Options(const TranscriptionScheme& scheme, int intervals) {
  OptimalControlOptions options;
  options.scheme = scheme;
  options.intervals = {intervals};
  options.solver.tolerance = 1e-10;
  return options;
}

/// The solution after a file, as another program would read it.
StoredSolution ThroughFile(const StoredSolution& solution) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "solution.json";
  WriteSolution(file, solution);
  return ReadSolution(file);
}

/// Solves one problem cold and from its neighbour's solution. The optimum must be the same, with at
/// most `share` of the iterations.
void ExpectWarmStartHelps(const OptimalControlProblem& neighbour,
                          const OptimalControlProblem& problem,
                          const OptimalControlOptions& options, double share) {
  const OptimalControlResult solved = SolveOptimalControl(neighbour, options);
  ASSERT_TRUE(solved.succeeded()) << solved.message;
  const OptimalControlResult cold = SolveOptimalControl(problem, options);
  ASSERT_TRUE(cold.succeeded()) << cold.message;
  EXPECT_FALSE(cold.dual_start);
  EXPECT_GT(std::abs(cold.objective / solved.objective - 1), 1e-6) << "no other problem";
  const OptimalControlResult warm =
      SolveOptimalControl(problem, ThroughFile(Store(neighbour, solved)), options);
  ASSERT_TRUE(warm.succeeded()) << warm.message;
  EXPECT_TRUE(warm.dual_start);
  EXPECT_NEAR(warm.objective, cold.objective, 1e-8 * std::abs(cold.objective));
  EXPECT_LE(warm.iterations, share * cold.iterations)
      << problem.name() << ": " << warm.iterations << " iterations, cold " << cold.iterations;
}

TEST(StoredSolution, WarmStartsABlockMoveOverAnotherDistance) {
  ExpectWarmStartHelps(*BlockMove(1), *BlockMove(1.2), Options(HermiteSimpson(), 20), 0.7);
}

TEST(StoredSolution, WarmStartsABlockMoveWithAnotherBound) {
  ExpectWarmStartHelps(*BlockMove(1, 5.5), *BlockMove(1, 5.2), Options(HermiteSimpson(), 20), 0.6);
}

TEST(StoredSolution, WarmStartsARocketOfAnotherFinalMass) {
  ExpectWarmStartHelps(*Goddard(0.6), *Goddard(0.601), Options(Trapezoidal(), 100), 0.6);
}

TEST(StoredSolution, WarmStartsACartPoleWithAnotherEnd) {
  ExpectWarmStartHelps(*CartPole(1), *CartPole(1.05), Options(HermiteSimpson(), 40), 0.6);
  ExpectWarmStartHelps(*CartPole(1), *CartPole(1.05), Options(CompressedHermiteSimpson(), 40), 0.6);
}

TEST(StoredSolution, WarmStartsSeveralPhasesWithAParameter) {
  ExpectWarmStartHelps(*TwoLegs(4, 1.5), *TwoLegs(4.2, 1.5), Options(Trapezoidal(), 30), 0.8);
}

TEST(StoredSolution, SolvesItsOwnProblemInTwoIterations) {
  const auto problem = CartPole(1);
  const auto options = Options(HermiteSimpson(), 30);
  const OptimalControlResult cold = SolveOptimalControl(*problem, options);
  const OptimalControlResult again = SolveOptimalControl(*problem, Store(*problem, cold), options);
  ASSERT_TRUE(again.succeeded());
  EXPECT_LE(again.iterations, 2);
  EXPECT_NEAR(again.objective, cold.objective, 1e-9 * cold.objective);
}

TEST(StoredSolution, OnAnotherMeshItIsInterpolated) {
  const auto problem = CartPole(1);
  const OptimalControlResult coarse = SolveOptimalControl(*problem, Options(HermiteSimpson(), 30));
  const auto options = Options(HermiteSimpson(), 50);
  const OptimalControlResult cold = SolveOptimalControl(*problem, options);
  const OptimalControlResult warm = SolveOptimalControl(*problem, Store(*problem, coarse), options);
  ASSERT_TRUE(warm.succeeded()) << warm.message;
  EXPECT_TRUE(warm.dual_start);
  EXPECT_NEAR(warm.objective, cold.objective, 1e-8 * cold.objective);
  EXPECT_LT(2 * warm.iterations, cold.iterations);
}

TEST(StoredSolution, ItsRefinedMeshNeedsNoRefinement) {
  const auto problem = CartPole(1);
  OptimalControlOptions options = Options(HermiteSimpson(), 10);
  options.mesh_tolerance = 1e-3;
  const OptimalControlResult refined = SolveOptimalControl(*problem, options);
  ASSERT_GT(refined.refinements, 0);
  const StoredSolution stored = Store(*problem, refined);
  options.meshes = stored.Meshes();
  const OptimalControlResult again = SolveOptimalControl(*problem, stored, options);
  EXPECT_EQ(again.refinements, 0);
  EXPECT_EQ(again.trajectory.phases[0].mesh, refined.trajectory.phases[0].mesh);
  EXPECT_LE(again.iterations, 2);
}

TEST(StoredSolution, WithAnotherSchemeOnlyTheMotionIsTaken) {
  const auto problem = CartPole(1);
  const OptimalControlResult other = SolveOptimalControl(*problem, Options(Trapezoidal(), 60));
  const auto options = Options(HermiteSimpson(), 40);
  const OptimalControlResult warm = SolveOptimalControl(*problem, Store(*problem, other), options);
  ASSERT_TRUE(warm.succeeded()) << warm.message;
  EXPECT_FALSE(warm.dual_start);
  EXPECT_NEAR(warm.objective, SolveOptimalControl(*problem, options).objective, 1e-6);
}

TEST(StoredSolution, WithANewConstraintOnlyTheMotionIsTaken) {
  const auto problem = BlockMove(1);
  const StoredSolution stored = Store(*problem, SolveOptimalControl(*problem));
  OptimalControlProblem constrained("block move");
  Phase& phase = constrained.AddPhase("move", 2);
  const Variable x = phase.AddCoordinate("x");
  const Variable u = phase.AddControl("force");
  phase.SetDuration(1);
  phase.SetDynamics(Differentiated<1, 1>([](const auto& z, auto* a) { (*a)[0] = z[0]; }), {u});
  phase.Constrain("tube", Differentiated<1, 1>([](const auto& z, auto* c) { (*c)[0] = z[0]; }), {x},
                  {{0, 1}});
  EXPECT_FALSE(SolveOptimalControl(constrained, stored).dual_start);
}

/// For a linear system with quadratic costs the multipliers have a closed form.
TEST(StoredSolution, MultipliersAreCostatesInTheProblemsUnits) {
  // min int u^2, x'' = u, 0 to 1 in 1 s: u = 6 - 12 t. d(objective)/d(u) + multiplier = 0.
  const auto problem = BlockMove(1);
  const OptimalControlResult result = SolveOptimalControl(*problem, Options(HermiteSimpson(), 10));
  const StoredSolution stored = Store(*problem, result);
  const MeshPoints points(stored.trajectory.phases[0].mesh, HermiteSimpson());
  int checked = 0;
  for (const MultiplierSeries& series : stored.multipliers.constraints) {
    if (series.name != "dynamics") continue;
    ASSERT_EQ(series.points.size(), points.shares.size());
    for (std::size_t i = 0; i < series.points.size(); ++i, ++checked) {
      const double u = 6 - 12 * points.shares[i];
      EXPECT_NEAR(series.values[i] / points.weights[i], -2 * u, 1e-6);
    }
  }
  EXPECT_EQ(checked, 21);
}

std::string Difference(const OptimalControlProblem& problem, const StoredSolution& solution) {
  return MessageOf([&] { SolveOptimalControl(problem, solution); });
}

TEST(StoredSolution, OfAnotherProblemIsRefusedWithTheFirstDifference) {
  const auto block = BlockMove(1);
  const StoredSolution stored = Store(*block, SolveOptimalControl(*block));
  EXPECT_EQ(Difference(*CartPole(1), stored),
            "cart-pole swing-up: phase 0 of the stored solution is 'move', expected 'swing'");
  EXPECT_EQ(Difference(*TwoLegs(4, 1), stored),
            "two legs: phase 0 of the stored solution is 'move', expected 'fast'");
  StoredSolution other = stored;
  other.phases[0].coordinates = {"y"};
  EXPECT_EQ(Difference(*block, other),
            "block move: phase 'move': coordinate 0 of the stored solution is 'y', expected 'x'");
  other = stored;
  other.phases[0].controls.push_back("torque");
  EXPECT_EQ(
      Difference(*block, other),
      "block move: phase 'move': control 1 of the stored solution is 'torque', expected none");
  other = stored;
  other.phases[0].order = 1;
  EXPECT_EQ(Difference(*block, other),
            "block move: phase 'move': the stored solution is of order 1, expected 2");
  other = stored;
  other.parameters = {"gain"};
  EXPECT_EQ(Difference(*block, other),
            "block move: parameter 0 of the stored solution is 'gain', expected none");
  other = stored;  // numbers that do not match the names
  other.trajectory.phases[0].coordinates[1].conservativeResize(2, Eigen::NoChange);
  EXPECT_EQ(Difference(*block, other),
            "block move: phase 'move': a guess has 2 coordinates, expected 1");
}

bool SameBits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

bool SameBits(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return a.rows() == b.rows() && a.cols() == b.cols() &&
         std::equal(a.reshaped().begin(), a.reshaped().end(), b.reshaped().begin(),
                    [](double x, double y) { return SameBits(x, y); });
}

TEST(StoredSolution, ReadsBackToTheSameBits) {
  const auto problem = TwoLegs(4, 1.5);
  OptimalControlOptions options = Options(HermiteSimpson(), 7);
  StoredSolution stored = Store(*problem, SolveOptimalControl(*problem, options));
  std::mt19937_64 random(1);
  for (int round = 0; round < 20; ++round) {
    const StoredSolution back = ThroughFile(stored);
    EXPECT_EQ(back.problem, stored.problem);
    EXPECT_EQ(back.phases, stored.phases);
    EXPECT_EQ(back.parameters, stored.parameters);
    EXPECT_TRUE(SameBits(back.trajectory.parameters, stored.trajectory.parameters));
    EXPECT_EQ(back.multipliers, stored.multipliers);
    ASSERT_EQ(back.trajectory.phases.size(), 2U);
    for (std::size_t p = 0; p < 2; ++p) {
      const PhaseTrajectory& a = back.trajectory.phases[p];
      const PhaseTrajectory& b = stored.trajectory.phases[p];
      EXPECT_TRUE(SameBits(a.begin, b.begin) && SameBits(a.duration, b.duration));
      EXPECT_EQ(a.mesh, b.mesh);
      EXPECT_EQ(a.scheme.name, b.scheme.name);
      EXPECT_EQ(a.scheme.nodes, b.scheme.nodes);
      EXPECT_TRUE(SameBits(a.scheme.lagrange, b.scheme.lagrange));
      ASSERT_EQ(a.coordinates.size(), b.coordinates.size());
      for (std::size_t k = 0; k < a.coordinates.size(); ++k) {
        EXPECT_TRUE(SameBits(a.coordinates[k], b.coordinates[k]));
      }
      EXPECT_TRUE(SameBits(a.controls, b.controls));
    }
    // Any bits that a number can have, signed zeros and denormals among them.
    for (double& value : stored.trajectory.phases[0].controls.reshaped()) {
      do {
        value = std::bit_cast<double>(random());
      } while (!std::isfinite(value));
    }
    stored.trajectory.phases[0].controls(0, 0) = -0.0;
    stored.trajectory.phases[0].controls(0, 1) = 5e-324;
  }
}

TEST(StoredSolution, InvalidNumbersAndPathsAreNotWritten) {
  const auto problem = BlockMove(1);
  StoredSolution stored = Store(*problem, SolveOptimalControl(*problem));
  stored.multipliers.constraints[0].values[0] = std::nan("");
  const TemporaryFolder folder;
  EXPECT_THROW(WriteSolution(folder.path() / "s.json", stored), std::invalid_argument);
  stored.multipliers.constraints[0].values[0] = 0;
  EXPECT_THROW(WriteSolution(folder.path() / "none" / "s.json", stored), InputError);
  EXPECT_THROW(WriteSolution(folder.path(), stored), InputError);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

/// The reader's message on a text, without the file's name; "" if the text is accepted.
std::string Complaint(const std::string& text) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "s.json";
  std::ofstream(file, std::ios::binary) << text;
  try {
    ReadSolution(file);
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_EQ(message.rfind(file.string() + ": ", 0), 0U) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    return message.substr(file.string().size() + 2);
  }
  return "";
}

std::string Written(const StoredSolution& stored) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "s.json";
  WriteSolution(file, stored);
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(StoredSolution, MalformedFilesAreRefusedWithOneLine) {
  const auto problem = BlockMove(1);
  OptimalControlOptions options;
  options.intervals = {2};
  const std::string text = Written(Store(*problem, SolveOptimalControl(*problem, options)));
  const auto with = [&](const std::string& pointer, const nlohmann::json& value) {
    auto json = nlohmann::json::parse(text);
    json[nlohmann::json::json_pointer(pointer)] = value;
    return Complaint(json.dump());
  };
  EXPECT_EQ(Complaint(text), "");
  EXPECT_EQ(Complaint(""), "not valid JSON at byte 1 of 0, expected a possibility-solution/1 file");
  EXPECT_EQ(Complaint("[1, 2"),
            "not valid JSON at byte 6 of 5, expected a possibility-solution/1 file");
  EXPECT_EQ(Complaint("[]"), "no \"format\", expected \"possibility-solution/1\"");
  EXPECT_EQ(Complaint("{}"), "no \"format\", expected \"possibility-solution/1\"");
  EXPECT_EQ(Complaint("{\"format\": 1, \"format\": 2}"),
            "key \"format\" stands twice in one object, expected once");
  EXPECT_EQ(with("/format", "possibility-plan/1"),
            "format: \"possibility-plan/1\", expected \"possibility-solution/1\"");
  EXPECT_EQ(
      with("/extra", 1),
      "unknown key \"extra\", expected format, problem, parameters, parameter_values, phases, "
      "multipliers");
  EXPECT_EQ(with("/phases", nlohmann::json::array()), "phases: expected one phase or more");
  EXPECT_EQ(with("/phases/0/duration", -1), "phases[0].duration: expected a number above 0");
  EXPECT_EQ(with("/phases/0/mesh/1", "half"), "phases[0].mesh[1]: expected a number, got string");
  EXPECT_EQ(with("/phases/0/mesh/1", 2),
            "phases[0].mesh: expected numbers that ascend from 0 to 1");
  EXPECT_EQ(with("/phases/0/scheme/nodes", {0, 0.5}),
            "phases[0].scheme.nodes: expected numbers that ascend from 0 to 1");
  EXPECT_EQ(with("/phases/0/coordinate_values/1/0", {1, 2}),
            "phases[0].coordinate_values[1][0]: 2 numbers, expected 5");
  EXPECT_EQ(with("/phases/0/control_values", nlohmann::json::array()),
            "phases[0].control_values: 0 rows, expected 1");
  EXPECT_EQ(with("/multipliers/constraints/0/points/0", 77),
            "multipliers.constraints[0].points[0]: expected an integer from 0 to 4");
  EXPECT_EQ(with("/multipliers/constraints/0/phase", 1),
            "multipliers.constraints[0].phase: expected an integer from -1 to 0");
  EXPECT_EQ(with("/multipliers/constraints/0/values", {1}).substr(0, 45),
            "multipliers.constraints[0].values: 1 numbers,");
  EXPECT_EQ(with("/multipliers/lower", 3), "multipliers.lower: expected an array, got number");
}

TEST(StoredSolution, DamagedFilesAreUsedOrRefused) {
  const auto problem = BlockMove(1, 5.5);
  OptimalControlOptions options;
  options.intervals = {3};
  const StoredSolution stored = Store(*problem, SolveOptimalControl(*problem, options));
  const std::string text = Written(stored);
  std::mt19937 random(7);
  const std::string alphabet = "0123456789-+.eE[]{},:\"n\x01\xff";
  int refused = 0;
  for (int round = 0; round < 400; ++round) {
    std::string damaged = text;
    for (int i = 0; i < 1 + round % 3; ++i) {
      damaged[random() % damaged.size()] = alphabet[random() % alphabet.size()];
    }
    if (round % 5 == 0) damaged.resize(random() % damaged.size());
    const TemporaryFolder folder;
    const auto file = folder.path() / "s.json";
    std::ofstream(file, std::ios::binary) << damaged;
    try {
      const StoredSolution back = ReadSolution(file);
      options.solver.max_iterations = 3;
      SolveOptimalControl(*problem, back, options);
    } catch (const InputError& error) {
      ++refused;
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    } catch (const std::invalid_argument&) {
      ++refused;  // a changed name
    }
  }
  EXPECT_GT(refused, 100);
}

}  // namespace
}  // namespace possibility::collocation
