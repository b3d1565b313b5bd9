#include "experiments/peers/slsqp_solver.h"

#include <fmt/format.h>
#include <nlopt.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <vector>

#include "collocation/diagnosis/multiplier_estimate.h"
#include "collocation/solver/solve_clock.h"
#include "collocation/solver/solver_input.h"
#include "collocation/solver/violation.h"
#include "collocation/solver/watched_program.h"

namespace possibility::experiments {
namespace {

using collocation::SolverGuess;
using collocation::SolverOptions;
using collocation::SolverResult;
using collocation::SolverStatus;
using Eigen::VectorXd;

using Log = std::function<void(const collocation::SolverIteration&)>;
using NloptHandle = std::unique_ptr<nlopt_opt_s, decltype(&nlopt_destroy)>;

// SLSQP has no test of optimality, so it runs until it makes no progress.
constexpr double kLeastProgress = 1e-15;
constexpr int kMostStarts = 6;
constexpr int kMostFailures = 50;  // evaluations one after the other
constexpr double kBalance = 1e-6;  // of gradients
constexpr double kNear = 1e-7;     // a bound that holds

/// sign (g_row - bound), which has to be 0 or at most 0.
struct Side {
  int row = 0;
  double sign = 1;
  double bound = 0;
};

/// One solve, whose callbacks NLopt calls.
class SlsqpRun {
 public:
  SlsqpRun(collocation::NonlinearProgram* program, const SolverOptions& options,
           collocation::SolveClock* clock, const Log& log, SolverResult* result);

  /// Runs from result->x, which then has the best point.
  nlopt_result Run();
  const collocation::WatchedProgram& program() const { return program_; }
  bool used_all_iterations() const { return iterations_ > options_.max_iterations; }

 private:
  static double Objective(unsigned, const double* x, double* gradient, void* run) {
    return static_cast<SlsqpRun*>(run)->ObjectiveAt(x, gradient);
  }
  static void Equalities(unsigned, double* values, unsigned, const double* x, double* gradients,
                         void* run) {
    auto& self = *static_cast<SlsqpRun*>(run);
    self.SidesAt(self.equalities_, x, values, gradients);
  }
  static void Inequalities(unsigned, double* values, unsigned, const double* x, double* gradients,
                           void* run) {
    auto& self = *static_cast<SlsqpRun*>(run);
    self.SidesAt(self.inequalities_, x, values, gradients);
  }

  double ObjectiveAt(const double* x, double* gradient);
  void SidesAt(const std::vector<Side>& sides, const double* x, double* values, double* gradients);
  /// Makes full_ the program's variables. NLopt sees those that are not fixed.
  void Expand(const double* x);
  bool Report(double objective);
  double Stop() {
    nlopt_force_stop(nlopt_.get());
    return HUGE_VAL;
  }

