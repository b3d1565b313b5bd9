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

/// What a motion is at one place of its mesh.
struct Moment {
  std::vector<VectorXd> coordinates;  ///< by order
  VectorXd controls;
  double share = 0;  ///< of the phase's duration
};

/// Evaluates one phase of a problem anywhere along a trajectory.
class PhaseBetweenKnots {
 public:
  PhaseBetweenKnots(const OptimalControlProblem& problem, const Trajectory& trajectory, int phase)
      : phase_(problem.phase(phase)),
        motion_(trajectory.phases[phase]),
        parameters_(trajectory.parameters) {
    for (const QuadraturePoint& point : GaussLegendre(5)) {  // exact for degree 9
      places_of_rule_.push_back(point.share);
      weights_of_rule_.push_back(point.weight);
    }
    for (int i = 0; i < kSamples; ++i) samples_.push_back((i + 0.5) / kSamples);
    const TranscriptionScheme& scheme = motion_.scheme;
    const VectorXd weights = scheme.weights();
    for (int node = 0; node < scheme.num_nodes(); ++node) {
      if (!scheme.HasValue(node)) continue;
      nodes_.push_back(scheme.nodes[node]);
      weights_of_nodes_.push_back(weights[node]);
    }
  }

  int num_intervals() const { return static_cast<int>(motion_.mesh.size()) - 1; }

  /// The error of an interval; the cost's is not yet divided by its size. Adds the magnitude of its
  /// cost as it was minimised.
  MeshError ErrorOf(int interval, double* cost) const {
    MeshError error;
    const std::vector<Moment> samples = MomentsOf(interval, samples_);
    const double h = LengthOf(interval) / kSamples;  // s that a sample stands for
    for (const Phase::PathConstraint& constraint : phase_.constraints()) {
      if (HoldsBetween(constraint.at)) AddConstraint(constraint, samples, h, &error);
    }
    AddBounds(samples, h, &error);
    AddRateBounds(samples, h, &error);
    if (phase_.integrals().empty() && phase_.costs().empty()) return error;
    const std::vector<Moment> nodes = MomentsOf(interval, nodes_);
    const std::vector<Moment> rule = MomentsOf(interval, places_of_rule_);
    const double length = LengthOf(interval);
    AddIntegrals(nodes, rule, length, &error);
    const auto integrand = [this](const Moment& moment) { return CostAt(moment); };
    const double transcribed = length * WeightedSum(nodes, weights_of_nodes_, integrand);
    const double difference =
        std::abs(length * WeightedSum(rule, weights_of_rule_, integrand) - transcribed);
    *cost += std::abs(transcribed);
    error.cost = std::isnan(difference) ? kInfinity : difference;
    return error;
  }

 private:
  static constexpr int kSamples = 10;

  std::vector<Moment> MomentsOf(int interval, const std::vector<double>& shares) const {
    std::vector<Moment> moments;
    moments.reserve(shares.size());
    const double begin = motion_.mesh[interval], end = motion_.mesh[interval + 1];
    for (const double share : shares) {
      Moment& moment = moments.emplace_back();
      const MeshPlace place{interval, share};
      for (std::size_t order = 0; order < motion_.coordinates.size(); ++order) {
        moment.coordinates.push_back(motion_.Coordinates(place, static_cast<int>(order)));
      }
      moment.controls = motion_.Controls(place);
      moment.share = begin + share * (end - begin);
    }
    return moments;
  }

  template <typename Integrand>
  static double WeightedSum(const std::vector<Moment>& moments, const std::vector<double>& weights,
                            const Integrand& integrand) {
    double sum = 0;
    for (std::size_t i = 0; i < moments.size(); ++i) sum += weights[i] * integrand(moments[i]);
    return sum;
  }

  double LengthOf(int interval) const {  // s
    return (motion_.mesh[interval + 1] - motion_.mesh[interval]) * motion_.duration;
  }

  static void Raise(const VectorXd& sums, double* error) {
    if (sums.size() == 0) return;
    *error = std::max(*error, sums.allFinite() ? sums.maxCoeff() : kInfinity);
  }

  /// By the midpoint rule, as are bounds.
  void AddConstraint(const Phase::PathConstraint& constraint, const std::vector<Moment>& samples,
                     double h, MeshError* error) const {
    VectorXd equalities = VectorXd::Zero(constraint.function->num_outputs());
    VectorXd inequalities = equalities;
    for (const Moment& moment : samples) {
      const VectorXd excess = h * ExcessAt(constraint, moment);
      for (Eigen::Index o = 0; o < excess.size(); ++o) {
        (IsEquality(constraint.bounds[o]) ? equalities : inequalities)[o] += excess[o];
      }
    }
    Raise(equalities, &error->dynamics);
    Raise(inequalities, &error->inequalities);
  }

