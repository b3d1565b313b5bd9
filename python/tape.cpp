#include "python/tape.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "collocation/problem/jet.h"
#include "python/tape_masks.h"

namespace possibility::python {
namespace {

using collocation::Function;
using collocation::Jet;
using collocation::Mask;

/// Inputs that a run differentiates by. A function of more takes several runs: jets of a fixed size
/// are compiled once.
constexpr int kSeeds = 6;
constexpr int kHalf = kSeeds / 2;

// In the order of TapeOperation.
constexpr const char* kNames[] = {
    "constant", "input",    "add",  "subtract", "multiply", "divide", "power",   "exponentiate",
    "arctan2",  "negative", "sin",  "cos",      "tan",      "arcsin", "arccos",  "arctan",
    "sinh",     "cosh",     "tanh", "exp",      "log",      "sqrt",   "absolute"};

template <typename T>
T OfTwo(TapeOperation operation, const T& a, const T& b) {
  using namespace collocation;  // NOLINT(google-build-using-namespace): functions of jets
  switch (operation) {
    case TapeOperation::kAdd:
      return a + b;
    case TapeOperation::kSubtract:
      return a - b;
    case TapeOperation::kMultiply:
      return a * b;
    case TapeOperation::kDivide:
      return a / b;
    case TapeOperation::kExponentiate:
      return pow(a, b);
    default:
      return atan2(a, b);
  }
}

template <typename T>
T OfOne(TapeOperation operation, const T& a) {
  using namespace collocation;  // NOLINT(google-build-using-namespace): functions of jets
  switch (operation) {
    case TapeOperation::kNegate:
      return -a;
    case TapeOperation::kSin:
      return sin(a);
    case TapeOperation::kCos:
      return cos(a);
    case TapeOperation::kTan:
      return tan(a);
    case TapeOperation::kArcSin:
      return asin(a);
    case TapeOperation::kArcCos:
      return acos(a);
    case TapeOperation::kArcTan:
      return atan(a);
    case TapeOperation::kSinh:
      return sinh(a);
    case TapeOperation::kCosh:
      return cosh(a);
    case TapeOperation::kTanh:
      return tanh(a);
    case TapeOperation::kExp:
      return exp(a);
    case TapeOperation::kLog:
      return log(a);
    case TapeOperation::kSqrt:
      return sqrt(a);
    default:
      return abs(a);
  }
}

/// Runs the tape; `values` has its length.
template <typename T>
void RunTape(const Tape& tape, const std::vector<T>& inputs, std::vector<T>* values) {
  for (std::size_t i = 0; i < tape.entries.size(); ++i) {
    const TapeEntry& entry = tape.entries[i];
    T& value = (*values)[i];
    switch (entry.operation) {
      case TapeOperation::kConstant:
        value = entry.constant;
        break;
      case TapeOperation::kInput:
        value = inputs[entry.first];
        break;
      case TapeOperation::kPower:
        using collocation::pow;
        value = pow((*values)[entry.first], entry.constant);
        break;
      default:
        value = TakesTwo(entry.operation)
                    ? OfTwo(entry.operation, (*values)[entry.first], (*values)[entry.second])
                    : OfOne(entry.operation, (*values)[entry.first]);
    }
  }
}

/// Values of inputs and entries, kept from one run to the next.
template <typename T>
struct Workspace {
  std::vector<T> inputs;
  std::vector<T> values;
};

class TapeFunction : public Function {
 public:
  explicit TapeFunction(Tape tape)
      : Function(tape.num_inputs, static_cast<int>(tape.outputs.size())),
        tape_(std::move(tape)),
        masks_(MasksOf(tape_)) {}

  void Evaluate(const Eigen::VectorXd& z, Eigen::VectorXd* y) override {
    plain_.inputs.assign(z.data(), z.data() + z.size());
    plain_.values.resize(tape_.entries.size());
    RunTape(tape_, plain_.inputs, &plain_.values);
    for (int i = 0; i < num_outputs(); ++i) (*y)[i] = plain_.values[tape_.outputs[i]];
  }

