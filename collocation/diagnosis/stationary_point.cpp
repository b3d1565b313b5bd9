#include "collocation/diagnosis/stationary_point.h"

#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "collocation/diagnosis/active_set.h"
#include "collocation/kkt/kkt_factorisation.h"

namespace possibility::collocation {
namespace {

using Eigen::VectorXd;

constexpr double kPivotThreshold = 1e-4;
// Small beside the squares of Jacobian entries, which are of order one, and large beside rounding.
constexpr double kDualShift = 1e-10;

/// First and second derivatives at the solution.
struct Derivatives {
  VectorXd jacobian;
  VectorXd hessian;
  VectorXd uncertainty;  // by variable: what the Hessian's diagonal may be off by
};

std::optional<Derivatives> Evaluate(NonlinearProgram* program, const SolverResult& result,
                                    const ActiveSet& active, const SolverOptions& options) {
  Derivatives derivatives;
  // Rows that do not hold have no multiplier, only a remainder of the barrier.
  VectorXd multipliers = result.constraint_multipliers;
  for (int row = 0; row < multipliers.size(); ++row) {
    if (active.rows[row] == Hold::kFree) multipliers[row] = 0;
  }
  const SparsityPattern& pattern = program->hessian_pattern();
  derivatives.jacobian.resize(program->jacobian_pattern().size());
  derivatives.hessian.resize(pattern.size());
  try {
    program->Jacobian(result.x, &derivatives.jacobian);
    program->Hessian(result.x, 1, multipliers, &derivatives.hessian);
  } catch (const std::runtime_error&) {  // undefined here
    return std::nullopt;
  }
  // A matrix whose entries are wrong by these shares is wrong by at most a diagonal of their sums.
  VectorXd size = VectorXd::Constant(program->num_variables(), options.objective_size);
  for (int k = 0; k < pattern.size(); ++k) {
    const int i = pattern.rows[k], j = pattern.columns[k];
    size[i] += std::abs(derivatives.hessian[k]);
    if (i != j) size[j] += std::abs(derivatives.hessian[k]);
  }
  derivatives.uncertainty = options.tolerance * size;
  return derivatives;
}

/// The matrix [W + s U, J'; J, t I] of the variables that are not held and of the rows that hold,
/// with U the uncertainty. Whatever holds at least as firmly as `held` counts as held.
class HeldSystem {
 public:
  HeldSystem(const NonlinearProgram& program, const ActiveSet& active, Hold held)
      : program_(program) {
    variable_at_ = Number(active.variables, [&](Hold hold) { return hold < held; });
    num_variables_ = size_;
    const std::vector<bool> can_move = RowsThatMove();
    std::size_t row = 0;
    row_at_ = Number(active.rows, [&](Hold hold) { return hold >= held && can_move[row++]; });
  }

  int num_rows() const { return size_ - num_variables_; }

  /// Number of negative eigenvalues; none if the matrix is singular or nearly so.
  std::optional<int> NumNegative(const Derivatives& derivatives, double s, double t,
                                 const CancellationToken& cancellation) const;

 private:
  template <typename Condition>
  std::vector<int> Number(const std::vector<Hold>& holds, const Condition& counts) {
    std::vector<int> place;
    place.reserve(holds.size());
    for (const Hold hold : holds) place.push_back(counts(hold) ? size_++ : -1);
    return place;
  }

  /// Rows that depend on a variable that is not held.
  std::vector<bool> RowsThatMove() const {
    std::vector<bool> moves(program_.num_constraints(), false);
    const SparsityPattern& pattern = program_.jacobian_pattern();
    for (int k = 0; k < pattern.size(); ++k) {
      if (variable_at_[pattern.columns[k]] >= 0) moves[pattern.rows[k]] = true;
    }
    return moves;
  }

  std::vector<double> Times() const;

