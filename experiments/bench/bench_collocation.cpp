#include "experiments/bench/bench_collocation.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>

#include "collocation/solver/solver.h"
#include "collocation/study/optimal_control.h"
#include "collocation/transcription/transcription.h"
#include "experiments/bench/bench_spatial_step.h"
#include "experiments/bench/differenced_program.h"
#include "experiments/problems/regression_problems.h"
#include "experiments/problems/robot_problems.h"
#include "experiments/regression/regression_run.h"

namespace possibility::experiments {
namespace {

using namespace collocation;  // most of this file is calls to it

constexpr int kRounds = 3;
constexpr int kSpatialGuesses = 100;
constexpr double kSecondsPerBatch = 0.02;  // short solves are repeated for about this long
constexpr double kOnceSeconds = 2;         // longer ones are not repeated in later rounds
constexpr double kPatience = 15;           // times the duration of the exact solve

struct Sample {
  SolverTimes times;
  bool solved = false;

  double linear_algebra() const { return times.factorisation + times.back_solves; }
  double but_callbacks() const { return times.total - times.functions - times.derivatives; }
};

/// Solves as `possibility regress --direct` does: from the stated guess, refining the mesh. Coarse
/// meshes would leave little to the linear solver.
Sample SolveWhole(const RegressionProblem& problem, LinearSolver linear_solver) {
  const auto posed = problem.build();
  RegressionOptions options;
  options.coarse_first = false;
  options.linear_solver = linear_solver;
  const OptimalControlResult result = SolveOptimalControl(*posed, options.For(problem));
  return {result.times, result.succeeded()};
}

enum class Derivatives { kExact, kLimitedMemory, kDifferences };

/// One solve on the problem's initial mesh.
Sample SolveFirstMesh(const OptimalControlProblem& posed, const RegressionProblem& problem,
                      Derivatives derivatives, double time_limit) {
  Transcription program(posed, problem.scheme,
                        std::vector<Mesh>(posed.num_phases(), UniformMesh(problem.intervals)));
  const SolverGuess guess{program.InitialGuess(), {}, {}, {}};
  SolverOptions options;
  options.time_limit = time_limit;
  if (derivatives != Derivatives::kExact) options.hessian = HessianMode::kLimitedMemory;
  SolverResult result;
  if (derivatives == Derivatives::kDifferences) {
    DifferencedProgram differenced(&program, guess.x);
    result = Solve(&differenced, guess, options);
  } else {
    result = Solve(&program, guess, options);
  }
  return {result.times, result.succeeded()};
}

/// One problem with one solver variant, over all rounds.
class Variant {
 public:
  explicit Variant(std::function<Sample()> solve) : solve_(std::move(solve)) {}

  /// The mean of a batch; for a long solve, the first result again.
  const Sample& Measure() {
    if (repeats_ == 0) {
      sample_ = solve_();
      repeats_ = static_cast<int>(
          std::clamp(kSecondsPerBatch / std::max(1e-6, sample_.times.total), 1.0, 20.0));
      if (repeats_ == 1) return sample_;
    }
    if (sample_.times.total > kOnceSeconds) return sample_;
    SolverTimes sum;
    for (int i = 0; i < repeats_; ++i) Add(solve_().times, 1.0 / repeats_, &sum);
    sample_.times = sum;
    return sample_;
  }
  const Sample& sample() const { return sample_; }

 private:
  static void Add(const SolverTimes& times, double weight, SolverTimes* sum) {
    for (const auto part :
         {&SolverTimes::total, &SolverTimes::functions, &SolverTimes::derivatives,
          &SolverTimes::factorisation, &SolverTimes::back_solves, &SolverTimes::rest}) {
      sum->*part += weight * (times.*part);
    }
  }

