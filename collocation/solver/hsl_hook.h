#pragma once

#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "collocation/kkt/kkt_factorisation.h"
#include "collocation/solver/solve_clock.h"

namespace possibility::collocation {

/// Our factorisation as the linear solver of Ipopt, registered as MA27 through its public hook
/// coin/HSLLoader.h. While it lives, a scope serves the Ipopt solves of the thread that constructed
/// it, and owns the factorisations of their solver instances. Scopes of different threads share
/// nothing. An Ipopt solve with linear_solver ma27 outside any scope fails at its first matrix.
/// When the clock says stop, factorisations are abandoned and reported as failed. No exception may
/// pass through Ipopt: it would leak its work arrays.
class HslScope {
 public:
  /// `num_dual`: number of constraint rows, which come last in Ipopt's augmented system. `times`:
  /// of the augmented system's rows, as KktPairs takes them; not used for a system of another size.
  /// `clock` is asked during the computations and must outlive the scope.
  HslScope(int num_dual, std::vector<double> times, SolveClock* clock);
  ~HslScope();
  HslScope(const HslScope&) = delete;
  HslScope& operator=(const HslScope&) = delete;

  /// s spent, including analyses.
  double factorisation_seconds() const { return factorisation_seconds_; }
  double back_solve_seconds() const { return back_solve_seconds_; }
  int num_factorisations() const { return num_factorisations_; }
  int num_solves() const { return num_solves_; }

  // Called by the registered entry points. `instance` identifies the solver instance.
  void SetPattern(const void* instance, int size, int entries, const int* rows, const int* columns);
  /// Null if the computation was cancelled.
  std::optional<KktStatus> Factorise(const void* instance, const double* values,
                                     double pivot_threshold, int* num_negative);
  void Solve(const void* instance, double* right_side);
  static HslScope* Current();

 private:
  int num_dual_;
  std::vector<double> times_;
  SolveClock* clock_;
  HslScope* outer_;
  std::map<const void*, std::unique_ptr<KktFactorisation>> factorisations_;
  double factorisation_seconds_ = 0;
  double back_solve_seconds_ = 0;
  int num_factorisations_ = 0;
  int num_solves_ = 0;
};

}  // namespace possibility::collocation
