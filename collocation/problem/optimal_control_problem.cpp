#include "collocation/problem/optimal_control_problem.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <stdexcept>

namespace possibility::collocation {

namespace {

/// f(arguments) - y^(order): explicit dynamics as rows at 0. The rates are the last inputs.
class DynamicsResidual : public Function {
 public:
  explicit DynamicsResidual(std::shared_ptr<Function> f)
      : Function(f->num_inputs() + f->num_outputs(), f->num_outputs()), f_(std::move(f)) {}

  void Evaluate(const Eigen::VectorXd& z, Eigen::VectorXd* y) override {
    f_->Evaluate(z.head(f_->num_inputs()), y);
    *y -= z.tail(num_outputs());
  }
  void Jacobian(const Eigen::VectorXd& z, Eigen::MatrixXd* J) override {
    Eigen::MatrixXd of_f(num_outputs(), f_->num_inputs());
    f_->Jacobian(z.head(f_->num_inputs()), &of_f);
    J->leftCols(f_->num_inputs()) = of_f;
    J->rightCols(num_outputs()) = -Eigen::MatrixXd::Identity(num_outputs(), num_outputs());
  }
  void Hessian(const Eigen::VectorXd& z, const Eigen::VectorXd& multipliers,
               Eigen::MatrixXd* H) override {
    Eigen::MatrixXd of_f(f_->num_inputs(), f_->num_inputs());
    f_->Hessian(z.head(f_->num_inputs()), multipliers, &of_f);
    H->setZero();
    H->topLeftCorner(f_->num_inputs(), f_->num_inputs()) = of_f;
  }
  Mask JacobianMask() const override {
    Mask mask = Mask::Constant(num_outputs(), num_inputs(), false);
    mask.leftCols(f_->num_inputs()) = f_->JacobianMask();
    for (int i = 0; i < num_outputs(); ++i) mask(i, f_->num_inputs() + i) = true;
    return mask;
  }
  Mask HessianMask() const override {
    Mask mask = Mask::Constant(num_inputs(), num_inputs(), false);
    mask.topLeftCorner(f_->num_inputs(), f_->num_inputs()) = f_->HessianMask();
    return mask;
  }

