#include "collocation/diagnosis/elastic_program.h"

#include <algorithm>
#include <limits>

namespace possibility::collocation {

using Eigen::VectorXd;

ElasticProgram::ElasticProgram(NonlinearProgram* program)
    : program_(program),
      num_inner_(program->num_variables()),
      num_rows_(program->num_constraints()),
      lower_(VectorXd::Zero(num_inner_ + 2 * num_rows_)),
      upper_(
          VectorXd::Constant(num_inner_ + 2 * num_rows_, std::numeric_limits<double>::infinity())),
      jacobian_pattern_(program->jacobian_pattern()),
      inner_values_(program->jacobian_pattern().size()) {
  lower_.head(num_inner_) = program->lower();
  upper_.head(num_inner_) = program->upper();
  for (int row = 0; row < num_rows_; ++row) jacobian_pattern_.Add(row, num_inner_ + row);
  for (int row = 0; row < num_rows_; ++row)
    jacobian_pattern_.Add(row, num_inner_ + num_rows_ + row);
}

VectorXd ElasticProgram::StartAt(const VectorXd& x) {
  VectorXd start = VectorXd::Zero(num_variables());
  start.head(num_inner_) = x.cwiseMax(program_->lower()).cwiseMin(program_->upper());
  VectorXd g(num_rows_);
  program_->Constraints(InnerPart(start), &g);
  for (int row = 0; row < num_rows_; ++row) {
    start[num_inner_ + row] = std::max(0.0, constraint_lower()[row] - g[row]);
    start[num_inner_ + num_rows_ + row] = std::max(0.0, g[row] - constraint_upper()[row]);
  }
  return start;
}

void ElasticProgram::Gradient(const VectorXd&, VectorXd* gradient) {
  gradient->setZero();
  gradient->tail(2 * num_rows_).setOnes();
}

void ElasticProgram::Constraints(const VectorXd& x, VectorXd* g) {
  program_->Constraints(InnerPart(x), g);
  *g += x.segment(num_inner_, num_rows_) - x.tail(num_rows_);
}

void ElasticProgram::Jacobian(const VectorXd& x, VectorXd* values) {
  program_->Jacobian(InnerPart(x), &inner_values_);
  values->head(inner_values_.size()) = inner_values_;
  values->segment(inner_values_.size(), num_rows_).setOnes();
  values->tail(num_rows_).setConstant(-1);
}

void ElasticProgram::Hessian(const VectorXd& x, double, const VectorXd& multipliers,
                             VectorXd* values) {
  program_->Hessian(InnerPart(x), 0, multipliers, values);
}

std::string ElasticProgram::VariableName(int variable) const {
  if (variable < num_inner_) return program_->VariableName(variable);
  const int row = (variable - num_inner_) % num_rows_;
  return "violation of " + program_->ConstraintName(row);
}

std::vector<double> ElasticProgram::VariableTimes() const {
  std::vector<double> times = program_->VariableTimes();
  const std::vector<double> rows = program_->ConstraintTimes();
  if (times.empty() || rows.empty()) return {};
  for (int side = 0; side < 2; ++side) times.insert(times.end(), rows.begin(), rows.end());
  return times;
}

}  // namespace possibility::collocation
