#include "collocation/diagnosis/conflict.h"

#include <algorithm>
#include <cmath>

#include "collocation/diagnosis/elastic_program.h"

namespace possibility::collocation {
namespace {

using Eigen::VectorXd;

/// J' multipliers.
VectorXd PullOfRows(NonlinearProgram* program, const VectorXd& x, const VectorXd& multipliers) {
  const SparsityPattern& pattern = program->jacobian_pattern();
  VectorXd values(pattern.size());
  program->Jacobian(x, &values);
  VectorXd pull = VectorXd::Zero(program->num_variables());
  for (int k = 0; k < pattern.size(); ++k) {
    pull[pattern.columns[k]] += values[k] * multipliers[pattern.rows[k]];
  }
  return pull;
}

/// The bound against which a variable is pulled: towards lower values if `pull` > 0.
ConflictMember::Kind BoundAgainst(const NonlinearProgram& program, int variable, double pull) {
  if (program.lower()[variable] == program.upper()[variable]) return ConflictMember::Kind::kFixed;
  return pull > 0 ? ConflictMember::Kind::kLower : ConflictMember::Kind::kUpper;
}

}  // namespace

Conflict FindConflict(NonlinearProgram* program, const VectorXd& x, const SolverOptions& options,
                      const CancellationToken& cancellation) {
  constexpr double kShare = 1e-3;  // lighter members come from the solver's tolerance
  ElasticProgram elastic(program);
  SolverOptions sums = options;
  sums.objective_size = 1;
  const SolverResult result = Solve(&elastic, {elastic.StartAt(x), {}, {}, {}}, sums, cancellation);
  if (result.status == SolverStatus::kCancelled) throw Cancelled();
  Conflict conflict;
  conflict.x = elastic.InnerPart(result.x);
  conflict.violation = result.objective;
  const double tolerance = options.constraint_tolerance * (1 + program->num_constraints());
  if (!result.succeeded() || conflict.violation <= tolerance) return conflict;

  const VectorXd& rows = result.constraint_multipliers;
  const VectorXd pull = PullOfRows(program, conflict.x, rows);
  const double greatest = std::max(rows.lpNorm<Eigen::Infinity>(), pull.lpNorm<Eigen::Infinity>());
  const auto add = [&](ConflictMember::Kind kind, int index, double multiplier) {
    const double weight = std::abs(multiplier) / greatest;
    if (weight > kShare) conflict.members.push_back({kind, index, weight});
  };
  for (int row = 0; row < program->num_constraints(); ++row) {
    add(ConflictMember::Kind::kRow, row, rows[row]);
  }
  for (int i = 0; i < program->num_variables(); ++i) {
    add(BoundAgainst(*program, i, pull[i]), i, pull[i]);
  }
  std::stable_sort(conflict.members.begin(), conflict.members.end(),
                   [](const auto& a, const auto& b) { return a.weight > b.weight; });
  return conflict;
}

}  // namespace possibility::collocation
