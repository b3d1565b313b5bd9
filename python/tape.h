#pragma once

#include <memory>
#include <string>
#include <vector>

#include "collocation/problem/function.h"

namespace possibility::python {

enum class TapeOperation {
  kConstant,
  kInput,
  kAdd,
  kSubtract,
  kMultiply,
  kDivide,
  kPower,  ///< of a constant exponent
  kExponentiate,
  kArcTangent2,
  kNegate,
  kSin,
  kCos,
  kTan,
  kArcSin,
  kArcCos,
  kArcTan,
  kSinh,
  kCosh,
  kTanh,
  kExp,
  kLog,
  kSqrt,
  kAbs,
};

/// Whether the operation has two entries.
inline bool TakesTwo(TapeOperation operation) {
  return operation >= TapeOperation::kAdd && operation <= TapeOperation::kArcTangent2 &&
         operation != TapeOperation::kPower;
}

/// A number that follows from numbers before it.
struct TapeEntry {
  TapeOperation operation = TapeOperation::kConstant;
  int first = 0;        ///< index of an entry; of an input for kInput
  int second = 0;       ///< index of an entry
  double constant = 0;  ///< for kConstant and the exponent of kPower
};

/// A function as a list of operations, and the entries that are its outputs.
struct Tape {
  int num_inputs = 0;
  std::vector<TapeEntry> entries;
  std::vector<int> outputs;
};

/// The tape with exact first and second derivatives by Jet. Masks follow from the operations.
/// @throws std::invalid_argument if an index of the tape is out of range.
std::shared_ptr<collocation::Function> FunctionOfTape(Tape tape);

/// The words by which operations are named: "add", "sin". @throws std::invalid_argument otherwise.
TapeOperation TapeOperationNamed(const std::string& name);

}  // namespace possibility::python
