#pragma once

#include "python/tape.h"

namespace possibility::python {

/// Which derivatives of a tape's outputs may differ from zero.
struct TapeMasks {
  collocation::Mask jacobian;  ///< outputs x inputs
  collocation::Mask hessian;   ///< inputs x inputs, of any output
};

TapeMasks MasksOf(const Tape& tape);

}  // namespace possibility::python
