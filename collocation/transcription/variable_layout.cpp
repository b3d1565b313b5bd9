#include "collocation/transcription/variable_layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
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

VariableLayout::VariableLayout(const OptimalControlProblem& problem,
                               const TranscriptionScheme& scheme, std::vector<Mesh> meshes)
    : problem_(problem), scheme_(scheme) {
  if (problem.num_phases() == 0) problem.Fail("the problem has no phase");
  if (static_cast<int>(meshes.size()) != problem.num_phases()) {
    problem.Fail(fmt::format("{} meshes for {} phases", meshes.size(), problem.num_phases()));
  }
  phases_.resize(meshes.size());
  for (const auto& parameter : problem_.parameters()) {
    parameters_.push_back(
        AddVariable(parameter.scale, parameter.bounds, {-1, -1, parameter.name, -1}));
  }
  for (int p = 0; p < problem.num_phases(); ++p) {
    CheckMesh(problem, p, meshes[p]);
    phases_[p].mesh = std::move(meshes[p]);
    LayOut(p);
  }
  const auto copy = [](const std::vector<double>& from) {
    return Eigen::VectorXd(
        Eigen::Map<const Eigen::VectorXd>(from.data(), static_cast<Eigen::Index>(from.size())));
  };
  scale_vector_ = copy(scales_);
  lower_ = copy(lowers_).cwiseQuotient(scale_vector_);
  upper_ = copy(uppers_).cwiseQuotient(scale_vector_);
}

int VariableLayout::AddVariable(double scale, Bounds bounds, PlacedName name) {
  scales_.push_back(scale);
  lowers_.push_back(bounds.lower);
  uppers_.push_back(bounds.upper);
  names_.push_back(std::move(name));
  return static_cast<int>(scales_.size()) - 1;
}

void VariableLayout::LayOut(int phase_index) {
  const Phase& phase = problem_.phase(phase_index);
  PhaseLayout& layout = phases_[phase_index];
  if (phase.coordinates().empty()) phase.Fail("the phase has no coordinates");
  const Bounds& duration = phase.duration_bounds();
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
      const bool has_values =
          scheme_.HasValue(node) || (node == 0 && i > 0 && scheme_.value_at_end);
      layout.points.push_back({i, node, share, node == 0, has_values});
    }
  }
  layout.points.push_back({intervals - 1, inside, 1, true, scheme_.value_at_end});
  for (int k = 0; k < static_cast<int>(layout.points.size()); ++k) LayOutPoint(phase_index, k);
}

void VariableLayout::LayOutPoint(int phase_index, int point) {
  const Phase& phase = problem_.phase(phase_index);
  PhaseLayout& layout = phases_[phase_index];
  auto& coordinates = layout.coordinates.emplace_back();
  for (std::size_t c = 0; c < phase.coordinates().size(); ++c) {
    const int highest = phase.OrderOf(static_cast<int>(c));
    std::vector<int>& orders = coordinates.emplace_back(highest + 1, -1);
    for (int order = 0; order <= highest; ++order) {
      const bool derived = !scheme_.separated && !layout.points[point].is_knot && order < highest;
      if (derived || (order == highest && !layout.points[point].has_values)) continue;
      orders[order] = AddContinuing(phase.Coordinate(static_cast<int>(c), order), point);
    }
  }
  auto& controls = layout.controls.emplace_back();
  for (std::size_t c = 0; c < phase.controls().size(); ++c) {
    const Variable control = phase.Control(static_cast<int>(c));
    controls.push_back(layout.points[point].has_values ? AddContinuing(control, point) : -1);
  }
}

int VariableLayout::AddContinuing(Variable variable, int point) {
  const Phase::Quantity& quantity = problem_.phase(variable.phase).Find(variable);
  const Bounds bounds = BoundsAt(quantity, variable.phase, point);
  int index = -1;
  for (const auto& [from, to] : problem_.continued()) {
    if (point != 0 || to.variable != variable) continue;
    const PhaseLayout& earlier = phases_[from.variable.phase];
    index = variable.kind == VariableKind::kControl
                ? earlier.controls.back()[from.variable.index]
                : earlier.coordinates.back()[from.variable.index][from.variable.order];
  }
  if (index < 0) {
    return AddVariable(quantity.scale, bounds, {variable.phase, point, quantity.name, -1});
  }
  double& lower = lowers_[index];
  double& upper = uppers_[index];
  lower = std::max(lower, bounds.lower);
  upper = std::min(upper, bounds.upper);
  if (lower > upper) {
    problem_.Fail(fmt::format("{}{}: contradictory bounds [{}, {}] where phases meet",
                              PointName(variable.phase, point), quantity.name, lower, upper));
  }
  return index;
}