 private:
  std::shared_ptr<Function> f_;
};

const char* Describe(VariableKind kind) {
  switch (kind) {
    case VariableKind::kCoordinate:
      return "coordinate";
    case VariableKind::kControl:
      return "control";
    case VariableKind::kParameter:
      return "parameter";
    case VariableKind::kDuration:
      return "duration";
    case VariableKind::kTime:
      return "time";
    case VariableKind::kShare:
      return "share";
  }
  return "variable";
}

/// An address would not do: a later problem may have it.
std::int64_t NextNumber() {
  static std::atomic<std::int64_t> last{0};
  return ++last;
}

}  // namespace

Phase::Phase(OptimalControlProblem* problem, int index, std::string name, int order)
    : problem_(problem), index_(index), name_(std::move(name)), order_(order) {}

void Phase::Fail(const std::string& what) const {
  problem_->Fail(fmt::format("phase '{}': {}", name_, what));
}

PhaseNames Phase::Names() const {
  PhaseNames names{name_, order_, {}, {}};
  bool is_mixed = false;
  for (int i = 0; i < static_cast<int>(coordinates_.size()); ++i) {
    names.coordinates.push_back(coordinates_[i][0].name);
    names.orders.push_back(OrderOf(i));
    is_mixed = is_mixed || OrderOf(i) != order_;
  }
  if (!is_mixed) names.orders.clear();
  for (const Quantity& control : controls_) names.controls.push_back(control.name);
  return names;
}

Variable Phase::AddCoordinate(const std::string& name, Bounds bounds, std::optional<double> scale) {
  return AddCoordinateOfOrder(order_, name, bounds, scale);
}

Variable Phase::AddCoordinateOfOrder(int highest, const std::string& name, Bounds bounds,
                                     std::optional<double> scale) {
  if (highest < 1 || highest > order_) {
    Fail(fmt::format("'{}': expected an order from 1 to {}, got {}", name, order_, highest));
  }
  std::vector<Quantity> orders(highest + 1);
  for (int order = 0; order <= highest; ++order) {
    orders[order].name = name + std::string(order, '\'');
  }
  coordinates_.push_back(std::move(orders));
  const Variable variable = Coordinate(static_cast<int>(coordinates_.size()) - 1);
  if (scale) SetScale(variable, *scale);
  Bound(variable, bounds);
  return variable;
}

Variable Phase::Rate(Variable coordinate, int times) const {
  const Quantity& quantity = Find(coordinate);
  if (coordinate.kind != VariableKind::kCoordinate ||
      coordinate.order + times > OrderOf(coordinate.index) || times < 1) {
    Fail(fmt::format("'{}' has no derivative of order {}", quantity.name, times));
  }
  coordinate.order += times;
  return coordinate;
}

Variable Phase::AddControl(const std::string& name, Bounds bounds, std::optional<double> scale) {
  controls_.push_back({});
  controls_.back().name = name;
  const Variable variable = Control(static_cast<int>(controls_.size()) - 1);
  if (scale) SetScale(variable, *scale);
  Bound(variable, bounds);
  return variable;
}

Variable Phase::Own(VariableKind kind, int index, int order) const {
  return {kind, index_, index, order, problem_->number_};
}

const Phase::Quantity* Phase::FindOrNull(Variable variable) const {
  const auto in = [](int index, std::size_t size) {
    return index >= 0 && index < static_cast<int>(size);
  };
  if (variable.problem != problem_->number_ || variable.phase != index_) return nullptr;
  if (variable.kind == VariableKind::kControl && in(variable.index, controls_.size())) {
    return &controls_[variable.index];
  }
  if (variable.kind == VariableKind::kCoordinate && in(variable.index, coordinates_.size()) &&
      in(variable.order, coordinates_[variable.index].size())) {
    return &coordinates_[variable.index][variable.order];
  }
  return nullptr;
}

const Phase::Quantity& Phase::Find(Variable variable) const {
  const Quantity* quantity = FindOrNull(variable);
  if (quantity != nullptr) return *quantity;
  Fail(fmt::format("{} is no coordinate or control of this phase",
                   problem_->DescriptionOf(variable)));
}

std::string Phase::NameOf(Variable variable) const {
  if (variable == duration()) return "duration";
  if (variable == time()) return "time";
  if (variable == share()) return "share of the duration";
  return variable.kind == VariableKind::kParameter ? problem_->NameOf(variable)
                                                   : Find(variable).name;
}

bool Phase::Knows(Variable variable) const {
  return variable == duration() || variable == time() || variable == share() ||
         FindOrNull(variable) != nullptr ||
         (variable.kind == VariableKind::kParameter && problem_->Knows(variable));
}

Phase::Quantity& Phase::FindMutable(Variable variable) {
  return const_cast<Quantity&>(std::as_const(*this).Find(variable));
}

void Phase::SetScale(Variable variable, double scale) {
  Quantity& quantity = FindMutable(variable);
  if (!(scale > 0 && std::isfinite(scale))) {
    Fail(fmt::format("'{}': expected a scale above 0, got {}", quantity.name, scale));
  }
  quantity.scale = scale;
  quantity.has_own_scale = true;
}

void Phase::SuggestScale(Variable variable, double scale) {
  Quantity& quantity = FindMutable(variable);
  if (quantity.has_own_scale) return;
  SetScale(variable, scale);
  quantity.has_own_scale = false;
}

void Phase::SuggestRowScales(int constraint, const Eigen::VectorXd& scales) {
  PathConstraint& of = constraints_.at(constraint);
  if (!of.has_own_scales) of.scales = scales;
}

void Phase::SetDuration(Bounds bounds) {
  if (!(bounds.lower > 0 && bounds.upper < kInfinity && bounds.lower <= bounds.upper)) {
    Fail(fmt::format("expected a duration within finite bounds above 0, got {}", Describe(bounds)));
  }
  duration_ = bounds;
}

void Phase::Bound(Variable variable, Bounds bounds, At at) {
  Quantity& quantity = FindMutable(variable);
  if (Contradict(bounds)) {
    Fail(fmt::format("'{}': contradictory bounds {}", quantity.name, Describe(bounds)));
  }
  quantity.bounds.emplace_back(at, bounds);
}

void Phase::CheckArguments(const std::string& name, const Function* f,
                           const std::vector<Variable>& arguments) const {
  if (f == nullptr) Fail(fmt::format("'{}' has no function", name));
  if (static_cast<int>(arguments.size()) != f->num_inputs()) {
    Fail(fmt::format("'{}' takes {} arguments, got {}", name, f->num_inputs(), arguments.size()));
  }
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (Knows(arguments[i])) continue;
    Fail(fmt::format("'{}': argument {} is {}, which is not of this phase", name, i,
                     problem_->DescriptionOf(arguments[i])));
  }
}

