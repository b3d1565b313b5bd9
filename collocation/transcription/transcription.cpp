#include "collocation/transcription/transcription.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace possibility::collocation {

namespace {

double Factorial(int n) { return n <= 1 ? 1 : n * Factorial(n - 1); }

void CheckMesh(const OptimalControlProblem& problem, int phase, const Mesh& mesh) {
  bool ascends = mesh.size() >= 2 && mesh.front() == 0 && mesh.back() == 1;
  for (std::size_t i = 1; i < mesh.size(); ++i) ascends = ascends && mesh[i] > mesh[i - 1];
  if (!ascends) {
    throw std::invalid_argument(fmt::format("{}: phase '{}': the mesh must ascend from 0 to 1",
                                            problem.name(), problem.phase(phase).name()));
  }
}

}  // namespace

Transcription::Transcription(const OptimalControlProblem& problem,
                             const TranscriptionScheme& scheme, std::vector<Mesh> meshes,
                             const Interrupt& interrupt)
    : problem_(problem), scheme_(scheme) {
  if (problem.num_phases() == 0) problem.Fail("the problem has no phase");
  if (static_cast<int>(meshes.size()) != problem.num_phases()) {
    problem.Fail(fmt::format("{} meshes for {} phases", meshes.size(), problem.num_phases()));
  }
  layouts_.resize(meshes.size());
  for (const auto& parameter : problem_.parameters_) {
    parameters_.push_back(
        AddVariable(parameter.scale, parameter.bounds, {-1, -1, parameter.name, -1}));
  }
  for (int p = 0; p < problem.num_phases(); ++p) {
    CheckMesh(problem, p, meshes[p]);
    layouts_[p].mesh = std::move(meshes[p]);
    LayOut(p);
  }
  const auto copy = [](const std::vector<double>& from) {
    return Eigen::VectorXd(
        Eigen::Map<const Eigen::VectorXd>(from.data(), static_cast<Eigen::Index>(from.size())));
  };
  ones_.setOnes(static_cast<Eigen::Index>(scales_.size()));
  for (int p = 0; p < problem.num_phases(); ++p) AddDefects(p, interrupt);
  for (int p = 0; p < problem.num_phases(); ++p) {
    AddPathConstraints(p, interrupt);
    AddIntegralCosts(p, interrupt);
  }
  AddEnds();
  scale_ = copy(scales_);
  lower_ = copy(lowers_).cwiseQuotient(scale_);
  upper_ = copy(uppers_).cwiseQuotient(scale_);
  constraint_lower_ = copy(row_lowers_);
  constraint_upper_ = copy(row_uppers_);
}

int Transcription::AddVariable(double scale, Bounds bounds, PlacedName name) {
  scales_.push_back(scale);
  lowers_.push_back(bounds.lower);
  uppers_.push_back(bounds.upper);
  variable_names_.push_back(std::move(name));
  return static_cast<int>(scales_.size()) - 1;
}

void Transcription::LayOut(int phase_index) {
  const Phase& phase = problem_.phase(phase_index);
  PhaseLayout& layout = layouts_[phase_index];
  if (phase.coordinates_.empty()) phase.Fail("the phase has no coordinates");
  const Bounds& duration = phase.duration_;
  if (!(duration.lower > 0 && duration.upper < kInfinity)) phase.Fail("no duration was set");
  layout.fixed_duration = duration.lower;
  if (duration.lower < duration.upper) {
    layout.duration =
        AddVariable(duration.upper, duration, {-1, -1, phase.name() + ": duration", -1});
  }
  const int intervals = static_cast<int>(layout.mesh.size()) - 1;
  const int inside = scheme_.num_nodes() - 1;
  for (int i = 0; i < intervals; ++i) {
    for (int node = 0; node < inside; ++node) {
      const double share =
          layout.mesh[i] + scheme_.nodes[node] * (layout.mesh[i + 1] - layout.mesh[i]);
      layout.points.push_back({i, node, share, node == 0});
    }
  }
  layout.points.push_back({intervals - 1, inside, 1, true});
  for (int k = 0; k < static_cast<int>(layout.points.size()); ++k) LayOutPoint(phase_index, k);
}

