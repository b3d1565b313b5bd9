#include "collocation/solver/solver.h"

#include <fmt/format.h>

#include <IpIpoptApplication.hpp>
#include <IpIpoptData.hpp>
#include <IpTimingStatistics.hpp>
#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "collocation/solver/hsl_hook.h"
#include "collocation/solver/ipopt_adapter.h"
#include "collocation/solver/ipopt_options.h"
#include "collocation/solver/solve_clock.h"
#include "collocation/solver/solver_input.h"
#include "collocation/solver/turn_queue.h"
#include "collocation/solver/violation.h"

namespace possibility::collocation {
namespace {

using Eigen::VectorXd;
using Ipopt::ApplicationReturnStatus;

double LargestBound(const NonlinearProgram& program) {
  double largest = 0;
  for (const VectorXd* bounds : {&program.lower(), &program.upper(), &program.constraint_lower(),
                                 &program.constraint_upper()}) {
    for (const double bound : *bounds) {
      if (std::isfinite(bound)) largest = std::max(largest, std::abs(bound));
    }
  }
  return largest;
}

/// MUMPS keeps process-wide state, so whole solves take turns.
TurnQueue& MumpsTurns() {
  static TurnQueue turns;
  return turns;
}

SolverStatus StatusOf(ApplicationReturnStatus status) {
  switch (status) {
    case Ipopt::Solve_Succeeded:
    case Ipopt::Feasible_Point_Found:
      return SolverStatus::kSolved;
    case Ipopt::Solved_To_Acceptable_Level:
      return SolverStatus::kAcceptable;
    case Ipopt::Infeasible_Problem_Detected:
      return SolverStatus::kInfeasible;
    case Ipopt::Diverging_Iterates:
      return SolverStatus::kUnbounded;
    case Ipopt::Maximum_Iterations_Exceeded:
      return SolverStatus::kIterationLimit;
    case Ipopt::Maximum_CpuTime_Exceeded:
      return SolverStatus::kTimeLimit;
    case Ipopt::Invalid_Number_Detected:
      return SolverStatus::kInvalidNumber;
    default:
      return SolverStatus::kFailed;
  }
}

std::string FailureText(ApplicationReturnStatus status) {
  switch (status) {
    case Ipopt::Search_Direction_Becomes_Too_Small:
      return "the steps became too small before the tolerances were met";
    case Ipopt::Restoration_Failed:
      return "no step made the constraints less violated";
    case Ipopt::Error_In_Step_Computation:
      return "no step could be computed";
    case Ipopt::Not_Enough_Degrees_Of_Freedom:
      return "there are fewer free variables than equality constraints";
    case Ipopt::Insufficient_Memory:
      return "out of memory";
    case Ipopt::Invalid_Option:
      return "Ipopt refuses the options";
    default:
      return fmt::format("Ipopt ended with status {}", static_cast<int>(status));
  }
}

std::string LargestVariable(const NonlinearProgram& program, const VectorXd& x) {
  int largest = 0;
  x.cwiseAbs().maxCoeff(&largest);
  return fmt::format("'{}' reached {:.3g}", program.VariableName(largest),
                     x[largest] * program.VariableScale(largest));
}

/// Whether a solve failed while its objective fell by orders of magnitude.
bool ObjectiveRanAway(const SolverResult& result) {
  constexpr double kFar = 1e12;
  const bool gave_up =
      result.status == SolverStatus::kFailed || result.status == SolverStatus::kIterationLimit;
  const double first = result.history.empty() ? 0 : std::abs(result.history.front().objective);
  return gave_up && result.objective < -kFar * std::max(1.0, first);
}

std::string Message(const NonlinearProgram& program, const SolverOptions& options,
                    const SolverResult& result, const Violation& worst, const std::string& culprit,
                    ApplicationReturnStatus ipopt_status) {
  const std::string violation =
      worst.size <= options.constraint_tolerance
          ? ""
          : fmt::format("; {} is off by {:.3g}", worst.name, worst.own_size);
  switch (result.status) {
    case SolverStatus::kSolved:
      return "solved";
    case SolverStatus::kAcceptable:
      return "solved to the acceptable level only";
    case SolverStatus::kInfeasible:
      return "a local minimum of the constraint violation" + violation;
    case SolverStatus::kUnbounded:
      return fmt::format(
          "the iterates diverge, as they do when nothing bounds the objective: it "
          "is {:.3g} and {}",
          result.objective, LargestVariable(program, result.x));
    case SolverStatus::kIterationLimit:
      return fmt::format("{} iterations were not enough{}", options.max_iterations, violation);
    case SolverStatus::kTimeLimit:
      return fmt::format("the time limit of {} s is over{}", options.time_limit, violation);
    case SolverStatus::kCancelled:
      return "cancelled";
    case SolverStatus::kInvalidNumber:
      return result.history.empty() ? culprit + " at the starting point" : culprit;
    case SolverStatus::kWrongDerivative:  // found before a solve
    case SolverStatus::kFailed:
      break;
  }
  return FailureText(ipopt_status) + violation +
         (culprit.empty() ? "" : fmt::format("; last evaluation that failed: {}", culprit));
}

/// Linear algebra times from Ipopt's own stopwatches. They do not time the factorisation of MUMPS,
/// only everything that the augmented systems take.
void ReadIpoptTimes(Ipopt::IpoptApplication* application, SolverTimes* times) {
  const auto data = application->IpoptDataObject();
  if (!Ipopt::IsValid(data)) return;
  Ipopt::TimingStatistics& statistics = data->TimingStats();
  times->back_solves = statistics.LinearSystemBackSolve().TotalWallclockTime();
  times->factorisation =
      statistics.StdAugSystemSolverMultiSolve().TotalWallclockTime() - times->back_solves;
}

/// Places along time of the rows of Ipopt's augmented system: free variables, slacks of
/// inequalities, equalities, inequalities. Empty if the program has no time.
std::vector<double> AugmentedTimes(const NonlinearProgram& program) {
  const std::vector<double> variables = program.VariableTimes();
  const std::vector<double> constraints = program.ConstraintTimes();
  std::vector<double> times, equalities, inequalities;
  if (variables.empty() || constraints.empty()) return times;
  for (std::size_t i = 0; i < variables.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    if (program.lower()[k] != program.upper()[k]) times.push_back(variables[i]);
  }
  for (std::size_t i = 0; i < constraints.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const bool is_equality = program.constraint_lower()[k] == program.constraint_upper()[k];
    (is_equality ? equalities : inequalities).push_back(constraints[i]);
  }
  for (const auto* part : {&inequalities, &equalities, &inequalities}) {
    times.insert(times.end(), part->begin(), part->end());
  }
  return times;
}

ApplicationReturnStatus RunIpopt(const SolverOptions& options, const SolverGuess& guess,
                                 const NonlinearProgram& program, SolveClock* clock,
                                 const Ipopt::SmartPtr<IpoptAdapter>& adapter, SolverTimes* times) {
  std::optional<HslScope> scope;
  if (options.linear_solver == LinearSolver::kSparseLdlt) {
    scope.emplace(program.num_constraints(), AugmentedTimes(program), clock);
  }
  const Ipopt::SmartPtr<Ipopt::IpoptApplication> application = new Ipopt::IpoptApplication(false);
  SetIpoptOptions(options, IsWarm(guess), LargestBound(program), Ipopt::GetRawPtr(application));
  ApplicationReturnStatus status = application->Initialize("");
  if (status == Ipopt::Solve_Succeeded) {
    status = application->OptimizeTNLP(Ipopt::GetRawPtr(adapter));
  }
  if (scope) {
    times->factorisation = scope->factorisation_seconds();
    times->back_solves = scope->back_solve_seconds();
  } else {
    ReadIpoptTimes(Ipopt::GetRawPtr(application), times);
  }
  return status;
}

}  // namespace

SolverResult Solve(NonlinearProgram* program, const SolverGuess& guess,
                   const SolverOptions& options, const CancellationToken& cancellation,
                   const std::function<void(const SolverIteration&)>& log) {
  CheckSolverInput(*program, guess);
  SolveClock clock(options.time_limit, cancellation);
  SolverResult result;
  result.x = guess.x;
  result.constraint_multipliers = VectorXd::Zero(program->num_constraints());
  result.lower_multipliers = VectorXd::Zero(program->num_variables());
  result.upper_multipliers = VectorXd::Zero(program->num_variables());

  const Ipopt::SmartPtr<IpoptAdapter> adapter =
      new IpoptAdapter(program, guess, &clock, log, &result);
  ApplicationReturnStatus status = Ipopt::User_Requested_Stop;
  {
    std::optional<TurnQueue::Ticket> turn;
    if (options.linear_solver == LinearSolver::kMumps) {
      turn.emplace(&MumpsTurns());
      turn->Wait(clock.token());
    }
    if (clock.Proceed()) {
      status = RunIpopt(options, guess, *program, &clock, adapter, &result.times);
    }
  }
  adapter->program().Rethrow();

  result.status = StatusOf(status);
  if (clock.stop() == SolveClock::Stop::kCancelled) result.status = SolverStatus::kCancelled;
  if (clock.stop() == SolveClock::Stop::kTimeLimit) result.status = SolverStatus::kTimeLimit;
  const Violation worst = EvaluateResult(program, &result);
  if (ObjectiveRanAway(result)) result.status = SolverStatus::kUnbounded;
  result.message = Message(*program, options, result, worst, adapter->program().culprit(), status);
  SolverTimes& times = result.times;
  times.total = clock.Seconds();
  times.rest = std::max(0.0, times.total - times.functions - times.derivatives -
                                 times.factorisation - times.back_solves);
  return result;
}

}  // namespace possibility::collocation