  collocation::WatchedProgram program_;
  const SolverOptions& options_;
  collocation::SolveClock* clock_;
  SolverResult* result_;
  NloptHandle nlopt_;
  std::vector<int> free_;
  std::vector<Side> equalities_, inequalities_;
  VectorXd full_, gradient_, rows_, jacobian_;
  int iterations_ = 0;
  int failures_ = 0;
};

std::vector<int> FreeVariables(const collocation::NonlinearProgram& program) {
  std::vector<int> free;
  for (int i = 0; i < program.num_variables(); ++i) {
    if (program.lower()[i] < program.upper()[i]) free.push_back(i);
  }
  return free;
}

SlsqpRun::SlsqpRun(collocation::NonlinearProgram* program, const SolverOptions& options,
                   collocation::SolveClock* clock, const Log& log, SolverResult* result)
    : program_(program, clock, log, result),
      options_(options),
      clock_(clock),
      result_(result),
      nlopt_(nullptr, &nlopt_destroy),
      free_(FreeVariables(*program)),
      full_(result->x),
      gradient_(program->num_variables()),
      rows_(program->num_constraints()),
      jacobian_(program->jacobian_pattern().size()) {
  full_ = full_.cwiseMax(program->lower()).cwiseMin(program->upper());
  for (int row = 0; row < program->num_constraints(); ++row) {
    const double lower = program->constraint_lower()[row];
    const double upper = program->constraint_upper()[row];
    if (lower == upper) {
      equalities_.push_back({row, 1, lower});
      continue;
    }
    if (std::isfinite(lower)) inequalities_.push_back({row, -1, lower});
    if (std::isfinite(upper)) inequalities_.push_back({row, 1, upper});
  }
}

void SlsqpRun::Expand(const double* x) {
  for (std::size_t k = 0; k < free_.size(); ++k) full_[free_[k]] = x[k];
}

bool SlsqpRun::Report(double objective) {
  result_->x = full_;
  if (!program_.Constraints(full_.data(), rows_.data())) return false;
  collocation::SolverIteration iteration;
  iteration.number = iterations_++;
  iteration.objective = objective;
  iteration.primal_infeasibility = collocation::WorstViolation(program_.inner(), full_, rows_).size;
  return program_.Report(iteration) && !used_all_iterations();
}

double SlsqpRun::ObjectiveAt(const double* x, double* gradient) {
  Expand(x);
  double value = 0;
  const bool good = program_.Objective(full_.data(), &value);
  if (!clock_->Proceed() || program_.has_thrown()) return Stop();
  if (!good) {  // an infinite value makes SLSQP shorten its step, but not at its start
    return result_->history.empty() || ++failures_ > kMostFailures ? Stop() : HUGE_VAL;
  }
  failures_ = 0;
  if (gradient == nullptr) return value / options_.objective_size;
  if (!program_.Gradient(full_.data(), gradient_.data()) || !Report(value)) return Stop();
  for (std::size_t k = 0; k < free_.size(); ++k) {
    gradient[k] = gradient_[free_[k]] / options_.objective_size;
  }
  return value / options_.objective_size;
}

void SlsqpRun::SidesAt(const std::vector<Side>& sides, const double* x, double* values,
                       double* gradients) {
  Expand(x);
  const bool good = program_.Constraints(full_.data(), rows_.data());
  for (std::size_t s = 0; s < sides.size(); ++s) {
    const auto& [row, sign, bound] = sides[s];
    values[s] = good ? sign * (rows_[row] - bound) : HUGE_VAL;
  }
  if (gradients == nullptr) return;
  if (!good || !program_.Jacobian(full_.data(), jacobian_.data())) {
    Stop();
    return;
  }
  std::fill(gradients, gradients + sides.size() * free_.size(), 0.0);
  std::vector<int> place(program_.inner().num_variables(), -1);
  for (std::size_t k = 0; k < free_.size(); ++k) place[free_[k]] = static_cast<int>(k);
  std::vector<std::vector<std::size_t>> sides_of(program_.inner().num_constraints());
  for (std::size_t s = 0; s < sides.size(); ++s) sides_of[sides[s].row].push_back(s);
  const collocation::SparsityPattern& pattern = program_.inner().jacobian_pattern();
  for (int k = 0; k < pattern.size(); ++k) {
    const int column = place[pattern.columns[k]];
    if (column < 0) continue;
    for (const std::size_t s : sides_of[pattern.rows[k]]) {
      gradients[s * free_.size() + column] += sides[s].sign * jacobian_[k];
    }
  }
}

nlopt_result SlsqpRun::Run() {
  const auto n = static_cast<unsigned>(free_.size());
  nlopt_ = NloptHandle(nlopt_create(NLOPT_LD_SLSQP, n), &nlopt_destroy);
  if (!nlopt_) return NLOPT_OUT_OF_MEMORY;
  VectorXd x = full_(free_);
  const VectorXd lower = program_.inner().lower()(free_), upper = program_.inner().upper()(free_);
  nlopt_set_lower_bounds(nlopt_.get(), lower.data());
  nlopt_set_upper_bounds(nlopt_.get(), upper.data());
  nlopt_set_min_objective(nlopt_.get(), &Objective, this);
  const auto tolerances = [&](const std::vector<Side>& sides) {
    return std::vector<double>(sides.size(), options_.constraint_tolerance);
  };
  if (!equalities_.empty()) {
    nlopt_add_equality_mconstraint(nlopt_.get(), static_cast<unsigned>(equalities_.size()),
                                   &Equalities, this, tolerances(equalities_).data());
  }
  if (!inequalities_.empty()) {
    nlopt_add_inequality_mconstraint(nlopt_.get(), static_cast<unsigned>(inequalities_.size()),
                                     &Inequalities, this, tolerances(inequalities_).data());
  }
  nlopt_set_ftol_rel(nlopt_.get(), kLeastProgress);
  nlopt_set_ftol_abs(nlopt_.get(), kLeastProgress);
  double objective = 0;
  const nlopt_result end = nlopt_optimize(nlopt_.get(), x.data(), &objective);
  if (end != NLOPT_FORCED_STOP) {  // otherwise it stays at the last iterate
    Expand(x.data());
    result_->x = full_;
  }
  return end;
}

std::string EndText(nlopt_result end) {
  const char* name = nlopt_result_to_string(end);
  return fmt::format("SLSQP ended with {}", name ? name : "an unknown status");
}

/// First-order conditions at the end, relative to the objective's size.
class Ending {
 public:
  /// `stopped`: from outside, when the conditions do not matter.
  Ending(collocation::NonlinearProgram* program, const SolverOptions& options, bool stopped,
         SolverResult* result)
      : worst_(EvaluateResult(program, result)) {
    if (stopped) return;
    try {
      const auto estimate = EstimateMultipliers(program, result->x, kNear);
      result->constraint_multipliers = estimate.rows;
      result->lower_multipliers = estimate.lower;
      result->upper_multipliers = estimate.upper;
      residual_ = estimate.residual / std::max(options.objective_size, estimate.gradient);
    } catch (const std::runtime_error&) {  // undefined here
    }
    const bool feasible = worst_.size <= options.constraint_tolerance;
    const double tolerance = std::max(kBalance, options.tolerance);
    solved_ = feasible && residual_ <= tolerance;
    acceptable_ = feasible && residual_ <= 100 * tolerance;
  }

