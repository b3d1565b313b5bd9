#include "collocation/transcription/automatic_scales.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "collocation/transcription/initial_guess.h"
#include "collocation/transcription/variable_layout.h"

namespace possibility::collocation {

namespace {

constexpr int kIntervals = 10;  // of the mesh on which the guess is looked at

/// Greatest finite bound, in magnitude.
double Reach(const Bounds& bounds) {
  double reach = 0;
  for (const double bound : {bounds.lower, bounds.upper}) {
    if (std::isfinite(bound)) reach = std::max(reach, std::abs(bound));
  }
  return reach;
}

class Scaling {
 public:
  explicit Scaling(OptimalControlProblem* problem)
      : problem_(*problem),
        layout_(*problem, Trapezoidal(),
                std::vector<Mesh>(problem->num_phases(), UniformMesh(kIntervals))),
        guess_(layout_.Unscaled(InitialGuess(layout_))) {}

  void Run() {
    for (int i = 0; i < static_cast<int>(problem_.parameters().size()); ++i) SetParameter(i);
    for (int p = 0; p < problem_.num_phases(); ++p) {
      const Phase& phase = problem_.phase(p);
      for (int c = 0; c < static_cast<int>(phase.coordinates().size()); ++c) SetCoordinate(p, c);
      for (int c = 0; c < static_cast<int>(phase.controls().size()); ++c) SetControl(p, c);
      for (int i = 0; i < static_cast<int>(phase.constraints().size()); ++i) SetRows(p, i);
    }
  }

 private:
  void SetParameter(int index) {
    const auto& parameter = problem_.parameters()[index];
    const double size = std::max(Reach(parameter.bounds), std::abs(parameter.guess));
    if (size > 0) problem_.SuggestScale(index, size);
  }

  /// Of bounds and guess; 0: nothing is known. Guesses of derivatives count if they are explicit:
  /// the others are differences.
  double KnownSize(int phase, Variable variable) const {
    const Phase::Quantity& quantity = problem_.phase(phase).Find(variable);
    double size = 0;
    for (const auto& [at, bounds] : quantity.bounds) size = std::max(size, Reach(bounds));
    if (variable.order > 0 && !quantity.guess) return size;
    for (int point = 0; point <= kIntervals; ++point) {
      size = std::max(size, std::abs(GuessAt(phase, variable, point)));
    }
    return size;
  }

  double GuessAt(int phase, Variable variable, int point) const {
    return layout_.FormOf(variable, phase, point).Value(guess_);
  }

  void SetCoordinate(int p, int index) {
    const Phase& phase = problem_.phase(p);
    for (int order = 0; order <= phase.OrderOf(index); ++order) {
      const Variable variable = phase.Coordinate(index, order);
      double size = KnownSize(p, variable);
      if (size == 0 && order > 0) {
        size = phase.coordinates()[index][order - 1].scale / layout_.DurationOf(p, guess_);
      }
      if (size > 0) problem_.phase(p).SuggestScale(variable, size);
    }
  }

  void SetControl(int p, int index) {
    const Variable control = problem_.phase(p).Control(index);
    double size = KnownSize(p, control);
    if (size == 0) size = SizeByDynamics(p, control);
    if (size > 0) problem_.phase(p).SuggestScale(control, size);
  }

  /// The least size that changes a row of dynamics by its highest derivative's; 0: no row has it.
  double SizeByDynamics(int p, Variable control) const {
    double size = 0;
    for (const Phase::PathConstraint& constraint : problem_.phase(p).constraints()) {
      if (!constraint.is_dynamics) continue;
      const Eigen::MatrixXd J = GreatestJacobian(p, constraint);
      for (std::size_t a = 0; a < constraint.arguments.size(); ++a) {
        if (constraint.arguments[a] != control) continue;
        for (Eigen::Index row = 0; row < J.rows(); ++row) {
          const double change = J(row, static_cast<Eigen::Index>(a));
          if (change == 0) continue;
          const double one = ScaleOfRate(p, row) / change;
          size = size == 0 ? one : std::min(size, one);
        }
      }
    }
    return size;
  }

  double ScaleOfRate(int p, Eigen::Index coordinate) const {
    return problem_.phase(p).coordinates()[coordinate].back().scale;
  }

  /// Magnitudes at the start, the middle and the end of the guess; zero where there are none.
  Eigen::MatrixXd GreatestJacobian(int p, const Phase::PathConstraint& constraint) const {
    Function& f = *constraint.function;
    Eigen::MatrixXd greatest = Eigen::MatrixXd::Zero(f.num_outputs(), f.num_inputs());
    Eigen::MatrixXd J = greatest;
    Eigen::VectorXd z(f.num_inputs());
    for (const int point : {0, kIntervals / 2, kIntervals}) {
      for (int a = 0; a < f.num_inputs(); ++a) z[a] = GuessAt(p, constraint.arguments[a], point);
      try {
        f.Jacobian(z, &J);
      } catch (const std::runtime_error&) {  // The solver will name it.
        continue;
      }
      if (J.allFinite()) greatest = greatest.cwiseMax(J.cwiseAbs());
    }
    return (f.JacobianMask().select(greatest.array(), 0)).matrix();
  }

  void SetRows(int p, int index) {
    const Phase::PathConstraint& constraint = problem_.phase(p).constraints()[index];
    Eigen::VectorXd scales = constraint.scales;
    if (constraint.is_dynamics) {
      for (Eigen::Index row = 0; row < scales.size(); ++row) scales[row] = ScaleOfRate(p, row);
    } else {
      Eigen::VectorXd sizes(constraint.function->num_inputs());
      for (Eigen::Index a = 0; a < sizes.size(); ++a) sizes[a] = SizeOf(p, constraint.arguments[a]);
      const Eigen::MatrixXd changes = GreatestJacobian(p, constraint) * sizes.asDiagonal();
      for (Eigen::Index row = 0; row < scales.size(); ++row) {
        const double change = changes.row(row).maxCoeff();
        if (change > 0) scales[row] = change;
      }
    }
    problem_.phase(p).SuggestRowScales(index, scales);
  }

  double SizeOf(int p, Variable variable) const {
    switch (variable.kind) {
      case VariableKind::kCoordinate:
      case VariableKind::kControl:
        return problem_.phase(p).Find(variable).scale;
      case VariableKind::kParameter:
        return problem_.parameters()[variable.index].scale;
      case VariableKind::kDuration:
      case VariableKind::kTime:
        return layout_.DurationOf(p, guess_);
      case VariableKind::kShare:
        return 1;
    }
    return 1;
  }

  OptimalControlProblem& problem_;
  const VariableLayout layout_;
  const Eigen::VectorXd guess_;  // in the problem's own units
};

}  // namespace

void SetAutomaticScales(OptimalControlProblem* problem) { Scaling(problem).Run(); }

}  // namespace possibility::collocation