  std::function<Sample()> solve_;
  Sample sample_;
  int repeats_ = 0;
};

/// The solver variants of one problem.
struct Contest {
  std::string name;
  bool is_robot;
  Variant ours, mumps, exact, limited_memory, differences;
};

Contest ContestOf(const RegressionProblem& problem, bool is_robot) {
  const std::shared_ptr<const OptimalControlProblem> posed = problem.build();
  const double patience = std::max(
      1.0, kPatience * SolveFirstMesh(*posed, problem, Derivatives::kExact, 0).times.total);
  const auto first_mesh = [=](Derivatives derivatives) {
    return Variant([=] { return SolveFirstMesh(*posed, problem, derivatives, patience); });
  };
  const auto whole = [problem](LinearSolver linear_solver) {
    return Variant([=] { return SolveWhole(problem, linear_solver); });
  };
  return {problem.name,
          is_robot,
          whole(LinearSolver::kSparseLdlt),
          whole(LinearSolver::kMumps),
          first_mesh(Derivatives::kExact),
          first_mesh(Derivatives::kLimitedMemory),
          first_mesh(Derivatives::kDifferences)};
}

/// A quantity measured for every problem and round, and summed over the problems.
struct Measure {
  std::string name;
  Variant Contest::*variant;
  double (*seconds)(const Sample&);
  bool by_problem;  ///< also a row for each problem
};

double Total(const Sample& sample) { return sample.times.total; }
double LinearAlgebra(const Sample& sample) { return sample.linear_algebra(); }
double ButCallbacks(const Sample& sample) { return sample.but_callbacks(); }

const std::vector<Measure>& Measures() {
  static const std::vector<Measure> measures = {
      {"linear algebra", &Contest::ours, &LinearAlgebra, true},
      {"linear algebra, MUMPS", &Contest::mumps, &LinearAlgebra, true},
      {"all but functions and derivatives", &Contest::ours, &ButCallbacks, false},
      {"all but functions and derivatives, MUMPS", &Contest::mumps, &ButCallbacks, false},
      {"solve", &Contest::ours, &Total, false},
      {"solve, MUMPS", &Contest::mumps, &Total, false},
      {"first mesh", &Contest::exact, &Total, true},
      {"first mesh, limited memory", &Contest::limited_memory, &Total, false},
      {"first mesh, differences", &Contest::differences, &Total, true}};
  return measures;
}

using Filter = std::function<bool(const Contest&)>;

/// The quantities of all rounds, as rows and ratios.
class Tally {
 public:
  void AddRound(const std::vector<Contest>& contests) {
    seconds_.emplace_back(Measures().size());
    for (std::size_t m = 0; m < Measures().size(); ++m) {
      for (const Contest& contest : contests) {
        const Measure& measure = Measures()[m];
        seconds_.back()[m].push_back(measure.seconds((contest.*measure.variant).sample()));
      }
    }
  }

  std::vector<BenchmarkRow> Rows(const std::vector<Contest>& contests) const {
    std::vector<BenchmarkRow> rows;
    for (const Measure& measure : Measures()) {
      rows.push_back(Row("suite: " + NameWithFailures(measure, contests), measure.name, contests,
                         [](const Contest&) { return true; }));
    }
    for (const Contest& contest : contests) {
      for (const Measure& measure : Measures()) {
        if (!measure.by_problem) continue;
        const bool solved = (contest.*measure.variant).sample().solved;
        rows.push_back(Row(contest.name + ": " + measure.name + (solved ? "" : " (unsolved)"),
                           measure.name, contests,
                           [&](const Contest& other) { return &other == &contest; }));
      }
    }
    return rows;
  }

  /// Median over rounds of sums over the problems that count, slow / fast.
  double Ratio(const std::string& slow, const std::string& fast,
               const std::vector<Contest>& contests, const Filter& counts) const {
    const std::vector<double> numerators = Sums(slow, contests, counts);
    const std::vector<double> denominators = Sums(fast, contests, counts);
    std::vector<double> ratios;
    for (std::size_t i = 0; i < numerators.size(); ++i) {
      ratios.push_back(numerators[i] / denominators[i]);
    }
    return Median(ratios);
  }

 private:
  static std::string NameWithFailures(const Measure& measure,
                                      const std::vector<Contest>& contests) {
    const auto unsolved = std::count_if(contests.begin(), contests.end(), [&](const Contest& c) {
      return !(c.*measure.variant).sample().solved;
    });
    if (unsolved == 0) return measure.name;
    return fmt::format("{} ({} of {} unsolved)", measure.name, unsolved, contests.size());
  }