void Phase::SetDynamics(std::shared_ptr<Function> f, std::vector<Variable> arguments) {
  CheckArguments("dynamics", f.get(), arguments);
  const int n = static_cast<int>(coordinates_.size());
  if (f->num_outputs() != n) {
    Fail(fmt::format("dynamics have {} outputs, expected one for each of {} coordinates",
                     f->num_outputs(), n));
  }
  std::vector<double> scales;
  for (int i = 0; i < n; ++i) {
    arguments.push_back(Coordinate(i, OrderOf(i)));
    scales.push_back(coordinates_[i].back().scale);
  }
  Constrain("dynamics", std::make_shared<DynamicsResidual>(std::move(f)), std::move(arguments),
            {{0, 0}}, At::kEverywhere, std::move(scales));
  constraints_.back().is_dynamics = true;
  constraints_.back().has_own_scales = false;
}

void Phase::Constrain(const std::string& name, std::shared_ptr<Function> f,
                      std::vector<Variable> arguments, std::vector<Bounds> bounds, At at,
                      std::vector<double> scales) {
  CheckArguments(name, f.get(), arguments);
  CheckNameOfConstraint(name);
  if (bounds.size() == 1) bounds.resize(f->num_outputs(), bounds.front());
  if (static_cast<int>(bounds.size()) != f->num_outputs()) {
    Fail(fmt::format("'{}' has {} outputs and {} bounds", name, f->num_outputs(), bounds.size()));
  }
  for (const Bounds& b : bounds) {
    if (Contradict(b)) Fail(fmt::format("'{}': contradictory bounds {}", name, Describe(b)));
  }
  const std::size_t n = bounds.size();
  const bool has_own_scales = !scales.empty();
  if (scales.empty()) scales = {1};
  if (scales.size() == 1) scales.resize(n, scales.front());
  if (scales.size() != n) {
    Fail(fmt::format("'{}' has {} outputs and {} scales", name, n, scales.size()));
  }
  for (const double scale : scales) {
    if (!(scale > 0 && std::isfinite(scale))) {
      Fail(fmt::format("'{}': expected scales above 0, got {}", name, scale));
    }
  }
  constraints_.push_back({name, std::move(f), std::move(arguments), std::move(bounds), at,
                          Eigen::Map<Eigen::VectorXd>(scales.data(), static_cast<int>(n)),
                          has_own_scales});
}

void Phase::ConstrainKnots(const std::string& name, std::shared_ptr<Function> f,
                           std::vector<Variable> arguments, std::vector<Bounds> bounds, At at,
                           std::vector<double> scales) {
  Constrain(name, std::move(f), std::move(arguments), std::move(bounds), at, std::move(scales));
  constraints_.back().only_at_knots = true;
}

void Phase::AddIntegralCost(const std::string& name, std::shared_ptr<Function> f,
                            std::vector<Variable> arguments, double weight) {
  CheckArguments(name, f.get(), arguments);
  if (f->num_outputs() != 1) Fail(fmt::format("cost '{}' has {} outputs", name, f->num_outputs()));
  if (!std::isfinite(weight)) Fail(fmt::format("cost '{}' has the weight {}", name, weight));
  costs_.push_back({name, std::move(f), std::move(arguments), weight});
}