  const collocation::Violation& worst() const { return worst_; }
  double residual() const { return residual_; }
  bool solved() const { return solved_; }
  bool acceptable() const { return acceptable_; }

 private:
  collocation::Violation worst_;
  double residual_ = HUGE_VAL;
  bool solved_ = false, acceptable_ = false;
};

std::string FailureText(const SlsqpRun& run, const Ending& ending, const SolverOptions& options,
                        nlopt_result end) {
  std::string text = EndText(end);
  if (ending.worst().size > options.constraint_tolerance) {
    text += fmt::format("; {} is off by {:.3g}", ending.worst().name, ending.worst().own_size);
  } else {
    text += fmt::format("; the gradients are off balance by {:.3g}", ending.residual());
  }
  if (run.program().culprit().empty()) return text;
  return text + "; last evaluation that failed: " + run.program().culprit();
}

void Conclude(const SlsqpRun& run, const Ending& ending, const SolverOptions& options,
              const collocation::SolveClock& clock, nlopt_result end, SolverResult* result) {
  using Stop = collocation::SolveClock::Stop;
  if (clock.stop() == Stop::kCancelled) {
    result->status = SolverStatus::kCancelled;
    result->message = "cancelled";
  } else if (clock.stop() == Stop::kTimeLimit) {
    result->status = SolverStatus::kTimeLimit;
    result->message = fmt::format("the time limit of {} s is over", options.time_limit);
  } else if (ending.solved()) {
    result->status = SolverStatus::kSolved;
    result->message = "solved";
  } else if (ending.acceptable()) {
    result->status = SolverStatus::kAcceptable;
    result->message = "solved to the acceptable level only";
  } else if (run.used_all_iterations()) {
    result->status = SolverStatus::kIterationLimit;
    result->message = fmt::format("{} iterations were not enough", options.max_iterations);
  } else if (result->history.empty() && !run.program().culprit().empty()) {
    result->status = SolverStatus::kInvalidNumber;
    result->message = run.program().culprit() + " at the starting point";
  } else {
    result->status = SolverStatus::kFailed;
    result->message = FailureText(run, ending, options, end);
  }
}

void CheckSlsqpInput(const collocation::NonlinearProgram& program, const SolverOptions& options) {
  if (program.num_variables() > kMostSlsqpVariables) {
    throw std::invalid_argument(
        fmt::format("SLSQP has dense matrices: {} variables are more than {}",
                    program.num_variables(), kMostSlsqpVariables));
  }
  if (!options.ipopt.empty()) {
    throw std::invalid_argument(
        fmt::format("SLSQP has no option '{}', it is Ipopt's", options.ipopt.front().first));
  }
}

class Slsqp : public collocation::NonlinearSolver {
 public:
  std::string name() const override { return "slsqp"; }
  bool has_multipliers() const override { return true; }

  SolverResult Solve(collocation::NonlinearProgram* program, const SolverGuess& guess,
                     const SolverOptions& options, const CancellationToken& cancellation,
                     const Log& log) const override {
    CheckSolverInput(*program, guess);
    CheckSlsqpInput(*program, options);
    collocation::SolveClock clock(options.time_limit, cancellation);
    SolverResult result;
    result.x = guess.x;
    result.constraint_multipliers.setZero(program->num_constraints());
    result.lower_multipliers.setZero(program->num_variables());
    result.upper_multipliers.setZero(program->num_variables());
    SlsqpRun run(program, options, &clock, log, &result);
    // Each start forgets a Hessian that may have gone astray.
    double residual = HUGE_VAL;
    for (int start = 0; start < kMostStarts; ++start) {
      const nlopt_result end = run.Run();
      run.program().Rethrow();
      const bool stopped = clock.stop() != collocation::SolveClock::Stop::kNone;
      const Ending ending(program, options, stopped, &result);
      Conclude(run, ending, options, clock, end, &result);
      const bool over =
          result.status != SolverStatus::kFailed && result.status != SolverStatus::kAcceptable;
      const bool stuck = ending.residual() > 0.5 * residual;
      if (over || stuck || end == NLOPT_FORCED_STOP) break;
      residual = ending.residual();
    }
    result.times.total = clock.Seconds();
    result.times.rest =
        std::max(0.0, result.times.total - result.times.functions - result.times.derivatives);
    return result;
  }
};

}  // namespace

const collocation::NonlinearSolver& SlsqpSolver() {
  static const Slsqp solver;
  return solver;
}

}  // namespace possibility::experiments