void Transcription::LayOutPoint(int phase_index, int point) {
  const Phase& phase = problem_.phase(phase_index);
  PhaseLayout& layout = layouts_[phase_index];
  auto& coordinates = layout.coordinates.emplace_back();
  for (std::size_t c = 0; c < phase.coordinates_.size(); ++c) {
    std::vector<int>& orders = coordinates.emplace_back(phase.order() + 1, -1);
    for (int order = 0; order <= phase.order(); ++order) {
      const bool derived =
          !scheme_.separated && !layout.points[point].is_knot && order < phase.order();
      if (derived) continue;
      const Phase::Quantity& quantity = phase.coordinates_[c][order];
      const Bounds bounds = BoundsAt(quantity, phase_index, point);
      // A state that continues an earlier phase is that phase's variable.
      for (const auto& [from, to] : problem_.continued_) {
        const Variable here{VariableKind::kCoordinate, phase_index, static_cast<int>(c), order};
        if (point != 0 || !(to.variable == here)) continue;
        const PhaseLayout& earlier = layouts_[from.variable.phase];
        orders[order] = earlier.coordinates.back()[from.variable.index][from.variable.order];
      }
      if (orders[order] < 0) {
        orders[order] =
            AddVariable(quantity.scale, bounds, {phase_index, point, quantity.name, -1});
        continue;
      }
      double& lower = lowers_[orders[order]];
      double& upper = uppers_[orders[order]];
      lower = std::max(lower, bounds.lower);
      upper = std::min(upper, bounds.upper);
      if (lower > upper) {
        problem_.Fail(fmt::format("{}{}: contradictory bounds [{}, {}] where phases meet",
                                  PointName(phase_index, point), quantity.name, lower, upper));
      }
    }
  }
  auto& controls = layout.controls.emplace_back();
  for (const Phase::Quantity& quantity : phase.controls_) {
    controls.push_back(AddVariable(quantity.scale, BoundsAt(quantity, phase_index, point),
                                   {phase_index, point, quantity.name, -1}));
  }
}

bool Transcription::Holds(At at, int point, int num_points) {
  const bool first = point == 0;
  const bool last = point == num_points - 1;
  switch (at) {
    case At::kEverywhere:
      return true;
    case At::kStart:
      return first;
    case At::kEnd:
      return last;
    case At::kAfterStart:
      return !first;
    case At::kBeforeEnd:
      return !last;
    case At::kInside:
      return !first && !last;
  }
  return false;
}

Bounds Transcription::BoundsAt(const Phase::Quantity& quantity, int phase, int point) const {
  Bounds bounds;
  const int n = static_cast<int>(layouts_[phase].points.size());
  for (const auto& [at, b] : quantity.bounds) {
    if (!Holds(at, point, n)) continue;
    bounds.lower = std::max(bounds.lower, b.lower);
    bounds.upper = std::min(bounds.upper, b.upper);
  }
  if (bounds.lower > bounds.upper) {
    problem_.Fail(fmt::format("{}{}: contradictory bounds [{}, {}]", PointName(phase, point),
                              quantity.name, bounds.lower, bounds.upper));
  }
  return bounds;
}

std::string Transcription::PointName(int phase, int point) const {
  const Point& p = layouts_[phase].points[point];
  const int interval = p.node == scheme_.num_nodes() - 1 ? p.interval + 1 : p.interval;
  const std::string where = p.is_knot ? fmt::format("knot {}", interval)
                                      : fmt::format("interval {}, node {}", interval, p.node);
  return fmt::format("{}, {} (t = {:.4g} of the duration): ", problem_.phase(phase).name(), where,
                     p.share);
}

PolynomialForm Transcription::Integrated(int phase, int interval, int node, int coordinate,
                                         int order) const {
  const PhaseLayout& layout = layouts_[phase];
  const int highest = problem_.phase(phase).order();
  const int first = interval * (scheme_.num_nodes() - 1);
  const double share = layout.mesh[interval + 1] - layout.mesh[interval];
  const double c = scheme_.nodes[node];
  PolynomialForm form;
  form.duration = layout.duration;
  const auto add = [&](int variable, double coefficient, int power) {
    // coefficient * h^power, h = share * duration.
    double factor = coefficient * std::pow(share, power);
    if (layout.duration < 0) {
      factor *= std::pow(layout.fixed_duration, power);
      power = 0;
    }
    if (factor != 0) form.monomials.push_back({variable, factor, power});
  };
  for (int r = order; r < highest; ++r) {
    add(layout.coordinates[first][coordinate][r], std::pow(c, r - order) / Factorial(r - order),
        r - order);
  }
  const int k = highest - order;
  for (int j = 0; j < scheme_.num_nodes(); ++j) {
    add(layout.coordinates[first + j][coordinate][highest], scheme_.integral[k](node, j), k);
  }
  return form;
}