  /// s, by round.
  std::vector<double> Sums(const std::string& name, const std::vector<Contest>& contests,
                           const Filter& counts) const {
    const auto measure = std::find_if(Measures().begin(), Measures().end(),
                                      [&](const Measure& m) { return m.name == name; });
    std::vector<double> sums;
    for (const auto& round : seconds_) {
      sums.push_back(0);
      for (std::size_t c = 0; c < contests.size(); ++c) {
        if (counts(contests[c])) sums.back() += round.at(measure - Measures().begin())[c];
      }
    }
    return sums;
  }

  BenchmarkRow Row(const std::string& title, const std::string& name,
                   const std::vector<Contest>& contests, const Filter& counts) const {
    std::vector<double> rounds = Sums(name, contests, counts);
    for (double& seconds : rounds) seconds *= 1e6;
    return {title, Median(rounds), rounds};
  }

  std::vector<std::vector<std::vector<double>>> seconds_;  // by round, measure, problem
};

void MeasureRound(std::vector<Contest>* contests, const std::function<void()>& advance) {
  for (Contest& contest : *contests) {
    advance();
    for (const auto variant : {&Contest::ours, &Contest::mumps, &Contest::exact,
                               &Contest::limited_memory, &Contest::differences}) {
      (contest.*variant).Measure();
    }
  }
}

/// Each thread poses the problems anew: functions may keep workspaces.
double Throughput(const std::vector<RegressionProblem>& problems) {
  const auto worker = [&]() -> std::function<void(int)> {
    auto posed = std::make_shared<std::vector<std::unique_ptr<OptimalControlProblem>>>();
    for (const RegressionProblem& problem : problems) posed->push_back(problem.build());
    return [posed, &problems](int i) {
      const std::size_t k = static_cast<std::size_t>(i) % problems.size();
      SolveFirstMesh(*(*posed)[k], problems[k], Derivatives::kExact, 0);
    };
  };
  return TwoThreadThroughput(worker, static_cast<int>(problems.size()), kRounds);
}

}  // namespace

BenchmarkReport BenchCollocation(const models::RobotModel& robot,
                                 const std::function<void(int, int)>& progress) {
  std::vector<RegressionProblem> problems = RegressionProblems();
  const std::size_t num_without_robot = problems.size();
  for (RegressionProblem& problem : RobotProblems(robot)) problems.push_back(std::move(problem));
  const int steps = (1 + kRounds) * static_cast<int>(problems.size());
  auto advance = [&, step = 0]() mutable { progress(step++, steps); };
  std::vector<Contest> contests;
  for (const RegressionProblem& problem : problems) {
    advance();
    contests.push_back(ContestOf(problem, contests.size() >= num_without_robot));
  }
  Tally tally;
  for (int round = 0; round < kRounds; ++round) {
    MeasureRound(&contests, std::ref(advance));
    tally.AddRound(contests);
  }
  progress(steps, steps);
  const double throughput = Throughput(problems);
  const auto spatial_step = BenchSpatialStep(robot, kSpatialGuesses, progress);

  const Filter all = [](const Contest&) { return true; };
  const Filter robots = [](const Contest& contest) { return contest.is_robot; };
  BenchmarkReport report;
  report.rows = tally.Rows(contests);
  report.ratios = {
      {"kkt_speedup", tally.Ratio("linear algebra, MUMPS", "linear algebra", contests, all),
       "linear algebra with MUMPS / ours"},
      {"exact_derivative_speedup",
       tally.Ratio("first mesh, differences", "first mesh", contests, robots),
       "robot problems: differences, limited memory / exact derivatives"},
      {"exact_derivative_speedup_suite",
       tally.Ratio("first mesh, differences", "first mesh", contests, all), "all problems"},
      {"exact_hessian_speedup",
       tally.Ratio("first mesh, limited memory", "first mesh", contests, all),
       "limited-memory Hessian / exact"},
      {"two_thread_throughput", throughput, "solves by two threads / by one"}};
  report.groups = {{"spatial_step", spatial_step}};
  return report;
}

}  // namespace possibility::experiments
