#include "collocation/problem/function_algebra.h"

#include <stdexcept>
#include <utility>

namespace possibility::collocation {
namespace {

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

class SeparateSumFunction : public Function {
 public:
  SeparateSumFunction(std::shared_ptr<Function> f, std::shared_ptr<Function> g)
      : Function(f->num_inputs() + g->num_inputs(), f->num_outputs()),
        f_(std::move(f)),
        g_(std::move(g)),
        y_(num_outputs()),
        f_jacobian_(num_outputs(), f_->num_inputs()),
        g_jacobian_(num_outputs(), g_->num_inputs()),
        f_hessian_(f_->num_inputs(), f_->num_inputs()),
        g_hessian_(g_->num_inputs(), g_->num_inputs()) {}

  void Evaluate(const VectorXd& z, VectorXd* y) override {
    f_->Evaluate(z.head(f_->num_inputs()), y);
    g_->Evaluate(z.tail(g_->num_inputs()), &y_);
    *y += y_;
  }

  void Jacobian(const VectorXd& z, MatrixXd* J) override {
    f_->Jacobian(z.head(f_->num_inputs()), &f_jacobian_);
    g_->Jacobian(z.tail(g_->num_inputs()), &g_jacobian_);
    *J << f_jacobian_, g_jacobian_;
  }

  void Hessian(const VectorXd& z, const VectorXd& multipliers, MatrixXd* H) override {
    f_->Hessian(z.head(f_->num_inputs()), multipliers, &f_hessian_);
    g_->Hessian(z.tail(g_->num_inputs()), multipliers, &g_hessian_);
    H->setZero();
    H->topLeftCorner(f_->num_inputs(), f_->num_inputs()) = f_hessian_;
    H->bottomRightCorner(g_->num_inputs(), g_->num_inputs()) = g_hessian_;
  }

  Mask JacobianMask() const override {
    Mask mask(num_outputs(), num_inputs());
    mask << f_->JacobianMask(), g_->JacobianMask();
    return mask;
  }

  Mask HessianMask() const override {
    Mask mask = Mask::Constant(num_inputs(), num_inputs(), false);
    mask.topLeftCorner(f_->num_inputs(), f_->num_inputs()) = f_->HessianMask();
    mask.bottomRightCorner(g_->num_inputs(), g_->num_inputs()) = g_->HessianMask();
    return mask;
  }

 private:
  std::shared_ptr<Function> f_, g_;
  VectorXd y_;
  MatrixXd f_jacobian_, g_jacobian_, f_hessian_, g_hessian_;
};

}  // namespace

std::shared_ptr<Function> LinearExtension(std::shared_ptr<Function> f, const MatrixXd& A,
                                          const MatrixXd& B) {
  if (A.rows() != f->num_inputs() || B.rows() != f->num_outputs() || A.cols() != B.cols()) {
    throw std::invalid_argument("LinearExtension: the matrices do not fit the function");
  }
  return std::make_shared<LinearExtensionFunction>(std::move(f), A, B);
}

std::shared_ptr<Function> SeparateSum(std::shared_ptr<Function> f, std::shared_ptr<Function> g) {
  if (f->num_outputs() != g->num_outputs()) {
    throw std::invalid_argument("SeparateSum: the functions have different numbers of outputs");
  }
  return std::make_shared<SeparateSumFunction>(std::move(f), std::move(g));
}

}  // namespace possibility::collocation
