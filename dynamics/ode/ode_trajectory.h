#pragma once

#include <Eigen/Core>
#include <vector>

#include "dynamics/ode/ode_export.h"

namespace possibility::dynamics {

/// One integration step: the integrator's own interpolation polynomial,
/// x(t) = sum of column k times ((t - origin) / length)^k.
struct OdePiece {
  double origin = 0;             ///< s, end of the integrator's step
  double length = 1;             ///< s
  double end = 0;                ///< s; before `origin` if a guard cut the step
  Eigen::MatrixXd coefficients;  ///< n x (order + 1)

  POSSIBILITY_ODE_API Eigen::VectorXd State(double time) const;  ///< n
  POSSIBILITY_ODE_API Eigen::VectorXd Rate(double time) const;   ///< n, dx/dt
};

/// A solution over its whole time span, as accurate as the integration: neighbouring pieces agree
/// to the local error of a step.
class POSSIBILITY_ODE_API OdeTrajectory {
 public:
  OdeTrajectory() = default;
  /// A trajectory that starts and ends at `time`, until pieces are appended.
  OdeTrajectory(double time, const Eigen::Ref<const Eigen::VectorXd>& state);

  double start_time() const { return start_time_; }
  double end_time() const { return pieces_.empty() ? start_time_ : pieces_.back().end; }
  /// Start time and the end of every step.
  std::vector<double> StepTimes() const;
  const std::vector<OdePiece>& pieces() const { return pieces_; }

  /// n each. @throws std::invalid_argument if `time` is outside [start_time, end_time] by more
  /// than rounding.
  Eigen::VectorXd State(double time) const;
  Eigen::VectorXd Rate(double time) const;

  /// @throws std::invalid_argument if the piece ends before the trajectory does.
  void Append(OdePiece piece);
  /// Drops what comes after `time`, which must lie within the trajectory.
  void CutAt(double time);

 private:
  const OdePiece& PieceAt(double time) const;

  double start_time_ = 0;
  std::vector<OdePiece> pieces_;
};

}  // namespace possibility::dynamics