PolynomialForm Transcription::TimeForm(int phase, double share) const {
  PolynomialForm form;
  double constant = 0;
  for (int earlier = 0; earlier < phase; ++earlier) {
    if (layouts_[earlier].duration < 0) {
      constant += layouts_[earlier].fixed_duration;
    } else {
      form.monomials.push_back({layouts_[earlier].duration, 1, 0});
    }
  }
  if (layouts_[phase].duration < 0) {
    constant += share * layouts_[phase].fixed_duration;
  } else {
    form.monomials.push_back({layouts_[phase].duration, share, 0});
  }
  form.monomials.push_back({-1, constant, 0});
  return form;
}

PolynomialForm Transcription::FormOf(Variable variable, int phase, int point) const {
  const PhaseLayout& layout = layouts_[phase];
  const auto single = [](int index) { return PolynomialForm{-1, {{index, 1, 0}}}; };
  switch (variable.kind) {
    case VariableKind::kCoordinate: {
      const int index = layout.coordinates[point][variable.index][variable.order];
      if (index >= 0) return single(index);
      const Point& p = layout.points[point];
      return Integrated(phase, p.interval, p.node, variable.index, variable.order);
    }
    case VariableKind::kControl:
      return single(layout.controls[point][variable.index]);
    case VariableKind::kParameter:
      return single(parameters_[variable.index]);
    case VariableKind::kDuration:
      if (layout.duration >= 0) return single(layout.duration);
      return {-1, {{-1, layout.fixed_duration, 0}}};
    case VariableKind::kTime:
      return TimeForm(phase, layout.points[point].share);
  }
  throw std::logic_error("FormOf: a kind of variable that is none");
}

PolynomialForm Transcription::EndForm(const EndVariable& end) const {
  const int phase = end.variable.phase;
  if (phase < 0) return FormOf(end.variable, 0, 0);
  const int last = static_cast<int>(layouts_[phase].points.size()) - 1;
  if (end.at != At::kStart && end.at != At::kEnd) {
    problem_.Fail(problem_.NameOf(end.variable) + ": expected the start or the end of a phase");
  }
  return FormOf(end.variable, phase, end.at == At::kStart ? 0 : last);
}

void Transcription::AddFormRow(PolynomialForm form, double scale, Bounds bounds, PlacedName name) {
  const int row = static_cast<int>(row_lowers_.size());
  FormRow form_row{std::move(form), 1 / scale, {}, {}};
  form_row.form.Gradient(ones_, [&](int variable, double) {
    form_row.jacobian_slots.push_back(jacobian_.At(row, variable));
  });
  form_row.form.Hessian(ones_, [&](int i, int j, double) {
    form_row.hessian_slots.push_back(hessian_.At(std::max(i, j), std::min(i, j)));
  });
  form_rows_.push_back(std::move(form_row));
  row_scales_.push_back(scale);
  row_lowers_.push_back(bounds.lower / scale);
  row_uppers_.push_back(bounds.upper / scale);
  row_names_.push_back(std::move(name));
}

void Transcription::AddDefects(int phase_index, const Interrupt& interrupt) {
  const Phase& phase = problem_.phase(phase_index);
  const PhaseLayout& layout = layouts_[phase_index];
  const int inside = scheme_.num_nodes() - 1;
  const int n = static_cast<int>(phase.coordinates_.size());
  for (int interval = 0; interval + 1 < static_cast<int>(layout.mesh.size()); ++interval) {
    if (interrupt) interrupt();
    for (int node = 1; node <= inside; ++node) {
      const int point = interval * inside + node;
      for (int c = 0; c < n; ++c) {
        for (int order = 0; order < phase.order(); ++order) {
          const Phase::Quantity& quantity = phase.coordinates_[c][order];
          const int index = layout.coordinates[point][c][order];
          PolynomialForm form = Integrated(phase_index, interval, node, c, order);
          const PlacedName name{phase_index, point, "defect of " + quantity.name, -1, true};
          if (index >= 0) {
            form.monomials.push_back({index, -1, 0});
            AddFormRow(std::move(form), quantity.scale, {0, 0}, name);
            continue;
          }
          const Bounds bounds = BoundsAt(quantity, phase_index, point);
          if (bounds.lower > -kInfinity || bounds.upper < kInfinity) {
            AddFormRow(std::move(form), quantity.scale, bounds,
                       {phase_index, point, quantity.name, -1});
          }
        }
      }
    }
  }
}