  void Jacobian(const Eigen::VectorXd& z, Eigen::MatrixXd* J) override {
    for (int begin = 0; begin < num_inputs(); begin += kSeeds) {
      const int count = std::min(kSeeds, num_inputs() - begin);
      Run({begin, count, 0, 0}, z, &first_);
      for (int i = 0; i < num_outputs(); ++i) {
        J->block(i, begin, 1, count) =
            first_.values[tape_.outputs[i]].gradient.head(count).transpose();
      }
    }
  }

  void Hessian(const Eigen::VectorXd& z, const Eigen::VectorXd& multipliers,
               Eigen::MatrixXd* H) override {
    H->setZero();
    if (num_inputs() <= kSeeds) return AddBlocks({0, num_inputs(), 0, 0}, z, multipliers, H);
    for (int i = 0; i < num_inputs(); i += kHalf) {
      for (int j = i + kHalf; j < num_inputs(); j += kHalf) {
        AddBlocks({i, kHalf, j, std::min(kHalf, num_inputs() - j)}, z, multipliers, H);
      }
    }
  }

  Mask JacobianMask() const override { return masks_.jacobian; }
  Mask HessianMask() const override { return masks_.hessian; }

 private:
  /// Two ranges of inputs by which a run differentiates.
  struct Seeds {
    int begin, count, second_begin, second_count;
    int size() const { return count + second_count; }
    int InputOf(int seed) const {
      return seed < count ? begin + seed : second_begin + seed - count;
    }
  };

  template <int Order>
  void Run(const Seeds& seeds, const Eigen::VectorXd& z, Workspace<Jet<kSeeds, Order>>* work) {
    work->inputs.assign(z.data(), z.data() + z.size());
    for (int seed = 0; seed < seeds.size(); ++seed) {
      work->inputs[seeds.InputOf(seed)].gradient[seed] = 1;
    }
    work->values.resize(tape_.entries.size());
    RunTape(tape_, work->inputs, &work->values);
  }

  /// Sets the elements of all pairs of seeds.
  void AddBlocks(const Seeds& seeds, const Eigen::VectorXd& z, const Eigen::VectorXd& multipliers,
                 Eigen::MatrixXd* H) {
    Run(seeds, z, &second_);
    Eigen::Matrix<double, kSeeds, kSeeds> sum = Eigen::Matrix<double, kSeeds, kSeeds>::Zero();
    for (int i = 0; i < num_outputs(); ++i) {
      sum += multipliers[i] * second_.values[tape_.outputs[i]].hessian;
    }
    for (int a = 0; a < seeds.size(); ++a) {
      for (int b = 0; b < seeds.size(); ++b) (*H)(seeds.InputOf(a), seeds.InputOf(b)) = sum(a, b);
    }
  }

  Tape tape_;
  TapeMasks masks_;
  Workspace<double> plain_;
  Workspace<Jet<kSeeds, 1>> first_;
  Workspace<Jet<kSeeds, 2>> second_;
};

void Check(const Tape& tape) {
  const auto require = [](int index, std::size_t size) {
    if (index >= 0 && index < static_cast<int>(size)) return;
    throw std::invalid_argument("tape: an index is out of range");
  };
  for (std::size_t i = 0; i < tape.entries.size(); ++i) {
    const TapeEntry& entry = tape.entries[i];
    if (entry.operation == TapeOperation::kConstant) continue;
    const bool is_input = entry.operation == TapeOperation::kInput;
    require(entry.first, is_input ? static_cast<std::size_t>(tape.num_inputs) : i);
    if (TakesTwo(entry.operation)) require(entry.second, i);
  }
  for (const int output : tape.outputs) require(output, tape.entries.size());
}

}  // namespace

std::shared_ptr<Function> FunctionOfTape(Tape tape) {
  Check(tape);
  return std::make_shared<TapeFunction>(std::move(tape));
}

TapeOperation TapeOperationNamed(const std::string& name) {
  const auto* const found = std::find(std::begin(kNames), std::end(kNames), name);
  if (found == std::end(kNames)) throw std::invalid_argument("tape: no operation '" + name + "'");
  return static_cast<TapeOperation>(found - std::begin(kNames));
}

}  // namespace possibility::python
