#pragma once

#include <Eigen/Core>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/cancellation_token.h"
#include "dynamics/ode/ode_export.h"
#include "dynamics/ode/ode_trajectory.h"

namespace possibility::dynamics {

/// Writes dx/dt (n) at time t (s) and state x (n). A result that is not finite makes the
/// integrator try a shorter step.
using OdeRate = std::function<void(double t, const Eigen::Ref<const Eigen::VectorXd>& x,
                                   Eigen::Ref<Eigen::VectorXd> rate)>;
/// Writes the values of all guards at time t (s) and state x (n).
using OdeGuardFunction = std::function<void(double t, const Eigen::Ref<const Eigen::VectorXd>& x,
                                            Eigen::Ref<Eigen::VectorXd> values)>;
/// Value of one guard.
using OdeGuardValue =
    std::function<double(double t, const Eigen::Ref<const Eigen::VectorXd>& x, int guard)>;

/// Writes an approximation of the derivative of the rate with respect to the state (n x n) at time
/// t (s) and state x (n). It decides how fast the integrator converges, not to what.
using OdeJacobian = std::function<void(double t, const Eigen::Ref<const Eigen::VectorXd>& x,
                                       Eigen::Ref<Eigen::MatrixXd> jacobian)>;

enum class GuardDirection { kFalling, kRising, kBoth };

struct OdeGuard {
  GuardDirection direction = GuardDirection::kFalling;
  /// Whether a guard that starts at zero and leaves it in its direction fires at the start; kBoth
  /// never does.
  bool fires_from_zero = true;
  /// Whether a guard that starts beyond zero counts as one that starts at zero. Otherwise it fires
  /// only after it has come back.
  bool beyond_is_zero = false;
  /// A guard that starts at most this far from zero counts as zero until it is farther off: it
  /// fires there if it is then beyond zero, else at zero as any other. OdeSettings::guard_zero if
  /// that is more.
  double zero = 0;
};

enum class OdeMethod {
  kAdams,  ///< orders 1 to 12, fixed-point iteration: non-stiff systems
  kBdf     ///< orders 1 to 5, Newton iteration with a dense Jacobian: stiff systems
};

struct OdeProblem {
  OdeRate rate;
  OdeJacobian jacobian;  ///< for kBdf; empty: by differences, n evaluations of the rate each
  /// Number of leading components whose rates, in `jacobian`, depend on the other components alone:
  /// the positions of a mechanical system. Its linear systems then cost a fraction.
  int positions = 0;
  double start_time = 0;
  double end_time = 0;
  Eigen::VectorXd start;           ///< n
  std::vector<OdeGuard> guards;    ///< the first that crosses zero ends the integration
  OdeGuardFunction guard_values;   ///< needed if there are guards
  OdeGuardValue guard_value = {};  ///< for speed; empty: guard_values serves
};

struct OdeSettings {
  OdeMethod method = OdeMethod::kAdams;
  double relative_tolerance = 1e-9;
  double absolute_tolerance = 1e-10;
  /// n, one per component in place of `absolute_tolerance`; empty: not used.
  Eigen::VectorXd absolute_tolerances;
  double max_step = std::numeric_limits<double>::infinity();  ///< s
  int max_steps = 100'000;
  /// Guards are evaluated about every max_step / guard_samples, and more often soon after the
  /// start; without a max_step this many times a step. Two crossings closer than that may be
  /// missed.
  int guard_samples = 2;
  /// |guard| up to this counts as zero until it is more, for the first time since the start.
  double guard_zero = 1e-11;
  /// s: the time of a crossing is found to within this, or rounding if that is more.
  double guard_resolution = 0;
  /// s: guards that cross within this time after the first fire together with it.
  double simultaneous = 1e-9;
  /// Asked before every step (OdeEnd::kCancelled).
  CancellationToken cancellation;
};

enum class OdeEnd { kTime, kGuard, kCancelled };

struct OdeStatistics {
  long steps = 0;
  long rate_evaluations = 0;  ///< including those for Jacobians by differences
  long jacobian_evaluations = 0;
  long guard_evaluations = 0;
  long error_test_failures = 0;
};

struct OdeSolution {
  OdeEnd end = OdeEnd::kTime;
  double time = 0;          ///< s; at a guard: its first instant at or beyond zero
  Eigen::VectorXd state;    ///< n, at `time`
  std::vector<int> guards;  ///< ascending: those that fired
  OdeTrajectory trajectory;
  OdeStatistics statistics;
};

/// The integrator gave up. The message is one line: the time reached, the reason, and the component
/// of the state with the greatest error estimate.
class POSSIBILITY_ODE_API OdeError : public std::runtime_error {
 public:
  OdeError(const std::string& message, double time, int component);
  ~OdeError() override;
  double time() const { return time_; }
  int component() const { return component_; }  ///< -1 if no component is to blame

 private:
  double time_;
  int component_;
};

/// Integrates with CVODE (SUNDIALS: Hindmarsh et al. 2005), whose local error estimates stay within
/// the tolerances, until the end time, a guard or cancellation. Reentrant.
/// @throws std::invalid_argument for invalid sizes, tolerances or numbers; OdeError if the
/// integrator gives up or a guard is not finite. Exceptions of `rate`, `jacobian`, `guard_values`
/// and `cancellation` pass through.
POSSIBILITY_ODE_API OdeSolution Integrate(const OdeProblem& problem,
                                          const OdeSettings& settings = {});

}  // namespace possibility::dynamics
