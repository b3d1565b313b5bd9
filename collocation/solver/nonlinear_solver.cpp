#include "collocation/solver/nonlinear_solver.h"

namespace possibility::collocation {
namespace {

class WrappedIpopt : public NonlinearSolver {
 public:
  std::string name() const override { return "ipopt"; }
  bool has_multipliers() const override { return true; }
  SolverResult Solve(NonlinearProgram* program, const SolverGuess& guess,
                     const SolverOptions& options, const CancellationToken& cancellation,
                     const std::function<void(const SolverIteration&)>& log) const override {
    return collocation::Solve(program, guess, options, cancellation, log);
  }
};

}  // namespace

const NonlinearSolver& IpoptSolver() {
  static const WrappedIpopt solver;
  return solver;
}

}  // namespace possibility::collocation