void Transcription::AddBlock(FunctionBlock block, const std::vector<Bounds>& bounds,
                             const Eigen::VectorXd& scales, PlacedName name) {
  block.FindSlots(static_cast<int>(row_lowers_.size()), &jacobian_, &hessian_);
  for (std::size_t o = 0; o < bounds.size(); ++o) {
    const double scale = scales.size() == 0 ? 1 : scales[static_cast<Eigen::Index>(o)];
    row_scales_.push_back(scale);
    row_lowers_.push_back(bounds[o].lower / scale);
    row_uppers_.push_back(bounds[o].upper / scale);
    name.output = bounds.size() == 1 ? -1 : static_cast<int>(o);
    row_names_.push_back(name);
  }
  blocks_.push_back(std::move(block));
}

void Transcription::AddPathConstraints(int phase_index, const Interrupt& interrupt) {
  const Phase& phase = problem_.phase(phase_index);
  const int n = static_cast<int>(layouts_[phase_index].points.size());
  for (int point = 0; point < n; ++point) {
    if (interrupt) interrupt();
    for (const Phase::PathConstraint& constraint : phase.constraints_) {
      if (!Holds(constraint.at, point, n)) continue;
      if (constraint.only_at_knots && !layouts_[phase_index].points[point].is_knot) continue;
      std::vector<PolynomialForm> arguments;
      for (const Variable& argument : constraint.arguments) {
        arguments.push_back(FormOf(argument, phase_index, point));
      }
      AddBlock(FunctionBlock(constraint.function, std::move(arguments), constraint.scales),
               constraint.bounds, constraint.scales, {phase_index, point, constraint.name, -1});
    }
  }
}

void Transcription::AddIntegralCosts(int phase_index, const Interrupt& interrupt) {
  const Phase& phase = problem_.phase(phase_index);
  const PhaseLayout& layout = layouts_[phase_index];
  const MeshPoints points(layout.mesh, scheme_);
  for (const Phase::IntegralCost& cost : phase.costs_) {
    for (int point = 0; point < static_cast<int>(layout.points.size()); ++point) {
      if (interrupt) interrupt();
      std::vector<PolynomialForm> arguments;
      for (const Variable& argument : cost.arguments) {
        arguments.push_back(FormOf(argument, phase_index, point));
      }
      PolynomialForm weight;
      weight.duration = layout.duration;
      const double share = cost.weight * points.weights[point];
      weight.monomials.push_back(layout.duration < 0
                                     ? Monomial{-1, share * layout.fixed_duration, 0}
                                     : Monomial{-1, share, 1});
      costs_.emplace_back(cost.function, std::move(arguments));
      costs_.back().FindCostSlots(weight, &hessian_);
      cost_names_.push_back({phase_index, point, cost.name, -1});
    }
  }
}

void Transcription::AddEnds() {
  const auto forms = [this](const std::vector<EndVariable>& ends) {
    std::vector<PolynomialForm> arguments;
    for (const EndVariable& end : ends) arguments.push_back(EndForm(end));
    return arguments;
  };
  for (const auto& link : problem_.links_) {
    AddBlock(FunctionBlock(link.function, forms(link.arguments)), link.bounds, {},
             {-1, -1, link.name, -1});
  }
  for (const auto& cost : problem_.costs_) {
    costs_.emplace_back(cost.function, forms(cost.arguments));
    costs_.back().FindCostSlots({-1, {{-1, cost.weight, 0}}}, &hessian_);
    cost_names_.push_back({-1, -1, cost.name, -1});
  }
}

std::string Transcription::FullName(const PlacedName& name) const {
  const std::string where = name.phase < 0 ? "" : PointName(name.phase, name.point);
  const std::string output = name.output < 0 ? "" : fmt::format("[{}]", name.output);
  return where + name.name + output;
}

std::string Transcription::VariableName(int variable) const {
  return FullName(variable_names_.at(variable));
}

std::string Transcription::ConstraintName(int constraint) const {
  return FullName(row_names_.at(constraint));
}

std::string Transcription::ConstraintGroup(int constraint) const {
  const PlacedName& row = row_names_.at(constraint);
  return row.phase < 0 ? row.name : problem_.phase(row.phase).name() + ": " + row.name;
}

double Transcription::DurationOf(int phase, const Eigen::VectorXd& x) const {
  const PhaseLayout& layout = layouts_[phase];
  return layout.duration < 0 ? layout.fixed_duration : x[layout.duration];
}

}  // namespace possibility::collocation
