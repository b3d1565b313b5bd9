#include "collocation/transcription/transcription.h"

#include <algorithm>

#include "collocation/problem/unused_quantities.h"
#include "collocation/transcription/initial_guess.h"
#include "collocation/transcription/multiplier_transfer.h"
#include "collocation/transcription/quadrature.h"
#include "collocation/transcription/trajectory_transfer.h"
#include "collocation/transcription/wrong_derivatives.h"

namespace possibility::collocation {

Transcription::Transcription(const OptimalControlProblem& problem,
                             const TranscriptionScheme& scheme, std::vector<Mesh> meshes,
                             const CancellationToken& cancellation, int threads)
    : layout_(problem, scheme, std::move(meshes)), functions_(layout_) {
  CheckEverythingIsUsed(problem);
  CheckControls();
  for (int p = 0; p < problem.num_phases(); ++p) AddDefects(p, cancellation);
  for (int p = 0; p < problem.num_phases(); ++p) {
    AddBoundsOfEnds(p);
    AddControlRates(p);
  }
  for (int p = 0; p < problem.num_phases(); ++p) {
    AddPathConstraints(p, cancellation);
    AddIntegrals(p, cancellation);
  }
  AddInstants();
  functions_.Share(threads);
  const auto copy = [](const std::vector<double>& from) {
    return Eigen::VectorXd(
        Eigen::Map<const Eigen::VectorXd>(from.data(), static_cast<Eigen::Index>(from.size())));
  };
  constraint_lower_ = copy(functions_.row_lowers());
  constraint_upper_ = copy(functions_.row_uppers());
}

void Transcription::AddDefects(int phase_index, const CancellationToken& cancellation) {
  const Phase& phase = layout_.problem().phase(phase_index);
  const PhaseLayout& layout = layout_.phase(phase_index);
  const int inside = layout_.scheme().num_nodes() - 1;
  const int n = static_cast<int>(phase.coordinates().size());
  for (int interval = 0; interval + 1 < static_cast<int>(layout.mesh.size()); ++interval) {
    cancellation.ThrowIfCancelled();
    for (int node = 1; node <= inside; ++node) {
      const int point = interval * inside + node;
      for (int c = 0; c < n; ++c) {
        for (int order = 0; order < phase.OrderOf(c); ++order) {
          const Phase::Quantity& quantity = phase.coordinates()[c][order];
          const int index = layout.coordinates[point][c][order];
          PolynomialForm form = layout_.IntegralForm(phase_index, interval, node, c, order);
          const PlacedName name{phase_index, point, "defect of " + quantity.name, -1, true};
          if (index >= 0) {
            form.monomials.push_back({index, -1, 0});
            functions_.AddFormRow(std::move(form), quantity.scale, {0, 0}, name);
            continue;
          }
          const Bounds bounds = layout_.BoundsAt(quantity, phase_index, point);
          if (bounds.lower > -kInfinity || bounds.upper < kInfinity) {
            functions_.AddFormRow(std::move(form), quantity.scale, bounds,
                                  {phase_index, point, quantity.name, -1});
          }
        }
      }
    }
  }
}

void Transcription::CheckControls() const {
  if (layout_.scheme().IsClosed()) return;
  const OptimalControlProblem& problem = layout_.problem();
  const std::string why =
      " does not go with the scheme '" + layout_.scheme().name + "', whose controls jump at knots";
  for (int p = 0; p < problem.num_phases(); ++p) {
    const Phase& phase = problem.phase(p);
    if (!phase.rate_costs().empty() || !phase.rate_bounds().empty()) {
      phase.Fail("a cost or bound of a control's rate" + why);
    }
  }
  for (const auto& [from, to] : problem.continued()) {
    if (to.variable.kind != VariableKind::kControl) continue;
    problem.Fail(problem.NameOf(to.variable) + ": that a control continues" + why);
  }
}

void Transcription::AddBoundsOfEnds(int phase_index) {
  const Phase& phase = layout_.problem().phase(phase_index);
  const std::vector<LayoutPoint>& points = layout_.phase(phase_index).points;
  const auto add = [&](Variable variable, int point, At end) {
    const Phase::Quantity& quantity = phase.Find(variable);
    const bool is_asked = std::any_of(quantity.bounds.begin(), quantity.bounds.end(),
                                      [&](const auto& bound) { return bound.first == end; });
    if (!is_asked) return;
    functions_.AddFormRow(layout_.FormOf(variable, phase_index, point), quantity.scale,
                          layout_.BoundsAt(quantity, phase_index, point),
                          {phase_index, point, quantity.name, -1});
  };
  const int last = static_cast<int>(points.size()) - 1;
  for (const auto& [point, end] : {std::pair{0, At::kStart}, {last, At::kEnd}}) {
    if (points[point].has_values) continue;
    for (int c = 0; c < static_cast<int>(phase.coordinates().size()); ++c) {
      add(phase.Coordinate(c, phase.OrderOf(c)), point, end);
    }
    for (int c = 0; c < static_cast<int>(phase.controls().size()); ++c) {
      add(phase.Control(c), point, end);
    }
  }
}

void Transcription::AddControlRates(int phase_index) {
  const Phase& phase = layout_.problem().phase(phase_index);
  const Mesh& mesh = layout_.phase(phase_index).mesh;
  const int degree = layout_.scheme().num_nodes() - 1;
  // Bounds hold between two points if they hold at both: a slope of degree 1 is bounded by its
  // ends.
  const std::vector<double> bounded =
      degree == 1 ? std::vector<double>{0.5} : GaussLobatto(degree).nodes;
  const std::vector<QuadraturePoint> rule = GaussLegendre(degree);
  const std::shared_ptr<Function> square = FunctionOf([](auto rate) { return rate * rate; });
  for (int interval = 0; interval + 1 < static_cast<int>(mesh.size()); ++interval) {
    const int first = interval * degree;
    for (const Phase::RateBound& rate : phase.rate_bounds()) {
      const std::string name = "rate of " + phase.controls()[rate.control].name;
      for (int i = 0; i < degree; ++i) {
        functions_.AddFormRow(
            layout_.ControlRateForm(phase_index, interval, bounded[i], rate.control), rate.scale,
            rate.bounds, {phase_index, first + i, name, -1});
      }
    }
    const double length = mesh[interval + 1] - mesh[interval];
    for (const Phase::RateCost& cost : phase.rate_costs()) {
      for (const QuadraturePoint& point : rule) {
        functions_.AddCost(
            CostTerm(square,
                     {layout_.ControlRateForm(phase_index, interval, point.share, cost.control)},
                     layout_.DurationForm(phase_index, cost.weight * point.weight * length)),
            {phase_index, first, "rate of " + phase.controls()[cost.control].name, -1});
      }
    }
  }
}

void Transcription::AddPathConstraints(int phase_index, const CancellationToken& cancellation) {
  const Phase& phase = layout_.problem().phase(phase_index);
  const int n = static_cast<int>(layout_.phase(phase_index).points.size());
  for (int point = 0; point < n; ++point) {
    cancellation.ThrowIfCancelled();
    for (const Phase::PathConstraint& constraint : phase.constraints()) {
      if (!IsImposedAt(constraint, layout_.phase(phase_index).points, point)) continue;
      std::vector<PolynomialForm> arguments;
      for (const Variable& argument : constraint.arguments) {
        arguments.push_back(layout_.FormOf(argument, phase_index, point));
      }
      functions_.AddBlock(
          ConstraintBlock(constraint.function, std::move(arguments), constraint.scales),
          constraint.bounds, constraint.scales, {phase_index, point, constraint.name, -1});
    }
  }
}

CostTerm Transcription::IntegralTerm(int phase, int point,
                                     const std::shared_ptr<Function>& function,
                                     const std::vector<Variable>& variables, double weight) const {
  std::vector<PolynomialForm> arguments;
  arguments.reserve(variables.size());
  for (const Variable& variable : variables) {
    arguments.push_back(layout_.FormOf(variable, phase, point));
  }
  return CostTerm(function, std::move(arguments), layout_.DurationForm(phase, weight));
}

void Transcription::AddIntegrals(int phase_index, const CancellationToken& cancellation) {
  const Phase& phase = layout_.problem().phase(phase_index);
  const PhaseLayout& layout = layout_.phase(phase_index);
  const MeshPoints points(layout.mesh, layout_.scheme());
  const int num_points = static_cast<int>(layout.points.size());
  for (const Phase::IntegralCost& cost : phase.costs()) {
    for (int point = 0; point < num_points; ++point) {
      cancellation.ThrowIfCancelled();
      if (!layout.points[point].has_values) continue;
      functions_.AddCost(IntegralTerm(phase_index, point, cost.function, cost.arguments,
                                      cost.weight * points.weights[point]),
                         {phase_index, point, cost.name, -1});
    }
  }
  for (const Phase::IntegralConstraint& integral : phase.integrals()) {
    std::vector<CostTerm> terms;
    for (int point = 0; point < num_points; ++point) {
      cancellation.ThrowIfCancelled();
      if (!layout.points[point].has_values) continue;
      terms.push_back(IntegralTerm(phase_index, point, integral.function, integral.arguments,
                                   points.weights[point]));
    }
    functions_.AddIntegralRow(std::move(terms), integral.scale, integral.bounds,
                              {-1, -1, phase.name() + ": " + integral.name, -1});
  }
}

void Transcription::AddInstants() {
  const auto forms = [this](const std::vector<VariableAt>& instants) {
    std::vector<PolynomialForm> arguments;
    arguments.reserve(instants.size());
    for (const VariableAt& instant : instants) arguments.push_back(layout_.InstantForm(instant));
    return arguments;
  };
  for (const auto& link : layout_.problem().links()) {
    functions_.AddBlock(ConstraintBlock(link.function, forms(link.arguments)), link.bounds, {},
                        {-1, -1, link.name, -1});
  }
  for (const auto& cost : layout_.problem().costs()) {
    functions_.AddCost(CostTerm(cost.function, forms(cost.arguments), {-1, {{-1, cost.weight, 0}}}),
                       {-1, -1, cost.name, -1});
  }
}

double Transcription::Objective(const Eigen::VectorXd& x) {
  return functions_.Objective(layout_.Unscaled(x));
}

void Transcription::Gradient(const Eigen::VectorXd& x, Eigen::VectorXd* gradient) {
  functions_.Gradient(layout_.Unscaled(x), gradient);
}

void Transcription::Constraints(const Eigen::VectorXd& x, Eigen::VectorXd* g) {
  functions_.Constraints(layout_.Unscaled(x), g);
}

void Transcription::Jacobian(const Eigen::VectorXd& x, Eigen::VectorXd* values) {
  functions_.Jacobian(layout_.Unscaled(x), values);
}

void Transcription::Hessian(const Eigen::VectorXd& x, double objective_factor,
                            const Eigen::VectorXd& multipliers, Eigen::VectorXd* values) {
  functions_.Hessian(layout_.Unscaled(x), objective_factor, multipliers, values);
}

std::string Transcription::VariableName(int variable) const {
  return layout_.FullName(layout_.names().at(variable));
}

std::string Transcription::ConstraintName(int constraint) const {
  return layout_.FullName(functions_.row_names().at(constraint));
}

std::string Transcription::ConstraintGroup(int constraint) const {
  return layout_.GroupOf(functions_.row_names().at(constraint));
}

std::string Transcription::VariableGroup(int variable) const {
  return layout_.GroupOf(layout_.names().at(variable));
}

Eigen::VectorXd Transcription::InitialGuess() const { return collocation::InitialGuess(layout_); }

Eigen::VectorXd Transcription::GuessFrom(const Trajectory& trajectory) const {
  return VariablesOf(layout_, trajectory);
}

Trajectory Transcription::TrajectoryOf(const Eigen::VectorXd& x) const {
  return collocation::TrajectoryOf(layout_, x);
}

std::vector<std::string> Transcription::WrongDerivatives(
    const Eigen::VectorXd& x, const CancellationToken& cancellation) const {
  return collocation::WrongDerivatives(layout_, x, cancellation);
}

Multipliers Transcription::MultipliersOf(const SolverResult& solution) const {
  const auto without_zeros = [](std::vector<MultiplierSeries> series) {
    std::erase_if(series, [](const MultiplierSeries& s) {
      return std::all_of(s.values.begin(), s.values.end(), [](double v) { return v == 0; });
    });
    return series;
  };
  return {
      SeriesOf(functions_.row_names(), functions_.row_scales(), solution.constraint_multipliers),
      without_zeros(SeriesOf(layout_.names(), layout_.scales(), solution.lower_multipliers)),
      without_zeros(SeriesOf(layout_.names(), layout_.scales(), solution.upper_multipliers))};
}

bool Transcription::AddMultipliers(const Multipliers& multipliers, const Trajectory& trajectory,
                                   SolverGuess* guess) const {
  CheckFits(layout_, trajectory);
  if (!HasScheme(trajectory, layout_.scheme())) return false;
  auto rows = Transferred(multipliers.constraints, trajectory, layout_, functions_.row_names(),
                          functions_.row_scales(), true);
  if (!rows) return false;
  guess->constraint_multipliers = std::move(*rows);
  guess->lower_multipliers = *Transferred(multipliers.lower, trajectory, layout_, layout_.names(),
                                          layout_.scales(), false);
  guess->upper_multipliers = *Transferred(multipliers.upper, trajectory, layout_, layout_.names(),
                                          layout_.scales(), false);
  return true;
}

}  // namespace possibility::collocation