bool HoldsAt(At at, int point, int num_points) {
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

bool IsImposedAt(const Phase::PathConstraint& constraint, const std::vector<LayoutPoint>& points,
                 int point) {
  if (!HoldsAt(constraint.at, point, static_cast<int>(points.size()))) return false;
  if (constraint.only_at_knots) return points[point].is_knot;
  const bool is_of_one_end = constraint.at == At::kStart || constraint.at == At::kEnd;
  return points[point].has_values || is_of_one_end;
}

Bounds VariableLayout::BoundsAt(const Phase::Quantity& quantity, int phase, int point) const {
  Bounds bounds;
  const int n = static_cast<int>(phases_[phase].points.size());
  for (const auto& [at, b] : quantity.bounds) {
    if (!HoldsAt(at, point, n)) continue;
    bounds.lower = std::max(bounds.lower, b.lower);
    bounds.upper = std::min(bounds.upper, b.upper);
  }
  if (bounds.lower > bounds.upper) {
    problem_.Fail(fmt::format("{}{}: contradictory bounds [{}, {}]", PointName(phase, point),
                              quantity.name, bounds.lower, bounds.upper));
  }
  return bounds;
}

std::string VariableLayout::KnotName(int phase, int point) const {
  const LayoutPoint& p = phases_[phase].points[point];
  const int interval = p.node == scheme_.num_nodes() - 1 ? p.interval + 1 : p.interval;
  return p.is_knot ? fmt::format("knot {}", interval)
                   : fmt::format("interval {}, node {}", interval, p.node);
}

std::string VariableLayout::PointName(int phase, int point) const {
  return fmt::format("{}, {} (t = {:.4g} of the duration): ", problem_.phase(phase).name(),
                     KnotName(phase, point), phases_[phase].points[point].share);
}

PolynomialForm VariableLayout::IntegralForm(int phase, int interval, int node, int coordinate,
                                            int order) const {
  return InterpolantForm(phase, interval, scheme_.nodes[node], coordinate, order);
}

PolynomialForm VariableLayout::InterpolantForm(int phase, int interval, double c, int coordinate,
                                               int order) const {
  const PhaseLayout& layout = phases_[phase];
  const int highest = problem_.phase(phase).OrderOf(coordinate);
  const int first = interval * (scheme_.num_nodes() - 1);
  const double share = layout.mesh[interval + 1] - layout.mesh[interval];
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
  const Eigen::VectorXd integrals = scheme_.LagrangeIntegrals(c, k);
  for (int j = 0; j < scheme_.num_nodes(); ++j) {
    if (!scheme_.HasValue(j)) continue;
    add(layout.coordinates[first + j][coordinate][highest], integrals[j], k);
  }
  return form;
}

PolynomialForm VariableLayout::ControlForm(int phase, int interval, double share,
                                           int control) const {
  const int first = interval * (scheme_.num_nodes() - 1);
  const Eigen::VectorXd lagrange = scheme_.LagrangeIntegrals(share, 0);
  PolynomialForm form;
  for (int j = 0; j < scheme_.num_nodes(); ++j) {
    if (!scheme_.HasValue(j)) continue;
    form.monomials.push_back({phases_[phase].controls[first + j][control], lagrange[j], 0});
  }
  return form;
}

PolynomialForm VariableLayout::ControlRateForm(int phase, int interval, double share,
                                               int control) const {
  const PhaseLayout& layout = phases_[phase];
  const double length = layout.mesh[interval + 1] - layout.mesh[interval];
  const bool is_free = layout.duration >= 0;
  const double seconds = is_free ? length : length * layout.fixed_duration;
  const int first = interval * (scheme_.num_nodes() - 1);
  const Eigen::VectorXd slopes = scheme_.LagrangeSlopes(share);
  PolynomialForm form{layout.duration, {}};
  for (int j = 0; j < scheme_.num_nodes(); ++j) {
    form.monomials.push_back(
        {layout.controls[first + j][control], slopes[j] / seconds, is_free ? -1 : 0});
  }
  return form;
}

PolynomialForm VariableLayout::DurationForm(int phase, double factor) const {
  const PhaseLayout& layout = phases_[phase];
  if (layout.duration < 0) return {-1, {{-1, factor * layout.fixed_duration, 0}}};
  return {layout.duration, {{-1, factor, 1}}};
}

PolynomialForm VariableLayout::FormAtShare(Variable variable, int phase, double share) const {
  switch (variable.kind) {
    case VariableKind::kCoordinate: {
      const auto [interval, c] = Locate(phases_[phase].mesh, share);
      return InterpolantForm(phase, interval, c, variable.index, variable.order);
    }
    case VariableKind::kControl: {
      const auto [interval, c] = Locate(phases_[phase].mesh, share);
      return ControlForm(phase, interval, c, variable.index);
    }
    case VariableKind::kTime:
      return TimeForm(phase, share);
    case VariableKind::kShare:
      return {-1, {{-1, share, 0}}};
    case VariableKind::kParameter:
    case VariableKind::kDuration:
      return FormOf(variable, phase, 0);
  }
  throw std::logic_error("FormAtShare: a kind of variable that is none");
}

PolynomialForm VariableLayout::TimeForm(int phase, double share) const {
  PolynomialForm form;
  double constant = 0;
  for (int earlier = 0; earlier < phase; ++earlier) {
    if (phases_[earlier].duration < 0) {
      constant += phases_[earlier].fixed_duration;
    } else {
      form.monomials.push_back({phases_[earlier].duration, 1, 0});
    }
  }
  if (phases_[phase].duration < 0) {
    constant += share * phases_[phase].fixed_duration;
  } else {
    form.monomials.push_back({phases_[phase].duration, share, 0});
  }
  form.monomials.push_back({-1, constant, 0});
  return form;
}

PolynomialForm VariableLayout::FormOf(Variable variable, int phase, int point) const {
  const PhaseLayout& layout = phases_[phase];
  const auto single = [](int index) { return PolynomialForm{-1, {{index, 1, 0}}}; };
  switch (variable.kind) {
    case VariableKind::kCoordinate: {
      const int index = layout.coordinates[point][variable.index][variable.order];
      if (index >= 0) return single(index);
      const LayoutPoint& p = layout.points[point];
      return IntegralForm(phase, p.interval, p.node, variable.index, variable.order);
    }
    case VariableKind::kControl: {
      const int index = layout.controls[point][variable.index];
      if (index >= 0) return single(index);
      const LayoutPoint& p = layout.points[point];
      return ControlForm(phase, p.interval, scheme_.nodes[p.node], variable.index);
    }
    case VariableKind::kParameter:
      return single(parameters_[variable.index]);
    case VariableKind::kDuration:
      if (layout.duration >= 0) return single(layout.duration);
      return {-1, {{-1, layout.fixed_duration, 0}}};
    case VariableKind::kTime:
      return TimeForm(phase, layout.points[point].share);
    case VariableKind::kShare:
      return {-1, {{-1, layout.points[point].share, 0}}};
  }
  throw std::logic_error("FormOf: a kind of variable that is none");
}

PolynomialForm VariableLayout::InstantForm(const VariableAt& instant) const {
  const int phase = instant.variable.phase;
  if (phase < 0) return FormOf(instant.variable, 0, 0);
  if (instant.share) return FormAtShare(instant.variable, phase, *instant.share);
  const int last = static_cast<int>(phases_[phase].points.size()) - 1;
  if (instant.at != At::kStart && instant.at != At::kEnd) {
    problem_.Fail(problem_.NameOf(instant.variable) +
                  ": expected the start or the end of a phase, or a share of it");
  }
  return FormOf(instant.variable, phase, instant.at == At::kStart ? 0 : last);
}

std::string VariableLayout::FullName(const PlacedName& name) const {
  const std::string where = name.phase < 0 ? "" : PointName(name.phase, name.point);
  const std::string output = name.output < 0 ? "" : fmt::format("[{}]", name.output);
  return where + name.name + output;
}

std::string VariableLayout::GroupOf(const PlacedName& name) const {
  return name.phase < 0 ? name.name : problem_.phase(name.phase).name() + ": " + name.name;
}

double VariableLayout::DurationOf(int phase, const Eigen::VectorXd& x) const {
  const PhaseLayout& layout = phases_[phase];
  return layout.duration < 0 ? layout.fixed_duration : x[layout.duration];
}

std::vector<double> VariableLayout::TimesOf(const std::vector<PlacedName>& names) const {
  std::vector<double> times;
  times.reserve(names.size());
  for (const PlacedName& name : names) {
    const bool is_placed = name.phase >= 0 && name.point >= 0;
    times.push_back(is_placed ? name.phase + phases_[name.phase].points[name.point].share
                              : std::numeric_limits<double>::quiet_NaN());
  }
  return times;
}

}  // namespace possibility::collocation