  void AddBounds(const std::vector<Moment>& samples, double h, MeshError* error) const {
    for (std::size_t order = 0; order < motion_.coordinates.size(); ++order) {
      VectorXd sums = VectorXd::Zero(static_cast<Eigen::Index>(phase_.coordinates().size()));
      for (const Moment& moment : samples) {
        for (Eigen::Index i = 0; i < sums.size(); ++i) {
          if (static_cast<int>(order) > phase_.OrderOf(static_cast<int>(i))) continue;
          sums[i] += h * ExcessOf(phase_.coordinates()[i][order], moment.coordinates[order][i]);
        }
      }
      Raise(sums, &error->inequalities);
    }
    VectorXd sums = VectorXd::Zero(static_cast<Eigen::Index>(phase_.controls().size()));
    for (const Moment& moment : samples) {
      for (Eigen::Index i = 0; i < sums.size(); ++i) {
        sums[i] += h * ExcessOf(phase_.controls()[i], moment.controls[i]);
      }
    }
    Raise(sums, &error->inequalities);
  }

  void AddRateBounds(const std::vector<Moment>& samples, double h, MeshError* error) const {
    VectorXd sums = VectorXd::Zero(static_cast<Eigen::Index>(phase_.rate_bounds().size()));
    if (sums.size() == 0) return;
    for (const Moment& moment : samples) {
      const VectorXd rates = motion_.ControlRates(moment.share);
      for (Eigen::Index i = 0; i < sums.size(); ++i) {
        const Phase::RateBound& bound = phase_.rate_bounds()[i];
        sums[i] += h * Excess(rates[bound.control], bound.bounds) / bound.scale;
      }
    }
    Raise(sums, &error->inequalities);
  }

  void AddIntegrals(const std::vector<Moment>& nodes, const std::vector<Moment>& rule,
                    double length, MeshError* error) const {
    for (const Phase::IntegralConstraint& integral : phase_.integrals()) {
      const auto integrand = [&](const Moment& moment) {
        return Evaluate(integral.function.get(), integral.arguments, moment)[0];
      };
      const double difference = length * std::abs(WeightedSum(rule, weights_of_rule_, integrand) -
                                                  WeightedSum(nodes, weights_of_nodes_, integrand));
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

  double ValueOf(const Variable& variable, const Moment& moment) const {
    switch (variable.kind) {
      case VariableKind::kCoordinate:
        return moment.coordinates[variable.order][variable.index];
      case VariableKind::kControl:
        return moment.controls[variable.index];
      case VariableKind::kParameter:
        return parameters_[variable.index];
      case VariableKind::kDuration:
        return motion_.duration;
      case VariableKind::kTime:
        return motion_.begin + moment.share * motion_.duration;
      case VariableKind::kShare:
        return moment.share;
    }
    return 0;
  }

  /// Infinite where the function is not defined.
  VectorXd Evaluate(Function* f, const std::vector<Variable>& arguments,
                    const Moment& moment) const {
    VectorXd z(f->num_inputs());
    for (int i = 0; i < f->num_inputs(); ++i) z[i] = ValueOf(arguments[i], moment);
    VectorXd y(f->num_outputs());
    try {
      f->Evaluate(z, &y);
    } catch (const std::runtime_error&) {
      y.setConstant(kInfinity);
    }
    return y;
  }

  /// By how much each row lies outside its bounds, divided by its scale.
  VectorXd ExcessAt(const Phase::PathConstraint& constraint, const Moment& moment) const {
    VectorXd y = Evaluate(constraint.function.get(), constraint.arguments, moment);
    for (Eigen::Index o = 0; o < y.size(); ++o) {
      if (!std::isfinite(y[o])) continue;
      y[o] = Excess(y[o], constraint.bounds[o]) / constraint.scales[o];
    }
    return y;
  }

  double CostAt(const Moment& moment) const {
    double sum = 0;
    for (const Phase::IntegralCost& cost : phase_.costs()) {
      sum += cost.weight * Evaluate(cost.function.get(), cost.arguments, moment)[0];
    }
    return sum;
  }

  const Phase& phase_;
  const PhaseTrajectory& motion_;
  const VectorXd& parameters_;
  // Shares of an interval and weights: where the motion is sampled, where it was transcribed, and a
  // quadrature that is better than that.
  std::vector<double> samples_, nodes_, places_of_rule_;
  std::vector<double> weights_of_nodes_, weights_of_rule_;
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
      of_phase.push_back(phase.ErrorOf(i, &magnitude));
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