void Phase::CheckNameOfConstraint(const std::string& name) const {
  const auto is_named = [&](const auto& other) { return other.name == name; };
  if (std::any_of(constraints_.begin(), constraints_.end(), is_named) ||
      std::any_of(integrals_.begin(), integrals_.end(), is_named)) {
    Fail(fmt::format("two constraints are named '{}'", name));
  }
}

void Phase::ConstrainIntegral(const std::string& name, std::shared_ptr<Function> f,
                              std::vector<Variable> arguments, Bounds bounds, double scale) {
  CheckArguments(name, f.get(), arguments);
  CheckNameOfConstraint(name);
  if (f->num_outputs() != 1) {
    Fail(fmt::format("integral '{}' has {} outputs", name, f->num_outputs()));
  }
  if (Contradict(bounds)) {
    Fail(fmt::format("'{}': contradictory bounds {}", name, Describe(bounds)));
  }
  if (!(scale > 0 && std::isfinite(scale))) {
    Fail(fmt::format("'{}': expected a scale above 0, got {}", name, scale));
  }
  integrals_.push_back({name, std::move(f), std::move(arguments), bounds, scale});
}

void Phase::Guess(Variable variable, std::function<double(double)> value) {
  if (variable == duration()) {
    duration_guess_ = std::move(value);
  } else {
    FindMutable(variable).guess = std::move(value);
  }
}

void Phase::Guess(Variable variable, double value) {
  Guess(variable, [value](double) { return value; });
}

VariableAt AtShare(Variable variable, double share) { return {variable, At::kInside, share}; }

OptimalControlProblem::OptimalControlProblem(std::string name)
    : name_(std::move(name)), number_(NextNumber()) {}

void OptimalControlProblem::Fail(const std::string& what) const {
  throw std::invalid_argument(fmt::format("{}: {}", name_, what));
}

Phase& OptimalControlProblem::AddPhase(const std::string& name, int order) {
  for (const Phase& phase : phases_) {
    if (phase.name() == name) Fail(fmt::format("two phases are named '{}'", name));
  }
  if (order != 1 && order != 2) {
    Fail(fmt::format("phase '{}': expected order 1 or 2, got {}", name, order));
  }
  phases_.push_back(Phase(this, num_phases(), name, order));
  return phases_.back();
}

Variable OptimalControlProblem::AddParameter(const std::string& name, Bounds bounds,
                                             std::optional<double> scale, double guess) {
  if (Contradict(bounds)) {
    Fail(fmt::format("parameter '{}': contradictory bounds {}", name, Describe(bounds)));
  }
  if (scale && !(*scale > 0 && std::isfinite(*scale))) {
    Fail(fmt::format("parameter '{}': expected a scale above 0, got {}", name, *scale));
  }
  parameters_.push_back({name, bounds, scale.value_or(1), guess, scale.has_value()});
  return ParameterVariable(static_cast<int>(parameters_.size()) - 1);
}

void OptimalControlProblem::SuggestScale(int parameter, double scale) {
  Parameter& of = parameters_.at(parameter);
  if (!of.has_own_scale) of.scale = scale;
}

std::vector<std::string> OptimalControlProblem::ParameterNames() const {
  std::vector<std::string> names;
  for (const Parameter& parameter : parameters_) names.push_back(parameter.name);
  return names;
}

void OptimalControlProblem::CheckInstants(const std::string& name, const Function* f,
                                          const std::vector<VariableAt>& arguments) const {
  if (f == nullptr) Fail(fmt::format("'{}' has no function", name));
  if (static_cast<int>(arguments.size()) != f->num_inputs()) {
    Fail(fmt::format("'{}' takes {} arguments, got {}", name, f->num_inputs(), arguments.size()));
  }
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const VariableAt& argument = arguments[i];
    if (!Knows(argument.variable)) {
      Fail(fmt::format("'{}': argument {} is {}", name, i, DescriptionOf(argument.variable)));
    }
    if (argument.share && !(*argument.share >= 0 && *argument.share <= 1)) {
      Fail(fmt::format("'{}': '{}' at the share {} of its phase, expected 0 to 1", name,
                       NameOf(argument.variable), *argument.share));
    }
  }
}

