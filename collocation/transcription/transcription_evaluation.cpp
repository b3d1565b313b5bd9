// Evaluations of a Transcription for the solver, after it is laid out.
#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "collocation/transcription/transcription.h"

namespace possibility::collocation {

double Transcription::Objective(const Eigen::VectorXd& x) {
  const Eigen::VectorXd unscaled = Scaled(x);
  double sum = 0;
  for (std::size_t i = 0; i < costs_.size(); ++i) {
    const double cost = costs_[i].Cost(unscaled);
    if (!std::isfinite(cost)) {
      throw std::runtime_error(fmt::format("cost '{}' is {}", FullName(cost_names_[i]), cost));
    }
    sum += cost;
  }
  return sum;
}

void Transcription::Gradient(const Eigen::VectorXd& x, Eigen::VectorXd* gradient) {
  const Eigen::VectorXd unscaled = Scaled(x);
  gradient->setZero(num_variables());
  for (FunctionBlock& cost : costs_) cost.AddGradient(unscaled, gradient);
  gradient->array() *= scale_.array();
  if (!gradient->allFinite()) FailForGradient(unscaled);
}

void Transcription::FailForGradient(const Eigen::VectorXd& unscaled) {
  for (std::size_t i = 0; i < costs_.size(); ++i) {
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(num_variables());
    costs_[i].AddGradient(unscaled, &gradient);
    for (int k = 0; k < num_variables(); ++k) {
      if (std::isfinite(gradient[k])) continue;
      throw std::runtime_error(fmt::format("the derivative of cost '{}' with respect to '{}' is {}",
                                           FullName(cost_names_[i]), VariableName(k), gradient[k]));
    }
  }
  throw std::runtime_error("the derivative of the sum of all costs is not finite");
}

void Transcription::Constraints(const Eigen::VectorXd& x, Eigen::VectorXd* g) {
  const Eigen::VectorXd unscaled = Scaled(x);
  g->resize(num_constraints());
  for (std::size_t row = 0; row < form_rows_.size(); ++row) {
    (*g)[static_cast<Eigen::Index>(row)] =
        form_rows_[row].form.Value(unscaled) * form_rows_[row].scale;
  }
  for (FunctionBlock& block : blocks_) block.AddRows(unscaled, g);
}

void Transcription::Jacobian(const Eigen::VectorXd& x, Eigen::VectorXd* values) {
  const Eigen::VectorXd unscaled = Scaled(x);
  values->setZero(jacobian_.pattern().size());
  for (const FormRow& row : form_rows_) {
    const int* slot = row.jacobian_slots.data();
    row.form.Gradient(
        unscaled, [&](int, double derivative) { (*values)[*slot++] += row.scale * derivative; });
  }
  for (FunctionBlock& block : blocks_) block.AddJacobian(unscaled, values);
  const std::vector<int>& columns = jacobian_.pattern().columns;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    (*values)[static_cast<Eigen::Index>(i)] *= scale_[columns[i]];
  }
}

void Transcription::Hessian(const Eigen::VectorXd& x, double objective_factor,
                            const Eigen::VectorXd& multipliers, Eigen::VectorXd* values) {
  const Eigen::VectorXd unscaled = Scaled(x);
  values->setZero(hessian_.pattern().size());
  for (std::size_t r = 0; r < form_rows_.size(); ++r) {
    const FormRow& row = form_rows_[r];
    const double factor = multipliers[static_cast<Eigen::Index>(r)] * row.scale;
    const int* slot = row.hessian_slots.data();
    row.form.Hessian(unscaled,
                     [&](int, int, double second) { (*values)[*slot++] += factor * second; });
  }
  for (FunctionBlock& block : blocks_) block.AddHessian(unscaled, multipliers, values);
  for (FunctionBlock& cost : costs_) cost.AddCostHessian(unscaled, objective_factor, values);
  const SparsityPattern& pattern = hessian_.pattern();
  for (int i = 0; i < pattern.size(); ++i) {
    (*values)[i] *= scale_[pattern.rows[i]] * scale_[pattern.columns[i]];
  }
}

}  // namespace possibility::collocation
