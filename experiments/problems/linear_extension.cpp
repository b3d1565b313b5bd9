#include "experiments/problems/linear_extension.h"

#include <stdexcept>
#include <utility>

namespace possibility::experiments {
namespace {

using collocation::Function;
using collocation::Mask;
using Eigen::MatrixXd;
using Eigen::VectorXd;

class LinearExtensionFunction : public Function {
 public:
  LinearExtensionFunction(std::shared_ptr<Function> f, const MatrixXd& A, const MatrixXd& B)
      : Function(static_cast<int>(A.cols()), f->num_outputs()),
        f_(std::move(f)),
        A_(A),
        B_(B),
        jacobian_(f_->num_outputs(), f_->num_inputs()),
        hessian_(f_->num_inputs(), f_->num_inputs()) {}

  void Evaluate(const VectorXd& z, VectorXd* y) override {
    f_->Evaluate(A_ * z, y);
    *y += B_ * z;
  }

  void Jacobian(const VectorXd& z, MatrixXd* J) override {
    // Functions do not write entries that their masks exclude.
    jacobian_.setZero();
    f_->Jacobian(A_ * z, &jacobian_);
    *J = jacobian_ * A_ + B_;
  }

  void Hessian(const VectorXd& z, const VectorXd& multipliers, MatrixXd* H) override {
    hessian_.setZero();
    f_->Hessian(A_ * z, multipliers, &hessian_);
    *H = A_.transpose() * hessian_ * A_;
  }

  Mask JacobianMask() const override {
    const MatrixXd reached = f_->JacobianMask().cast<double>().matrix() * A_.cwiseAbs();
    return (reached + B_.cwiseAbs()).array() != 0.0;
  }

  Mask HessianMask() const override {
    const MatrixXd A = A_.cwiseAbs();
    return (A.transpose() * f_->HessianMask().cast<double>().matrix() * A).array() != 0.0;
  }

 private:
  std::shared_ptr<Function> f_;
  MatrixXd A_, B_;
  MatrixXd jacobian_, hessian_;
};

}  // namespace

std::shared_ptr<Function> LinearExtension(std::shared_ptr<Function> f, const MatrixXd& A,
                                          const MatrixXd& B) {
  if (A.rows() != f->num_inputs() || B.rows() != f->num_outputs() || A.cols() != B.cols()) {
    throw std::invalid_argument("LinearExtension: the matrices do not fit the function");
  }
  return std::make_shared<LinearExtensionFunction>(std::move(f), A, B);
}

}  // namespace possibility::experiments
