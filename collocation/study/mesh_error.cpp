// Errors of a transcribed motion between the points where its problem was imposed.
#include "collocation/study/mesh_error.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "collocation/transcription/quadrature.h"

namespace possibility::collocation {

namespace {

using Eigen::VectorXd;

double Excess(double value, const Bounds& bounds) {
  return std::max({0.0, bounds.lower - value, value - bounds.upper});
}

bool IsEquality(const Bounds& bounds) { return bounds.lower == bounds.upper; }

/// What holds everywhere, perhaps the ends excepted.
bool HoldsBetween(At at) { return at != At::kStart && at != At::kEnd; }

/// Evaluates one phase of a problem anywhere along a trajectory.
class PhaseBetweenKnots {
 public:
  PhaseBetweenKnots(const OptimalControlProblem& problem, const Trajectory& trajectory, int phase)
      : phase_(problem.phase(phase)),
        motion_(trajectory.phases[phase]),
        parameters_(trajectory.parameters) {}

  int num_intervals() const { return static_cast<int>(motion_.mesh.size()) - 1; }

  /// All but the cost, by the midpoint rule.
  MeshError ErrorOf(int interval) const {
    MeshError error;
    for (const Phase::PathConstraint& constraint : phase_.constraints()) {
      if (!HoldsBetween(constraint.at)) continue;
      VectorXd equalities = VectorXd::Zero(constraint.function->num_outputs());
      VectorXd inequalities = equalities;
      ForSamples(interval, [&](const MeshPlace& at, double h) {
        const VectorXd excess = h * ExcessAt(constraint, at);
        for (Eigen::Index o = 0; o < excess.size(); ++o) {
          (IsEquality(constraint.bounds[o]) ? equalities : inequalities)[o] += excess[o];
        }
      });
      Raise(equalities, &error.dynamics);
      Raise(inequalities, &error.inequalities);
    }
    AddBounds(interval, &error);
    AddIntegrals(interval, &error);
    return error;
  }

  /// The integral costs of an interval as they were minimised.
  double TranscribedCost(int interval) const {
    return Transcribed(interval, [this](const MeshPlace& at) { return CostAt(at); });
  }

  /// The same along the motion.
  double TrueCost(int interval) const {
    return Integral(interval, [this](const MeshPlace& at) { return CostAt(at); });
  }

 private:
  /// The integral over an interval by the scheme's nodes.
  template <typename Integrand>
  double Transcribed(int interval, const Integrand& integrand) const {
    const TranscriptionScheme& scheme = motion_.scheme;
    const VectorXd weights = scheme.weights();
    double sum = 0;
    for (int node = 0; node < scheme.num_nodes(); ++node) {
      if (!scheme.HasValue(node)) continue;
      sum += weights[node] * integrand(MeshPlace{interval, scheme.nodes[node]});
    }
    return sum * LengthOf(interval);
  }

  template <typename Integrand>
  double Integral(int interval, const Integrand& integrand) const {
    double sum = 0;
    for (const QuadraturePoint& point : rule_) {
      sum += point.weight * integrand(MeshPlace{interval, point.share});
    }
    return sum * LengthOf(interval);
  }

  /// Of the phase.
  double ShareOf(const MeshPlace& place) const {
    const double begin = motion_.mesh[place.interval];
    return begin + place.share * (motion_.mesh[place.interval + 1] - begin);
  }
  double LengthOf(int interval) const {  // s
    return (motion_.mesh[interval + 1] - motion_.mesh[interval]) * motion_.duration;
  }

  /// Calls use(place, s that the sample stands for).
  template <typename Use>
  void ForSamples(int interval, const Use& use) const {
    constexpr int kSamples = 10;
    for (int i = 0; i < kSamples; ++i) {
      use(MeshPlace{interval, (i + 0.5) / kSamples}, LengthOf(interval) / kSamples);
    }
  }

  static void Raise(const VectorXd& sums, double* error) {
    if (sums.size() == 0) return;
    *error = std::max(*error, sums.allFinite() ? sums.maxCoeff() : kInfinity);
  }

  void AddBounds(int interval, MeshError* error) const {
    for (std::size_t order = 0; order < motion_.coordinates.size(); ++order) {
      VectorXd sums = VectorXd::Zero(static_cast<Eigen::Index>(phase_.coordinates().size()));
      ForSamples(interval, [&](const MeshPlace& at, double h) {
        const VectorXd values = motion_.Coordinates(at, static_cast<int>(order));
        for (Eigen::Index i = 0; i < sums.size(); ++i) {
          if (static_cast<int>(order) > phase_.OrderOf(static_cast<int>(i))) continue;
          sums[i] += h * ExcessOf(phase_.coordinates()[i][order], values[i]);
        }
      });
      Raise(sums, &error->inequalities);
    }
    VectorXd sums = VectorXd::Zero(static_cast<Eigen::Index>(phase_.controls().size()));
    ForSamples(interval, [&](const MeshPlace& at, double h) {
      const VectorXd values = motion_.Controls(at);
      for (Eigen::Index i = 0; i < sums.size(); ++i) {
        sums[i] += h * ExcessOf(phase_.controls()[i], values[i]);
      }
    });
    Raise(sums, &error->inequalities);
    AddRateBounds(interval, error);
  }

