#include "experiments/bench/differenced_program.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

namespace possibility::experiments {
namespace {

using Eigen::VectorXd;

/// A point near x within the bounds, other than x in every variable that is free.
VectorXd PointNear(const VectorXd& x, const VectorXd& lower, const VectorXd& upper,
                   std::mt19937* random) {
  std::uniform_real_distribution<double> uniform(-0.1, 0.1);
  VectorXd point = x;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    double step = uniform(*random) * (1 + std::abs(x[i]));
    if (x[i] + step > upper[i] || x[i] + step < lower[i]) step = -step;
    point[i] = std::clamp(x[i] + step, lower[i], upper[i]);
  }
  return point;
}

/// Step from x within the bounds, exact: the rounding error of the sum is not part of it.
double Step(double x, double upper) {
  const double size =
      std::sqrt(std::numeric_limits<double>::epsilon()) * std::max(1.0, std::abs(x));
  const volatile double stepped = x + size > upper ? x - size : x + size;
  return stepped - x;
}

}  // namespace

DifferencedProgram::DifferencedProgram(NonlinearProgram* program, const VectorXd& x)
    : program_(program),
      columns_(program->num_variables()),
      at_x_(program->num_constraints()),
      stepped_(program->num_constraints()) {
  const collocation::SparsityPattern& pattern = jacobian_pattern();
  for (int k = 0; k < pattern.size(); ++k) columns_[pattern.columns[k]].push_back(k);
  FindConstants(x);
  GroupColumns();
}

void DifferencedProgram::FindConstants(const VectorXd& x) {
  const int entries = jacobian_pattern().size();
  constants_.resize(entries);
  program_->Jacobian(x, &constants_);
  is_constant_.assign(entries, true);
  std::mt19937 random(1);
  VectorXd values(entries);
  for (int trial = 0; trial < 3; ++trial) {
    program_->Jacobian(PointNear(x, lower(), upper(), &random), &values);
    for (int k = 0; k < entries; ++k) {
      const double difference = std::abs(values[k] - constants_[k]);
      is_constant_[k] = is_constant_[k] && difference <= 1e-13 * (1 + std::abs(constants_[k]));
    }
  }
}

void DifferencedProgram::GroupColumns() {
  const std::vector<int>& rows = jacobian_pattern().rows;
  std::vector<int> order(columns_.size());
  std::iota(order.begin(), order.end(), 0);
  // Dense columns first: they find the fewest partners.
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return columns_[a].size() > columns_[b].size(); });
  std::vector<std::vector<bool>> taken;  // by group, row
  for (const int column : order) {
    std::vector<int> varying;
    for (const int entry : columns_[column]) {
      if (!is_constant_[entry]) varying.push_back(rows[entry]);
    }
    if (varying.empty()) continue;
    std::size_t group = 0;
    const auto clashes = [&](int row) { return taken[group][row]; };
    while (group < groups_.size() && std::any_of(varying.begin(), varying.end(), clashes)) ++group;
    if (group == groups_.size()) {
      groups_.emplace_back();
      taken.emplace_back(num_constraints(), false);
    }
    groups_[group].push_back(column);
    for (const int row : varying) taken[group][row] = true;
  }
}

void DifferencedProgram::Jacobian(const VectorXd& x, VectorXd* values) {
  const std::vector<int>& rows = jacobian_pattern().rows;
  *values = constants_;
  program_->Constraints(x, &at_x_);
  for (const std::vector<int>& group : groups_) {
    x_stepped_ = x;
    for (const int column : group) x_stepped_[column] += Step(x[column], upper()[column]);
    program_->Constraints(x_stepped_, &stepped_);
    stepped_ -= at_x_;
    for (const int column : group) {  // removes what constant entries added to other rows
      for (const int entry : columns_[column]) {
        if (is_constant_[entry]) {
          stepped_[rows[entry]] -= constants_[entry] * (x_stepped_[column] - x[column]);
        }
      }
    }
    for (const int column : group) {
      for (const int entry : columns_[column]) {
        if (is_constant_[entry]) continue;
        (*values)[entry] = stepped_[rows[entry]] / (x_stepped_[column] - x[column]);
      }
    }
  }
}

}  // namespace possibility::experiments
