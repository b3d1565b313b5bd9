#pragma once

#include <Eigen/Core>

#include "collocation/transcription/variable_layout.h"

namespace possibility::collocation {

/// The problem's own guesses as variables of its program, divided by their scales.
Eigen::VectorXd InitialGuess(const VariableLayout& layout);

}  // namespace possibility::collocation
