#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "collocation/problem/jet.h"

namespace possibility::collocation {

/// The elements of a matrix that may be non-zero.
using Mask = Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic>;

/// y = F(z) with exact derivatives. z contains the quantities of one instant of a motion, so the
/// blocks are small and dense. May keep a workspace: one solve at a time. If F cannot be evaluated,
/// it yields NaN or throws std::runtime_error.
class Function {
 public:
  Function(int num_inputs, int num_outputs) : num_inputs_(num_inputs), num_outputs_(num_outputs) {}
  virtual ~Function() = default;

  int num_inputs() const { return num_inputs_; }
  int num_outputs() const { return num_outputs_; }

  /// `y`: num_outputs. Here and below, the output already has the right size.
  virtual void Evaluate(const Eigen::VectorXd& z, Eigen::VectorXd* y) = 0;
  /// `J`: outputs x inputs.
  virtual void Jacobian(const Eigen::VectorXd& z, Eigen::MatrixXd* J) = 0;
  /// `H`: inputs x inputs, the Hessian of multipliers' F.
  virtual void Hessian(const Eigen::VectorXd& z, const Eigen::VectorXd& multipliers,
                       Eigen::MatrixXd* H) = 0;
  /// Elements outside the masks are zero for every z.
  virtual Mask JacobianMask() const { return Mask::Constant(num_outputs_, num_inputs_, true); }
  virtual Mask HessianMask() const { return Mask::Constant(num_inputs_, num_inputs_, true); }
  /// Functions by which it evaluates itself, if something else may use them as well: they are not
  /// evaluated by two threads at once.
  virtual std::vector<const Function*> Parts() const { return {}; }

 private:
  int num_inputs_;
  int num_outputs_;
};

/// A function given as code for any scalar type T, differentiated by Jet:
///   void operator()(const std::array<T, Inputs>& z, std::array<T, Outputs>* y) const.
template <int Inputs, int Outputs, typename Code>
class DifferentiatedFunction : public Function {
 public:
  explicit DifferentiatedFunction(Code code) : Function(Inputs, Outputs), code_(std::move(code)) {}

  void Evaluate(const Eigen::VectorXd& z, Eigen::VectorXd* y) override {
    std::array<double, Inputs> inputs;
    for (int i = 0; i < Inputs; ++i) inputs[i] = z[i];
    std::array<double, Outputs> outputs{};
    code_(inputs, &outputs);
    for (int i = 0; i < Outputs; ++i) (*y)[i] = outputs[i];
  }

  void Jacobian(const Eigen::VectorXd& z, Eigen::MatrixXd* J) override {
    const auto outputs = Run<1>(z);
    for (int i = 0; i < Outputs; ++i) J->row(i) = outputs[i].gradient.transpose();
  }

  void Hessian(const Eigen::VectorXd& z, const Eigen::VectorXd& multipliers,
               Eigen::MatrixXd* H) override {
    const auto outputs = Run<2>(z);
    H->setZero();
    for (int i = 0; i < Outputs; ++i) *H += multipliers[i] * outputs[i].hessian;
  }

 private:
  template <int Order>
  std::array<Jet<Inputs, Order>, Outputs> Run(const Eigen::VectorXd& z) const {
    std::array<Jet<Inputs, Order>, Inputs> inputs;
    for (int i = 0; i < Inputs; ++i) inputs[i] = Jet<Inputs, Order>::Input(z[i], i);
    std::array<Jet<Inputs, Order>, Outputs> outputs{};
    code_(inputs, &outputs);
    return outputs;
  }

  Code code_;
};

/// Differentiated<2, 1>([](const auto& z, auto* y) { (*y)[0] = z[0] * sin(z[1]); })
template <int Inputs, int Outputs, typename Code>
std::shared_ptr<Function> Differentiated(Code code) {
  return std::make_shared<DifferentiatedFunction<Inputs, Outputs, Code>>(std::move(code));
}

/// Number of arguments, at most 12, with which code accepts numbers; 0: with none.
template <typename Code, typename... Numbers>
constexpr int Arity() {
  if constexpr (std::is_invocable_v<Code, Numbers...>) {
    return sizeof...(Numbers);
  } else if constexpr (sizeof...(Numbers) < 12) {
    return Arity<Code, Numbers..., double>();
  } else {
    return 0;
  }
}

/// FunctionOf([](auto x, auto y) { return x * sin(y); }): the numbers of inputs and outputs follow
/// from the code, which returns a number or a std::array of them and accepts any scalar type.
template <typename Code>
std::shared_ptr<Function> FunctionOf(Code code) {
  constexpr int kInputs = Arity<Code, double>();
  static_assert(kInputs > 0, "the code must take 1 to 12 numbers");
  using Result = decltype(std::apply(code, std::array<double, kInputs>{}));
  if constexpr (std::is_same_v<Result, double>) {
    return Differentiated<kInputs, 1>(
        [code](const auto& z, auto* y) { (*y)[0] = std::apply(code, z); });
  } else {
    return Differentiated<kInputs, static_cast<int>(std::tuple_size_v<Result>)>(
        [code](const auto& z, auto* y) { *y = std::apply(code, z); });
  }
}

}  // namespace possibility::collocation
