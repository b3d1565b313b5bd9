#include "collocation/problem/constraint_block.h"

namespace possibility::collocation {

ConstraintBlock::ConstraintBlock(std::shared_ptr<Function> function,
                                 std::vector<PolynomialForm> arguments,
                                 const Eigen::VectorXd& scales)
    : function_(function, std::move(arguments)),
      factors_(scales.size() == 0 ? Eigen::VectorXd::Ones(function->num_outputs())
                                  : Eigen::VectorXd(scales.cwiseInverse())),
      jacobian_mask_(function->JacobianMask()),
      multipliers_(function->num_outputs()) {}

void ConstraintBlock::FindSlots(int first_row, ElementSlots* jacobian, ElementSlots* hessian) {
  first_row_ = first_row;
  const std::vector<PolynomialForm>& arguments = function_.arguments();
  for (std::size_t a = 0; a < arguments.size(); ++a) {
    arguments[a].Gradient(AllOnes(), [&](int variable, double) {
      for (int o = 0; o < function_.num_outputs(); ++o) {
        if (jacobian_mask_(o, a)) jacobian_slots_.push_back(jacobian->At(first_row + o, variable));
      }
    });
  }
  function_.FindHessianSlots(hessian);
}

void ConstraintBlock::AddRows(const Eigen::VectorXd& x, Eigen::VectorXd* constraints) {
  function_.SetPoint(x);
  const Eigen::VectorXd& y = function_.Evaluate();
  constraints->segment(first_row_, y.size()) = factors_.cwiseProduct(y);
}

void ConstraintBlock::AddJacobian(const Eigen::VectorXd& x, Eigen::VectorXd* values) {
  function_.SetPoint(x);
  const Eigen::MatrixXd& J = function_.Jacobian();
  const std::vector<PolynomialForm>& arguments = function_.arguments();
  const int* slot = jacobian_slots_.data();
  for (std::size_t a = 0; a < arguments.size(); ++a) {
    arguments[a].Gradient(x, [&](int, double derivative) {
      for (int o = 0; o < function_.num_outputs(); ++o) {
        if (jacobian_mask_(o, a)) (*values)[*slot++] += factors_[o] * J(o, a) * derivative;
      }
    });
  }
}

void ConstraintBlock::AddHessian(const Eigen::VectorXd& x, const Eigen::VectorXd& multipliers,
                                 Eigen::VectorXd* values) {
  function_.SetPoint(x);
  multipliers_ = factors_.cwiseProduct(multipliers.segment(first_row_, function_.num_outputs()));
  function_.AddHessian(x, multipliers_, values);
}

}  // namespace possibility::collocation
