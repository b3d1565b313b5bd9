#include "python/tape_masks.h"

namespace possibility::python {
namespace {

using collocation::Mask;

/// The inputs on which an entry depends, and the pairs of them by which it is curved.
struct Dependence {
  Mask inputs;  // inputs x 1
  Mask pairs;   // inputs x inputs
};

Mask PairsOf(const Mask& a, const Mask& b) {
  return (a.matrix().cast<int>() * b.matrix().cast<int>().transpose()).array() > 0;
}

/// Of an operation on two entries.
Dependence Combined(TapeOperation operation, const Dependence& a, const Dependence& b) {
  Dependence result{a.inputs || b.inputs, a.pairs || b.pairs};
  switch (operation) {
    case TapeOperation::kAdd:
    case TapeOperation::kSubtract:
      break;
    case TapeOperation::kMultiply:
      result.pairs = result.pairs || PairsOf(a.inputs, b.inputs) || PairsOf(b.inputs, a.inputs);
      break;
    case TapeOperation::kDivide:
      result.pairs =
          result.pairs || PairsOf(b.inputs, result.inputs) || PairsOf(result.inputs, b.inputs);
      break;
    default:
      result.pairs = PairsOf(result.inputs, result.inputs);
  }
  return result;
}

Dependence DependenceOf(const TapeEntry& entry, int num_inputs,
                        const std::vector<Dependence>& before) {
  if (entry.operation == TapeOperation::kConstant || entry.operation == TapeOperation::kInput) {
    Dependence none{Mask::Constant(num_inputs, 1, false),
                    Mask::Constant(num_inputs, num_inputs, false)};
    if (entry.operation == TapeOperation::kInput) none.inputs(entry.first) = true;
    return none;
  }
  const Dependence& a = before[entry.first];
  if (TakesTwo(entry.operation)) return Combined(entry.operation, a, before[entry.second]);
  if (entry.operation == TapeOperation::kNegate) return a;
  return {a.inputs, PairsOf(a.inputs, a.inputs)};
}

}  // namespace

TapeMasks MasksOf(const Tape& tape) {
  std::vector<Dependence> dependence;
  for (const TapeEntry& entry : tape.entries) {
    dependence.push_back(DependenceOf(entry, tape.num_inputs, dependence));
  }
  const auto num_outputs = static_cast<Eigen::Index>(tape.outputs.size());
  TapeMasks masks{Mask::Constant(num_outputs, tape.num_inputs, false),
                  Mask::Constant(tape.num_inputs, tape.num_inputs, false)};
  for (Eigen::Index i = 0; i < num_outputs; ++i) {
    const Dependence& output = dependence[tape.outputs[i]];
    masks.jacobian.row(i) = output.inputs.transpose();
    masks.hessian = masks.hessian || output.pairs;
  }
  return masks;
}

}  // namespace possibility::python
