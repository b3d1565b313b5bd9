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

/// What is tested: the Hessian W with s U added, U the uncertainty; t on the diagonal of rows.
struct Shifts {
  double s = 0;
  double t = 0;
};

/// The matrices [W + s U, J'; J, t I] of the variables that are not held and of the rows that hold.
/// Variables that may be free and rows that may hold have a place in all of them, so that one
/// symbolic analysis serves all; a place that a test leaves out has 1 on its diagonal and nothing
/// else.
class HeldSystems {
 public:
  HeldSystems(const NonlinearProgram& program, const ActiveSet& active,
              const Derivatives& derivatives);

  /// Whatever holds at least as firmly as `held` counts as held.
  void Choose(Hold held);
  int num_rows() const { return num_rows_; }

  /// Number of negative eigenvalues; none if the matrix is singular or nearly so.
  std::optional<int> NumNegative(const Shifts& shifts, const CancellationToken& cancellation);

 private:
  struct Entry {
    int row = 0;
    int column = 0;
    double value = 0;
  };

  void NumberPlaces();
  void AddEntries(const Derivatives& derivatives);
  std::vector<bool> RowsThatMove() const;
  std::vector<double> Times() const;
  KktFactorisation MakeFactorisation() const;

  const NonlinearProgram& program_;
  const ActiveSet& active_;
  std::vector<int> variable_at_, row_at_;  // place in the matrix, or -1
  int num_variables_ = 0;
  int size_ = 0;
  std::vector<Entry> entries_;  // without shifts; the last ones are the diagonal, place by place
  std::vector<double> uncertainty_;  // by place of a variable
  std::vector<bool> takes_part_;     // by place
  int num_rows_ = 0;                 // that take part
  std::optional<KktFactorisation> factorisation_;
};

HeldSystems::HeldSystems(const NonlinearProgram& program, const ActiveSet& active,
                         const Derivatives& derivatives)
    : program_(program), active_(active) {
  NumberPlaces();
  AddEntries(derivatives);
  factorisation_ = MakeFactorisation();
}

void HeldSystems::NumberPlaces() {
  for (const Hold hold : active_.variables) {
    variable_at_.push_back(hold == Hold::kFirm ? -1 : size_++);
  }
  num_variables_ = size_;
  for (const Hold hold : active_.rows) row_at_.push_back(hold == Hold::kFree ? -1 : size_++);
}

void HeldSystems::AddEntries(const Derivatives& derivatives) {
  const auto add = [this](int row, int column, double value) {
    if (row >= 0 && column >= 0) entries_.push_back({row, column, value});
  };
  const SparsityPattern& hessian = program_.hessian_pattern();
  for (int k = 0; k < hessian.size(); ++k) {
    add(variable_at_[hessian.rows[k]], variable_at_[hessian.columns[k]], derivatives.hessian[k]);
  }
  const SparsityPattern& jacobian = program_.jacobian_pattern();
  for (int k = 0; k < jacobian.size(); ++k) {
    add(row_at_[jacobian.rows[k]], variable_at_[jacobian.columns[k]], derivatives.jacobian[k]);
  }
  for (int place = 0; place < size_; ++place) add(place, place, 0);
  uncertainty_.resize(num_variables_);
  for (std::size_t i = 0; i < variable_at_.size(); ++i) {
    if (variable_at_[i] < 0) continue;
    uncertainty_[variable_at_[i]] = derivatives.uncertainty[static_cast<int>(i)];
  }
}

KktFactorisation HeldSystems::MakeFactorisation() const {
  std::vector<int> rows, columns;
  rows.reserve(entries_.size());
  columns.reserve(entries_.size());
  for (const Entry& entry : entries_) {
    rows.push_back(entry.row);
    columns.push_back(entry.column);
  }
  KktFactorisation factorisation(size_, size_ - num_variables_, std::move(rows), std::move(columns),
                                 Times());
  factorisation.LimitDelays(size_);
  return factorisation;
}

std::vector<double> HeldSystems::Times() const {
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

void HeldSystems::Choose(Hold held) {
  takes_part_.assign(size_, false);
  for (std::size_t i = 0; i < variable_at_.size(); ++i) {
    if (variable_at_[i] >= 0) takes_part_[variable_at_[i]] = active_.variables[i] < held;
  }
  const std::vector<bool> moves = RowsThatMove();
  num_rows_ = 0;
  for (std::size_t row = 0; row < row_at_.size(); ++row) {
    if (row_at_[row] < 0 || active_.rows[row] < held || !moves[row]) continue;
    takes_part_[row_at_[row]] = true;
    ++num_rows_;
  }
}

/// Rows that depend on a variable that is not held.
std::vector<bool> HeldSystems::RowsThatMove() const {
  std::vector<bool> moves(program_.num_constraints(), false);
  const SparsityPattern& pattern = program_.jacobian_pattern();
  for (int k = 0; k < pattern.size(); ++k) {
    const int place = variable_at_[pattern.columns[k]];
    if (place >= 0 && takes_part_[place]) moves[pattern.rows[k]] = true;
  }
  return moves;
}

std::optional<int> HeldSystems::NumNegative(const Shifts& shifts,
                                            const CancellationToken& cancellation) {
  std::vector<double> values;
  values.reserve(entries_.size());
  for (const Entry& entry : entries_) {
    const bool counts = takes_part_[entry.row] && takes_part_[entry.column];
    values.push_back(counts ? entry.value : 0);
  }
  double* diagonal = values.data() + values.size() - size_;
  for (int place = 0; place < size_; ++place) {
    const double shift = place < num_variables_ ? shifts.s * uncertainty_[place] : shifts.t;
    diagonal[place] = takes_part_[place] ? shift : 1;
  }
  const KktStatus status = factorisation_->Factorise(values.data(), kPivotThreshold, cancellation);
  if (status != KktStatus::kFactorised) return std::nullopt;
  return factorisation_->num_negative();
}

/// [W J'; J -tI] has a negative eigenvalue for each row and those of W + J'J/t (Sylvester). If the
/// latter is positive definite, so is W in all directions that keep the rows, even where rows
/// depend on each other. Bounds that may not push are left out, so more directions are tested than
/// exist.
bool IsMinimum(HeldSystems* systems, const CancellationToken& cancellation) {
  systems->Choose(Hold::kFirm);
  return systems->NumNegative({-1, -kDualShift}, cancellation) == systems->num_rows();
}

/// All that may hold is held, so every direction left is feasible if the rows are independent. No
/// eigenvalue of [W J'; J tI] falls as t grows. If as many are negative at t as at -t, none passes
/// zero between the two. At t = 0 the matrix is then regular, so that the rows are independent, and
/// more negative eigenvalues than rows are directions of descent (Gould 1985).
bool IsSaddle(HeldSystems* systems, const CancellationToken& cancellation) {
  systems->Choose(Hold::kWeak);
  const auto below = systems->NumNegative({1, -kDualShift}, cancellation);
  if (!below || *below <= systems->num_rows()) return false;
  return systems->NumNegative({1, kDualShift}, cancellation) == below;
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
  HeldSystems systems(*program, active, *derivatives);
  if (IsMinimum(&systems, cancellation)) return StationaryPoint::kMinimum;
  if (IsSaddle(&systems, cancellation)) return StationaryPoint::kSaddle;
  return StationaryPoint::kUnknown;
}

}  // namespace possibility::collocation