  const NonlinearProgram& program_;
  std::vector<int> variable_at_, row_at_;  // place in the matrix, or -1
  int num_variables_ = 0;
  int size_ = 0;
};

std::vector<double> HeldSystem::Times() const {
  const std::vector<double> variables = program_.VariableTimes();
  const std::vector<double> rows = program_.ConstraintTimes();
  if (variables.empty() || rows.empty()) return {};
  std::vector<double> times(size_);
  for (std::size_t i = 0; i < variables.size(); ++i) {
    if (variable_at_[i] >= 0) times[variable_at_[i]] = variables[i];
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (row_at_[i] >= 0) times[row_at_[i]] = rows[i];
  }
  return times;
}

std::optional<int> HeldSystem::NumNegative(const Derivatives& derivatives, double s, double t,
                                           const CancellationToken& cancellation) const {
  std::vector<int> rows, columns;
  std::vector<double> values;
  const auto add = [&](int row, int column, double value) {
    if (row < 0 || column < 0) return;
    rows.push_back(row);
    columns.push_back(column);
    values.push_back(value);
  };
  const SparsityPattern& hessian = program_.hessian_pattern();
  for (int k = 0; k < hessian.size(); ++k) {
    add(variable_at_[hessian.rows[k]], variable_at_[hessian.columns[k]], derivatives.hessian[k]);
  }
  const SparsityPattern& jacobian = program_.jacobian_pattern();
  for (int k = 0; k < jacobian.size(); ++k) {
    add(row_at_[jacobian.rows[k]], variable_at_[jacobian.columns[k]], derivatives.jacobian[k]);
  }
  for (std::size_t i = 0; i < variable_at_.size(); ++i) {
    add(variable_at_[i], variable_at_[i], s * derivatives.uncertainty[static_cast<int>(i)]);
  }
  for (int place = num_variables_; place < size_; ++place) add(place, place, t);

  KktFactorisation factorisation(size_, num_rows(), std::move(rows), std::move(columns), Times());
  factorisation.LimitDelays(size_);
  const KktStatus status = factorisation.Factorise(values.data(), kPivotThreshold, cancellation);
  if (status != KktStatus::kFactorised) return std::nullopt;
  return factorisation.num_negative();
}

/// [W J'; J -tI] has a negative eigenvalue for each row and those of W + J'J/t (Sylvester). If the
/// latter is positive definite, so is W in all directions that keep the rows, even where rows
/// depend on each other. Bounds that may not push are left out, so more directions are tested than
/// exist.
bool IsMinimum(const NonlinearProgram& program, const ActiveSet& active,
               const Derivatives& derivatives, const CancellationToken& cancellation) {
  const HeldSystem system(program, active, Hold::kFirm);
  return system.NumNegative(derivatives, -1, -kDualShift, cancellation) == system.num_rows();
}

/// All that may hold is held, so every direction left is feasible if the rows are independent. No
/// eigenvalue of [W J'; J tI] falls as t grows. If as many are negative at t as at -t, none passes
/// zero between the two. At t = 0 the matrix is then regular, so that the rows are independent, and
/// more negative eigenvalues than rows are directions of descent (Gould 1985).
bool IsSaddle(const NonlinearProgram& program, const ActiveSet& active,
              const Derivatives& derivatives, const CancellationToken& cancellation) {
  const HeldSystem system(program, active, Hold::kWeak);
  const auto below = system.NumNegative(derivatives, 1, -kDualShift, cancellation);
  if (!below || *below <= system.num_rows()) return false;
  return system.NumNegative(derivatives, 1, kDualShift, cancellation) == below;
}

}  // namespace

const char* StationaryPointName(StationaryPoint point) {
  switch (point) {
    case StationaryPoint::kMinimum:
      return "minimum";
    case StationaryPoint::kSaddle:
      return "saddle";
    case StationaryPoint::kUnknown:
      break;
  }
  return "unknown";
}

StationaryPoint ClassifyStationaryPoint(NonlinearProgram* program, const SolverResult& result,
                                        const SolverOptions& options,
                                        const CancellationToken& cancellation) {
  if (!result.succeeded() || options.hessian != HessianMode::kExact) {
    return StationaryPoint::kUnknown;
  }
  const ActiveSet active = ActiveSetOf(*program, result, options.objective_size);
  const auto derivatives = Evaluate(program, result, active, options);
  if (!derivatives) return StationaryPoint::kUnknown;
  if (IsMinimum(*program, active, *derivatives, cancellation)) return StationaryPoint::kMinimum;
  if (IsSaddle(*program, active, *derivatives, cancellation)) return StationaryPoint::kSaddle;
  return StationaryPoint::kUnknown;
}

}  // namespace possibility::collocation
