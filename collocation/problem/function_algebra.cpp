#include "collocation/problem/function_algebra.h"

#include <stdexcept>
#include <utility>
#include <vector>

namespace possibility::collocation {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

class LinearMapFunction : public Function {
 public:
  explicit LinearMapFunction(MatrixXd B)
      : Function(static_cast<int>(B.cols()), static_cast<int>(B.rows())), B_(std::move(B)) {}

  void Evaluate(const VectorXd& z, VectorXd* y) override { *y = B_ * z; }
  void Jacobian(const VectorXd& /*z*/, MatrixXd* J) override { *J = B_; }
  void Hessian(const VectorXd& /*z*/, const VectorXd& /*multipliers*/, MatrixXd* H) override {
    H->setZero();
  }

  Mask JacobianMask() const override { return B_.array() != 0.0; }
  Mask HessianMask() const override { return Mask::Constant(num_inputs(), num_inputs(), false); }

 private:
  MatrixXd B_;
};

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

  std::vector<const Function*> Parts() const override { return {f_.get()}; }

 private:
  std::shared_ptr<Function> f_;
  MatrixXd A_, B_;
  MatrixXd jacobian_, hessian_;
};

class CompositionFunction : public Function {
 public:
  CompositionFunction(std::shared_ptr<Function> f, std::shared_ptr<Function> g)
      : Function(g->num_inputs(), f->num_outputs()),
        f_(std::move(f)),
        g_(std::move(g)),
        y_(g_->num_outputs()),
        outer_jacobian_(MatrixXd::Zero(f_->num_outputs(), f_->num_inputs())),
        outer_hessian_(MatrixXd::Zero(f_->num_inputs(), f_->num_inputs())),
        inner_jacobian_(MatrixXd::Zero(g_->num_outputs(), g_->num_inputs())),
        inner_hessian_(MatrixXd::Zero(g_->num_inputs(), g_->num_inputs())) {}

  void Evaluate(const VectorXd& z, VectorXd* y) override {
    g_->Evaluate(z, &y_);
    f_->Evaluate(y_, y);
  }

  void Jacobian(const VectorXd& z, MatrixXd* J) override {
    DifferentiateOnce(z);
    *J = outer_jacobian_ * inner_jacobian_;
  }

  void Hessian(const VectorXd& z, const VectorXd& multipliers, MatrixXd* H) override {
    DifferentiateOnce(z);
    outer_hessian_.setZero();
    f_->Hessian(y_, multipliers, &outer_hessian_);
    inner_hessian_.setZero();
    g_->Hessian(z, outer_jacobian_.transpose() * multipliers, &inner_hessian_);
    *H = inner_jacobian_.transpose() * outer_hessian_ * inner_jacobian_ + inner_hessian_;
  }

  Mask JacobianMask() const override {
    return (f_->JacobianMask().cast<double>().matrix() * g_->JacobianMask().cast<double>().matrix())
               .array() != 0.0;
  }

  Mask HessianMask() const override {
    const MatrixXd J = g_->JacobianMask().cast<double>();
    const MatrixXd both = J.transpose() * f_->HessianMask().cast<double>().matrix() * J;
    return both.array() != 0.0 || g_->HessianMask();
  }

  std::vector<const Function*> Parts() const override { return {f_.get(), g_.get()}; }

 private:
  void DifferentiateOnce(const VectorXd& z) {
    g_->Evaluate(z, &y_);
    // Functions do not write entries that their masks exclude.
    outer_jacobian_.setZero();
    inner_jacobian_.setZero();
    f_->Jacobian(y_, &outer_jacobian_);
    g_->Jacobian(z, &inner_jacobian_);
  }

  std::shared_ptr<Function> f_, g_;
  VectorXd y_;
  MatrixXd outer_jacobian_, outer_hessian_, inner_jacobian_, inner_hessian_;
};

class StackedFunction : public Function {
 public:
  StackedFunction(std::shared_ptr<Function> f, std::shared_ptr<Function> g)
      : Function(f->num_inputs() + g->num_inputs(), f->num_outputs() + g->num_outputs()),
        f_(std::move(f)),
        g_(std::move(g)),
        f_y_(f_->num_outputs()),
        g_y_(g_->num_outputs()),
        f_jacobian_(MatrixXd::Zero(f_->num_outputs(), f_->num_inputs())),
        g_jacobian_(MatrixXd::Zero(g_->num_outputs(), g_->num_inputs())),
        f_hessian_(MatrixXd::Zero(f_->num_inputs(), f_->num_inputs())),
        g_hessian_(MatrixXd::Zero(g_->num_inputs(), g_->num_inputs())) {}

