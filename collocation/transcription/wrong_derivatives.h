#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "collocation/transcription/variable_layout.h"
#include "common/cancellation_token.h"

namespace possibility::collocation {

/// Compares the derivatives of every function of a problem with differences (CheckDerivatives), at
/// the first, the middle and the last point where it holds. Returns a sentence for each wrong
/// element: "constraint 'motion', phase 'swing', knot 3: d output 2 / d argument 'knee' is 1.2,
/// differences give 3.4". Functions that are undefined at a point are left out there. `x`: scaled.
/// @throws Cancelled.
std::vector<std::string> WrongDerivatives(const VariableLayout& layout, const Eigen::VectorXd& x,
                                          const CancellationToken& cancellation);

}  // namespace possibility::collocation