void OptimalControlProblem::Continue(VariableAt from, VariableAt to) {
  const std::string name = NameOf(from.variable) + " and " + NameOf(to.variable);
  const auto is_state = [this](const VariableAt& end) {
    return end.variable.kind == VariableKind::kCoordinate &&
           end.variable.order < phases_[end.variable.phase].OrderOf(end.variable.index);
  };
  const auto is_control = [](const VariableAt& end) {
    return end.variable.kind == VariableKind::kControl;
  };
  if (!(is_state(from) && is_state(to)) && !(is_control(from) && is_control(to))) {
    Fail(fmt::format(
        "{} do not continue: only coordinates below the highest order do, and controls as controls",
        name));
  }
  if (from.at != At::kEnd || to.at != At::kStart || from.variable.phase >= to.variable.phase) {
    Fail(fmt::format("{} continue from the end of a phase to the start of a later one", name));
  }
  continued_.emplace_back(from, to);
}

void OptimalControlProblem::Link(const std::string& name, std::shared_ptr<Function> f,
                                 std::vector<VariableAt> arguments, std::vector<Bounds> bounds) {
  CheckInstants(name, f.get(), arguments);
  if (bounds.size() == 1) bounds.resize(f->num_outputs(), bounds.front());
  if (static_cast<int>(bounds.size()) != f->num_outputs()) {
    Fail(fmt::format("'{}' has {} outputs and {} bounds", name, f->num_outputs(), bounds.size()));
  }
  for (const Bounds& b : bounds) {
    if (Contradict(b)) Fail(fmt::format("'{}': contradictory bounds {}", name, Describe(b)));
  }
  links_.push_back({name, std::move(f), std::move(arguments), std::move(bounds)});
}

void OptimalControlProblem::AddCost(const std::string& name, std::shared_ptr<Function> f,
                                    std::vector<VariableAt> arguments, double weight) {
  CheckInstants(name, f.get(), arguments);
  if (f->num_outputs() != 1) Fail(fmt::format("cost '{}' has {} outputs", name, f->num_outputs()));
  if (!std::isfinite(weight)) Fail(fmt::format("cost '{}' has the weight {}", name, weight));
  costs_.push_back({name, std::move(f), std::move(arguments), weight});
}

void OptimalControlProblem::AddCost(VariableAt quantity, double weight) {
  AddCost(NameOf(quantity.variable),
          Differentiated<1, 1>([](const auto& z, auto* y) { (*y)[0] = z[0]; }), {quantity}, weight);
}

bool OptimalControlProblem::Knows(Variable variable) const {
  if (variable.problem != number_) return false;
  if (variable.kind == VariableKind::kParameter) {
    return variable.index >= 0 && variable.index < static_cast<int>(parameters_.size());
  }
  return variable.phase >= 0 && variable.phase < num_phases() &&
         phases_[variable.phase].Knows(variable);
}

std::string OptimalControlProblem::DescriptionOf(Variable variable) const {
  if (Knows(variable)) return fmt::format("'{}'", NameOf(variable));
  const char* whose = variable.problem == 0         ? "no problem"
                      : variable.problem == number_ ? "this problem, but does not exist"
                                                    : "another problem";
  return fmt::format("{} {} of {}", Describe(variable.kind), variable.index, whose);
}

std::string OptimalControlProblem::NameOf(Variable variable) const {
  if (!Knows(variable)) Fail(DescriptionOf(variable));
  if (variable.kind == VariableKind::kParameter) return parameters_[variable.index].name;
  const Phase& phase = phases_[variable.phase];
  return phase.name() + ": " + phase.NameOf(variable);
}

}  // namespace possibility::collocation
