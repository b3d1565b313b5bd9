#pragma once

#include <Eigen/Core>
#include <memory>

#include "collocation/problem/function.h"

namespace possibility::collocation {

/// z -> F(A z) + B z. Makes arguments of F equal, zero or sums of others, and adds terms that F
/// lacks, such as joint torques besides inverse dynamics. `A`: F's inputs x new inputs; `B`: F's
/// outputs x new inputs. @throws std::invalid_argument if the sizes do not fit.
std::shared_ptr<Function> LinearExtension(std::shared_ptr<Function> f, const Eigen::MatrixXd& A,
                                          const Eigen::MatrixXd& B);

/// (x, y) -> F(x) + G(y): functions of separate arguments. @throws std::invalid_argument unless F
/// and G have as many outputs.
std::shared_ptr<Function> SeparateSum(std::shared_ptr<Function> f, std::shared_ptr<Function> g);

}  // namespace possibility::collocation
