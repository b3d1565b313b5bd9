// Errors of a transcribed motion in its constraints between the points where they were imposed.
#include "collocation/study/mesh_error.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace possibility::collocation {

namespace {

/// Evaluates the equality constraints of one phase anywhere along a trajectory.
class MeshErrorEstimate {
 public:
  MeshErrorEstimate(const OptimalControlProblem& problem, const Trajectory& trajectory, int phase)
      : phase_(problem.phase(phase)),
        motion_(trajectory.phases[phase]),
        parameters_(trajectory.parameters) {}

  /// Greatest integral of |residual| / scale over one mesh interval, by the midpoint rule; infinite
  /// if a function is undefined there.
  double Of(int interval) const {
    constexpr int kSamples = 10;
    const double begin = motion_.mesh[interval];
    const double share = motion_.mesh[interval + 1] - begin;
    double greatest = 0;
    for (const Phase::PathConstraint& constraint : phase_.constraints()) {
      if (constraint.at != At::kEverywhere && constraint.at != At::kAfterStart) continue;
      Eigen::VectorXd sum = Eigen::VectorXd::Zero(constraint.function->num_outputs());
      for (int i = 0; i < kSamples; ++i) {
        sum += Residual(constraint, begin + share * (i + 0.5) / kSamples);
      }
      const double h = share * motion_.duration / kSamples;
      if (sum.size() == 0) continue;
      const double error = sum.allFinite() ? h * sum.maxCoeff() : kInfinity;
      greatest = std::max(greatest, error);
    }
    return greatest;
  }

 private:
  double ValueOf(const Variable& variable, double s) const {
    switch (variable.kind) {
      case VariableKind::kCoordinate:
        return motion_.Coordinates(s, variable.order)[variable.index];
      case VariableKind::kControl:
        return motion_.Controls(s)[variable.index];
      case VariableKind::kParameter:
        return parameters_[variable.index];
      case VariableKind::kDuration:
        return motion_.duration;
      case VariableKind::kTime:
        return motion_.begin + s * motion_.duration;
    }
    return 0;
  }

  /// |residual| / scale of the rows that are equalities, 0 for the others.
  Eigen::VectorXd Residual(const Phase::PathConstraint& constraint, double s) const {
    Function& f = *constraint.function;
    Eigen::VectorXd z(f.num_inputs());
    for (int i = 0; i < f.num_inputs(); ++i) z[i] = ValueOf(constraint.arguments[i], s);
    Eigen::VectorXd y(f.num_outputs());
    try {
      f.Evaluate(z, &y);
    } catch (const std::runtime_error&) {  // not defined here
      y.setConstant(kInfinity);
      return y;
    }
    for (int o = 0; o < f.num_outputs(); ++o) {
      const Bounds& bounds = constraint.bounds[o];
      y[o] =
          bounds.lower == bounds.upper ? std::abs(y[o] - bounds.lower) / constraint.scales[o] : 0;
    }
    return y;
  }

  const Phase& phase_;
  const PhaseTrajectory& motion_;
  const Eigen::VectorXd& parameters_;
};

}  // namespace

std::vector<std::vector<double>> MeshErrors(const OptimalControlProblem& problem,
                                            const Trajectory& trajectory) {
  std::vector<std::vector<double>> errors;
  for (int p = 0; p < problem.num_phases(); ++p) {
    const MeshErrorEstimate estimate(problem, trajectory, p);
    auto& of_phase = errors.emplace_back();
    const int intervals = static_cast<int>(trajectory.phases[p].mesh.size()) - 1;
    for (int i = 0; i < intervals; ++i) of_phase.push_back(estimate.Of(i));
  }
  return errors;
}

Mesh Refined(const Mesh& mesh, const std::vector<double>& errors, double tolerance, int order) {
  constexpr int kMostParts = 4;
  Mesh refined = {mesh.front()};
  for (std::size_t i = 0; i + 1 < mesh.size(); ++i) {
    int parts = 1;
    if (errors[i] > tolerance) {
      // The error of an interval is proportional to its length to the power order + 1.
      const double wanted = std::ceil(std::pow(errors[i] / tolerance, 1.0 / (order + 1)));
      parts =
          std::isfinite(wanted) ? std::clamp(static_cast<int>(wanted), 2, kMostParts) : kMostParts;
    }
    for (int part = 1; part < parts; ++part) {
      refined.push_back(mesh[i] + (mesh[i + 1] - mesh[i]) * part / parts);
    }
    refined.push_back(mesh[i + 1]);
  }
  return refined;
}

}  // namespace possibility::collocation
