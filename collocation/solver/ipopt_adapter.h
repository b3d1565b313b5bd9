#pragma once

#include <IpTNLP.hpp>
#include <functional>

#include "collocation/solver/solve_clock.h"
#include "collocation/solver/solver.h"
#include "collocation/solver/watched_program.h"

namespace possibility::collocation {

/// Presents a NonlinearProgram to Ipopt. Evaluations that fail or are not finite are reported to
/// Ipopt as such. Ipopt's last iterate is stored.
class IpoptAdapter : public Ipopt::TNLP {
 public:
  using Log = std::function<void(const SolverIteration&)>;

  /// Everything passed must outlive the adapter. `result` receives the iterate, history, counts and
  /// times.
  IpoptAdapter(NonlinearProgram* program, const SolverGuess& guess, SolveClock* clock,
               const Log& log, SolverResult* result);

  const WatchedProgram& program() const { return program_; }

  bool get_nlp_info(int& n, int& m, int& jacobian_entries, int& hessian_entries,
                    IndexStyleEnum& index_style) override;
  bool get_bounds_info(int n, double* x_lower, double* x_upper, int m, double* g_lower,
                       double* g_upper) override;
  bool get_starting_point(int n, bool init_x, double* x, bool init_z, double* z_lower,
                          double* z_upper, int m, bool init_lambda, double* lambda) override;
  bool eval_f(int n, const double* x, bool new_x, double& value) override;
  bool eval_grad_f(int n, const double* x, bool new_x, double* gradient) override;
  bool eval_g(int n, const double* x, bool new_x, int m, double* g) override;
  bool eval_jac_g(int n, const double* x, bool new_x, int m, int entries, int* rows, int* columns,
                  double* values) override;
  bool eval_h(int n, const double* x, bool new_x, double objective_factor, int m,
              const double* lambda, bool new_lambda, int entries, int* rows, int* columns,
              double* values) override;
  bool intermediate_callback(Ipopt::AlgorithmMode mode, int iteration, double objective,
                             double primal_infeasibility, double dual_infeasibility, double mu,
                             double step_norm, double regularisation, double alpha_dual,
                             double alpha_primal, int line_search_trials,
                             const Ipopt::IpoptData* data,
                             Ipopt::IpoptCalculatedQuantities* quantities) override;
  void finalize_solution(Ipopt::SolverReturn status, int n, const double* x, const double* z_lower,
                         const double* z_upper, int m, const double* g, const double* lambda,
                         double objective, const Ipopt::IpoptData* data,
                         Ipopt::IpoptCalculatedQuantities* quantities) override;

 private:
  WatchedProgram program_;
  const SolverGuess& guess_;
  SolverResult* result_;
};

}  // namespace possibility::collocation