  void Evaluate(const VectorXd& z, VectorXd* y) override {
    f_->Evaluate(z.head(f_->num_inputs()), &f_y_);
    g_->Evaluate(z.tail(g_->num_inputs()), &g_y_);
    *y << f_y_, g_y_;
  }

  void Jacobian(const VectorXd& z, MatrixXd* J) override {
    f_->Jacobian(z.head(f_->num_inputs()), &f_jacobian_);
    g_->Jacobian(z.tail(g_->num_inputs()), &g_jacobian_);
    J->setZero();
    J->topLeftCorner(f_->num_outputs(), f_->num_inputs()) = f_jacobian_;
    J->bottomRightCorner(g_->num_outputs(), g_->num_inputs()) = g_jacobian_;
  }

  void Hessian(const VectorXd& z, const VectorXd& multipliers, MatrixXd* H) override {
    f_->Hessian(z.head(f_->num_inputs()), multipliers.head(f_->num_outputs()), &f_hessian_);
    g_->Hessian(z.tail(g_->num_inputs()), multipliers.tail(g_->num_outputs()), &g_hessian_);
    H->setZero();
    H->topLeftCorner(f_->num_inputs(), f_->num_inputs()) = f_hessian_;
    H->bottomRightCorner(g_->num_inputs(), g_->num_inputs()) = g_hessian_;
  }

  Mask JacobianMask() const override {
    Mask mask = Mask::Constant(num_outputs(), num_inputs(), false);
    mask.topLeftCorner(f_->num_outputs(), f_->num_inputs()) = f_->JacobianMask();
    mask.bottomRightCorner(g_->num_outputs(), g_->num_inputs()) = g_->JacobianMask();
    return mask;
  }

  Mask HessianMask() const override {
    Mask mask = Mask::Constant(num_inputs(), num_inputs(), false);
    mask.topLeftCorner(f_->num_inputs(), f_->num_inputs()) = f_->HessianMask();
    mask.bottomRightCorner(g_->num_inputs(), g_->num_inputs()) = g_->HessianMask();
    return mask;
  }

  std::vector<const Function*> Parts() const override { return {f_.get(), g_.get()}; }

 private:
  std::shared_ptr<Function> f_, g_;
  VectorXd f_y_, g_y_;
  MatrixXd f_jacobian_, g_jacobian_, f_hessian_, g_hessian_;
};

}  // namespace

std::shared_ptr<Function> LinearMap(const MatrixXd& B) {
  return std::make_shared<LinearMapFunction>(B);
}

std::shared_ptr<Function> LinearExtension(std::shared_ptr<Function> f, const MatrixXd& A,
                                          const MatrixXd& B) {
  if (A.rows() != f->num_inputs() || B.rows() != f->num_outputs() || A.cols() != B.cols()) {
    throw std::invalid_argument("LinearExtension: the matrices do not fit the function");
  }
  return std::make_shared<LinearExtensionFunction>(std::move(f), A, B);
}

std::shared_ptr<Function> Composition(std::shared_ptr<Function> f, std::shared_ptr<Function> g) {
  if (f->num_inputs() != g->num_outputs()) {
    throw std::invalid_argument(
        "Composition: the inner function's outputs are not the outer's inputs");
  }
  return std::make_shared<CompositionFunction>(std::move(f), std::move(g));
}

std::shared_ptr<Function> Stacked(std::shared_ptr<Function> f, std::shared_ptr<Function> g) {
  return std::make_shared<StackedFunction>(std::move(f), std::move(g));
}

std::shared_ptr<Function> SeparateSum(std::shared_ptr<Function> f, std::shared_ptr<Function> g) {
  if (f->num_outputs() != g->num_outputs()) {
    throw std::invalid_argument("SeparateSum: the functions have different numbers of outputs");
  }
  const int m = f->num_outputs();
  return Composition(LinearMap(MatrixXd::Identity(m, m).replicate(1, 2)),
                     Stacked(std::move(f), std::move(g)));
}

}  // namespace possibility::collocation
