#include "experiments/bench/bench_spatial_step.h"

#include <ctime>
#include <random>

#include "collocation/study/optimal_control.h"
#include "dynamics/tree/base_joints.h"
#include "experiments/legged/walking_step.h"
#include "experiments/support/statistics.h"

namespace possibility::experiments {
namespace {

using namespace collocation;  // most of this file is calls to it

constexpr int kIntervals = 15;
constexpr double kNoise = 0.1;       // rad
constexpr int kGuessesPerPair = 10;  // MUMPS solves one guess of so many

OptimalControlOptions Options(LinearSolver linear_solver) {
  OptimalControlOptions options;
  options.intervals = {kIntervals};
  options.solver.tolerance = options.solver.constraint_tolerance = 1e-6;
  options.solver.linear_solver = linear_solver;
  return options;
}

/// Normal noise on every joint at every point.
Trajectory Disturbed(Trajectory trajectory, std::mt19937* random) {
  std::normal_distribution<double> noise(0, kNoise);
  Eigen::MatrixXd& positions = trajectory.phases[0].coordinates[0];
  for (Eigen::Index point = 0; point < positions.cols(); ++point) {
    for (Eigen::Index i = dynamics::kNumBaseJoints; i < positions.rows(); ++i) {
      positions(i, point) += noise(*random);
    }
  }
  return trajectory;
}

struct TimedSolve {
  bool solved = false;
  double seconds = 0;  ///< of the processor
  double kkt_seconds = 0;
  int iterations = 0;
};

TimedSolve SolveFrom(const OptimalControlProblem& problem, const Trajectory& guess,
                     LinearSolver linear_solver) {
  const std::clock_t begin = std::clock();
  const OptimalControlResult result = SolveOptimalControl(problem, Options(linear_solver), guess);
  return {result.succeeded(), static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC,
          result.times.factorisation + result.times.back_solves, result.iterations};
}

}  // namespace

std::vector<std::pair<std::string, double>> BenchSpatialStep(
    const models::RobotModel& robot, int guesses, const std::function<void(int, int)>& progress) {
  const auto problem = WalkingStep(robot);
  const Transcription program(*problem, HermiteSimpson(), {UniformMesh(kIntervals)});
  const Trajectory upright = program.TrajectoryOf(program.InitialGuess());
  std::mt19937 random(1);
  std::vector<double> seconds, kkt, ratios;
  int converged = 0;
  for (int i = 0; i < guesses; ++i) {
    progress(i, guesses);
    const Trajectory guess = Disturbed(upright, &random);
    const TimedSolve ours = SolveFrom(*problem, guess, LinearSolver::kSparseLdlt);
    converged += ours.solved ? 1 : 0;
    seconds.push_back(ours.seconds);
    if (ours.iterations > 0) kkt.push_back(1e3 * ours.kkt_seconds / ours.iterations);
    if (i % kGuessesPerPair != 0) continue;
    ratios.push_back(SolveFrom(*problem, guess, LinearSolver::kMumps).seconds / ours.seconds);
  }
  progress(guesses, guesses);
  return {{"converged", converged},
          {"of", guesses},
          {"median_s", Median(seconds)},
          {"kkt_ms", Median(kkt)},
          {"kkt_speedup", Median(ratios)}};
}

}  // namespace possibility::experiments
