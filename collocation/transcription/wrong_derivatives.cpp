#include "collocation/transcription/wrong_derivatives.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "collocation/problem/check_derivatives.h"

namespace possibility::collocation {

namespace {

/// The arguments of a function at one point: names, values and typical sizes.
struct Arguments {
  std::vector<std::string> names;
  std::vector<double> values, sizes;
};

Eigen::VectorXd AsVector(const std::vector<double>& from) {
  return Eigen::Map<const Eigen::VectorXd>(from.data(), static_cast<Eigen::Index>(from.size()));
}

std::string Sentence(const DerivativeFault& fault, const Arguments& arguments) {
  const auto name = [&](int i) { return fmt::format("argument '{}'", arguments.names[i]); };
  const bool is_first = fault.kind == DerivativeFault::Kind::kJacobian ||
                        fault.kind == DerivativeFault::Kind::kJacobianMask;
  const bool is_hidden = fault.kind == DerivativeFault::Kind::kJacobianMask ||
                         fault.kind == DerivativeFault::Kind::kHessianMask;
  const std::string output =
      fault.output < 0 ? "all outputs together" : fmt::format("output {}", fault.output);
  const std::string what =
      is_first ? fmt::format("d {} / d {}", output, name(fault.column))
               : fmt::format("d2 {} / d {} d {}", output, name(fault.row), name(fault.column));
  return fmt::format("{} is {:.6g}{}, differences give {:.6g}", what, fault.given,
                     is_hidden ? " and left out by the mask" : "", fault.differenced);
}

class Check {
 public:
  Check(const VariableLayout& layout, const Eigen::VectorXd& x,
        const CancellationToken& cancellation)
      : layout_(layout),
        problem_(layout.problem()),
        x_(layout.Unscaled(x)),
        cancellation_(cancellation) {}

  std::vector<std::string> Run() {
    for (int p = 0; p < problem_.num_phases(); ++p) {
      for (const auto& constraint : problem_.phase(p).constraints()) {
        CheckAlong(p, fmt::format("constraint '{}'", constraint.name), constraint.function.get(),
                   constraint.arguments, PointsOf(p, constraint));
      }
      for (const auto& cost : problem_.phase(p).costs()) {
        CheckAlong(p, fmt::format("cost '{}'", cost.name), cost.function.get(), cost.arguments,
                   PointsWithValues(p));
      }
      for (const auto& integral : problem_.phase(p).integrals()) {
        CheckAlong(p, fmt::format("integral '{}'", integral.name), integral.function.get(),
                   integral.arguments, PointsWithValues(p));
      }
    }
    for (const auto& link : problem_.links()) {
      CheckAt(fmt::format("constraint '{}'", link.name), link.function.get(),
              InstantArguments(link.arguments));
    }
    for (const auto& cost : problem_.costs()) {
      CheckAt(fmt::format("cost '{}'", cost.name), cost.function.get(),
              InstantArguments(cost.arguments));
    }
    return std::move(sentences_);
  }

 private:
  std::vector<int> PointsOf(int phase, const Phase::PathConstraint& constraint) const {
    const std::vector<LayoutPoint>& all = layout_.phase(phase).points;
    std::vector<int> points;
    for (int k = 0; k < static_cast<int>(all.size()); ++k) {
      if (IsImposedAt(constraint, all, k)) points.push_back(k);
    }
    return points;
  }

  /// Where integrands are evaluated.
  std::vector<int> PointsWithValues(int phase) const {
    const std::vector<LayoutPoint>& all = layout_.phase(phase).points;
    std::vector<int> points;
    for (int k = 0; k < static_cast<int>(all.size()); ++k) {
      if (all[k].has_values) points.push_back(k);
    }
    return points;
  }

  double SizeOf(Variable variable) const {
    switch (variable.kind) {
      case VariableKind::kCoordinate:
      case VariableKind::kControl:
        return problem_.phase(variable.phase).Find(variable).scale;
      case VariableKind::kParameter:
        return problem_.parameters()[variable.index].scale;
      case VariableKind::kDuration:
      case VariableKind::kTime:
        return problem_.phase(variable.phase).duration_bounds().upper;
      case VariableKind::kShare:
        return 1;
    }
    return 1;
  }

  void CheckAlong(int phase, const std::string& function_name, Function* f,
                  const std::vector<Variable>& variables, const std::vector<int>& points) {
    if (points.empty()) return;
    std::vector<int> chosen = {points.front(), points[points.size() / 2], points.back()};
    chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
    for (const int point : chosen) {
      Arguments arguments;
      for (const Variable& variable : variables) {
        arguments.names.push_back(problem_.phase(phase).NameOf(variable));
        arguments.values.push_back(layout_.FormOf(variable, phase, point).Value(x_));
        arguments.sizes.push_back(SizeOf(variable));
      }
      CheckAt(fmt::format("{}, phase '{}', {}", function_name, problem_.phase(phase).name(),
                          layout_.KnotName(phase, point)),
              f, arguments);
    }
  }

  Arguments InstantArguments(const std::vector<VariableAt>& instants) const {
    Arguments arguments;
    for (const VariableAt& instant : instants) {
      arguments.names.push_back(problem_.NameOf(instant.variable));
      arguments.values.push_back(layout_.InstantForm(instant).Value(x_));
      arguments.sizes.push_back(SizeOf(instant.variable));
    }
    return arguments;
  }

  void CheckAt(const std::string& place, Function* f, const Arguments& arguments) {
    cancellation_.ThrowIfCancelled();
    DerivativeCheck check;
    check.sizes = AsVector(arguments.sizes);
    try {
      for (const auto& fault : CheckDerivatives(f, AsVector(arguments.values), check)) {
        sentences_.push_back(place + ": " + Sentence(fault, arguments));
      }
    } catch (const std::runtime_error&) {  // The solver will name it.
    }
  }

  const VariableLayout& layout_;
  const OptimalControlProblem& problem_;
  const Eigen::VectorXd x_;  // in the problem's own units
  const CancellationToken& cancellation_;
  std::vector<std::string> sentences_;
};

}  // namespace

std::vector<std::string> WrongDerivatives(const VariableLayout& layout, const Eigen::VectorXd& x,
                                          const CancellationToken& cancellation) {
  return Check(layout, x, cancellation).Run();
}

}  // namespace possibility::collocation
