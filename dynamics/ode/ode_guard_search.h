#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "dynamics/ode/bracketed_root.h"
#include "dynamics/ode/ode_integrator.h"

namespace possibility::dynamics {

/// Where guards fired within one step.
struct GuardCrossing {
  double time = 0;
  std::vector<int> guards;  ///< ascending
};

/// Follows the guards of an OdeProblem along its trajectory and finds their first crossing in the
/// watched direction. Each guard has a side (the sign it last had). It fires when it reaches zero
/// from the side that its direction names.
class GuardSearch {
 public:
  /// Both must outlive the search.
  GuardSearch(const OdeProblem& problem, const OdeSettings& settings);

  /// Whether what has been added to the trajectory since the last search is worth a search: the
  /// spacing that the settings ask for, or less soon after the start, where guards change quickly.
  bool IsDue(double time) const;
  /// The first crossing since the last search.
  /// @throws OdeError if a guard is not finite.
  std::optional<GuardCrossing> Search(const OdeTrajectory& trajectory);

  long evaluations() const { return evaluations_; }

 private:
  /// Greatest spacing of evaluations, s.
  double Spacing() const;
  struct Bracket {
    int guard = 0;
    RootPoint before, after;  ///< with the guard's height above `level`
    double level = 0;         ///< fires there; 0 unless the guard leaves a zero of its own
  };

  void Evaluate(double time, const Eigen::VectorXd& state, Eigen::VectorXd* values);
  double Zero(int guard) const;
  double ValueAt(const OdeTrajectory& trajectory, double time, int guard);
  bool Watched(int guard, double from_side) const;
  std::optional<Bracket> LeaveZero(const OdeTrajectory& trajectory, RootPoint begin, RootPoint end,
                                   int guard);
  std::vector<Bracket> Brackets(const OdeTrajectory& trajectory, double end);
  GuardCrossing FirstCrossing(const OdeTrajectory& trajectory,
                              const std::vector<Bracket>& brackets);
  double Above(const OdeTrajectory& trajectory, double time, const Bracket& bracket);
  double Root(const OdeTrajectory& trajectory, const Bracket& bracket);

  const OdeProblem& problem_;
  const OdeSettings& settings_;
  double searched_;         ///< s: the end of the last search
  Eigen::VectorXd values_;  ///< at `searched_`
  Eigen::VectorXd scratch_;
  std::vector<double> sides_;  ///< -1 or 1; 0: counts as zero since the start
  long evaluations_ = 0;
};

}  // namespace possibility::dynamics
