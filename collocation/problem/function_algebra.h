#pragma once

#include <Eigen/Core>
#include <memory>

#include "collocation/problem/function.h"

namespace possibility::collocation {

/// z -> B z. `B`: outputs x inputs.
std::shared_ptr<Function> LinearMap(const Eigen::MatrixXd& B);

/// z -> F(A z) + B z. Makes arguments of F equal, zero or sums of others, and adds terms that F
/// lacks, such as joint torques besides inverse dynamics. `A`: F's inputs x new inputs; `B`: F's
/// outputs x new inputs. @throws std::invalid_argument if the sizes do not fit.
std::shared_ptr<Function> LinearExtension(std::shared_ptr<Function> f, const Eigen::MatrixXd& A,
                                          const Eigen::MatrixXd& B);

/// z -> F(G(z)). @throws std::invalid_argument unless F has as many inputs as G has outputs.
std::shared_ptr<Function> Composition(std::shared_ptr<Function> f, std::shared_ptr<Function> g);

/// (x, y) -> F(x) + G(y): functions of separate arguments. @throws std::invalid_argument unless F
/// and G have as many outputs.
std::shared_ptr<Function> SeparateSum(std::shared_ptr<Function> f, std::shared_ptr<Function> g);

/// (x, y) -> (F(x), G(y)): the outputs of functions of separate arguments, one after the other.
std::shared_ptr<Function> Stacked(std::shared_ptr<Function> f, std::shared_ptr<Function> g);

}  // namespace possibility::collocation
