#pragma once

#include <memory>

#include "collocation/problem/function.h"

namespace possibility::experiments {

/// z -> F(A z) + B z. Makes arguments of F equal, zero or sums of others, and adds terms that F
/// lacks, such as joint torques besides inverse dynamics. `A`: F's inputs x new inputs; `B`: F's
/// outputs x new inputs. @throws std::invalid_argument if the sizes do not fit.
std::shared_ptr<collocation::Function> LinearExtension(std::shared_ptr<collocation::Function> f,
                                                       const Eigen::MatrixXd& A,
                                                       const Eigen::MatrixXd& B);

}  // namespace possibility::experiments
