#include "collocation/diagnosis/multiplier_estimate.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <vector>

namespace possibility::collocation {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Whether a bound on either side holds.
struct Sides {
  bool lower = false;
  bool upper = false;

  bool any() const { return lower || upper; }
  /// Lets go of a bound that a force of this sign, upwards > 0, does not come from.
  bool Release(double push) {
    const Sides before = *this;
    lower = lower && push >= 0;
    upper = upper && push <= 0;
    // A bound on both sides can push either way.
    if (before.lower && before.upper) *this = before;
    return any() != before.any();
  }
};

std::vector<Sides> SidesOf(const VectorXd& lower, const VectorXd& upper, const VectorXd& value,
                           double distance) {
  std::vector<Sides> sides;
  sides.reserve(value.size());
  for (int i = 0; i < value.size(); ++i) {
    sides.push_back({value[i] - lower[i] <= distance, upper[i] - value[i] <= distance});
  }
  return sides;
}

std::vector<int> Where(const std::vector<Sides>& sides, bool held) {
  std::vector<int> places;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    if (sides[i].any() == held) places.push_back(static_cast<int>(i));
  }
  return places;
}

}  // namespace

MultiplierEstimate EstimateMultipliers(NonlinearProgram* program, const VectorXd& x,
                                       double distance) {
  constexpr int kMostRounds = 20;
  const int n = program->num_variables(), m = program->num_constraints();
  VectorXd gradient(n), g(m), values(program->jacobian_pattern().size());
  program->Gradient(x, &gradient);
  program->Constraints(x, &g);
  program->Jacobian(x, &values);
  MatrixXd pull = MatrixXd::Zero(n, m);  // J'
  for (int k = 0; k < values.size(); ++k) {
    pull(program->jacobian_pattern().columns[k], program->jacobian_pattern().rows[k]) += values[k];
  }
  std::vector<Sides> variables = SidesOf(program->lower(), program->upper(), x, distance);
  std::vector<Sides> rows =
      SidesOf(program->constraint_lower(), program->constraint_upper(), g, distance);

  MultiplierEstimate estimate;
  estimate.gradient = gradient.lpNorm<Eigen::Infinity>();
  VectorXd rest = gradient;
  for (int round = 0; round < kMostRounds; ++round) {
    const std::vector<int> free = Where(variables, false), held = Where(rows, true);
    estimate.rows.setZero(m);
    if (!free.empty() && !held.empty()) {
      const MatrixXd matrix = pull(free, held);
      const VectorXd right = -gradient(free);
      const VectorXd multipliers = matrix.completeOrthogonalDecomposition().solve(right);
      estimate.rows(held) = multipliers;
    }
    rest = gradient + pull * estimate.rows;
    bool released = false;
    for (const int row : held) released |= rows[row].Release(-estimate.rows[row]);
    for (const int i : Where(variables, true)) released |= variables[i].Release(rest[i]);
    estimate.residual = free.empty() ? 0 : rest(free).lpNorm<Eigen::Infinity>();
    if (!released) break;
  }
  estimate.lower.setZero(n);
  estimate.upper.setZero(n);
  for (const int i : Where(variables, true))
    (rest[i] > 0 ? estimate.lower : estimate.upper)[i] = std::abs(rest[i]);
  return estimate;
}

}  // namespace possibility::collocation
