#pragma once

#include <Eigen/Core>
#include <memory>

#include "collocation/problem/function.h"

namespace possibility::collocation {

// Functions that interpolate tables: cubic splines, twice continuously differentiable, with exact
// derivatives. The third derivative continues across the second knot from either end ("not a
// knot", de Boor 1978), so cubic polynomials come out exactly. Beyond the table the outermost cubic
// goes on. All take at least four knots in each direction, ascending.
// @throws std::invalid_argument that says what is wrong with the table.

/// x -> y through (knots[i], values[i]).
std::shared_ptr<Function> Table(const Eigen::VectorXd& knots, const Eigen::VectorXd& values);

/// (x, y) -> z through (x_knots[i], y_knots[j], values(i, j)): a product of splines.
std::shared_ptr<Function> Table(const Eigen::VectorXd& x_knots, const Eigen::VectorXd& y_knots,
                                const Eigen::MatrixXd& values);

}  // namespace possibility::collocation