  void AddRateBounds(int interval, MeshError* error) const {
    VectorXd sums = VectorXd::Zero(static_cast<Eigen::Index>(phase_.rate_bounds().size()));
    if (sums.size() == 0) return;
    ForSamples(interval, [&](const MeshPlace& at, double h) {
      const VectorXd rates = motion_.ControlRates(ShareOf(at));
      for (Eigen::Index i = 0; i < sums.size(); ++i) {
        const Phase::RateBound& bound = phase_.rate_bounds()[i];
        sums[i] += h * Excess(rates[bound.control], bound.bounds) / bound.scale;
      }
    });
    Raise(sums, &error->inequalities);
  }

  void AddIntegrals(int interval, MeshError* error) const {
    for (const Phase::IntegralConstraint& integral : phase_.integrals()) {
      const auto integrand = [&](const MeshPlace& at) {
        return Evaluate(integral.function.get(), integral.arguments, at)[0];
      };
      const double difference =
          std::abs(Integral(interval, integrand) - Transcribed(interval, integrand));
      Raise(VectorXd::Constant(1, difference / integral.scale),
            IsEquality(integral.bounds) ? &error->dynamics : &error->inequalities);
    }
  }

  static double ExcessOf(const Phase::Quantity& quantity, double value) {
    double excess = 0;
    for (const auto& [at, bounds] : quantity.bounds) {
      if (HoldsBetween(at)) excess = std::max(excess, Excess(value, bounds));
    }
    return excess / quantity.scale;
  }

  double ValueOf(const Variable& variable, const MeshPlace& at) const {
    switch (variable.kind) {
      case VariableKind::kCoordinate:
        return motion_.Coordinates(at, variable.order)[variable.index];
      case VariableKind::kControl:
        return motion_.Controls(at)[variable.index];
      case VariableKind::kParameter:
        return parameters_[variable.index];
      case VariableKind::kDuration:
        return motion_.duration;
      case VariableKind::kTime:
        return motion_.begin + ShareOf(at) * motion_.duration;
      case VariableKind::kShare:
        return ShareOf(at);
    }
    return 0;
  }

  /// Infinite where the function is not defined.
  VectorXd Evaluate(Function* f, const std::vector<Variable>& arguments,
                    const MeshPlace& at) const {
    VectorXd z(f->num_inputs());
    for (int i = 0; i < f->num_inputs(); ++i) z[i] = ValueOf(arguments[i], at);
    VectorXd y(f->num_outputs());
    try {
      f->Evaluate(z, &y);
    } catch (const std::runtime_error&) {
      y.setConstant(kInfinity);
    }
    return y;
  }

  /// By how much each row lies outside its bounds, divided by its scale.
  VectorXd ExcessAt(const Phase::PathConstraint& constraint, const MeshPlace& at) const {
    VectorXd y = Evaluate(constraint.function.get(), constraint.arguments, at);
    for (Eigen::Index o = 0; o < y.size(); ++o) {
      if (!std::isfinite(y[o])) continue;
      y[o] = Excess(y[o], constraint.bounds[o]) / constraint.scales[o];
    }
    return y;
  }

  double CostAt(const MeshPlace& at) const {
    double sum = 0;
    for (const Phase::IntegralCost& cost : phase_.costs()) {
      sum += cost.weight * Evaluate(cost.function.get(), cost.arguments, at)[0];
    }
    return sum;
  }

  const Phase& phase_;
  const PhaseTrajectory& motion_;
  const VectorXd& parameters_;
  const std::vector<QuadraturePoint> rule_ = GaussLegendre(5);  // exact for degree 9
};

}  // namespace

double MeshError::Greatest() const { return std::max({dynamics, cost, inequalities}); }

std::vector<std::vector<MeshError>> MeshErrors(const OptimalControlProblem& problem,
                                               const Trajectory& trajectory, double objective) {
  std::vector<std::vector<MeshError>> errors;
  double magnitude = 0;
  for (int p = 0; p < problem.num_phases(); ++p) {
    const PhaseBetweenKnots phase(problem, trajectory, p);
    auto& of_phase = errors.emplace_back();
    for (int i = 0; i < phase.num_intervals(); ++i) {
      of_phase.push_back(phase.ErrorOf(i));
      const double transcribed = phase.TranscribedCost(i);
      magnitude += std::abs(transcribed);
      const double difference = std::abs(phase.TrueCost(i) - transcribed);
      of_phase.back().cost = std::isnan(difference) ? kInfinity : difference;
    }
  }
  magnitude = std::max(magnitude, std::abs(objective));
  for (auto& of_phase : errors) {
    for (MeshError& error : of_phase) {
      if (error.cost > 0) error.cost /= magnitude;
    }
  }
  return errors;
}

MeshError Worst(const std::vector<std::vector<MeshError>>& errors) {
  MeshError worst;
  for (const auto& of_phase : errors) {
    for (const MeshError& error : of_phase) {
      worst.dynamics = std::max(worst.dynamics, error.dynamics);
      worst.cost = std::max(worst.cost, error.cost);
      worst.inequalities = std::max(worst.inequalities, error.inequalities);
    }
  }
  return worst;
}

}  // namespace possibility::collocation
