#pragma once

#include <sundials/sundials_nvector.h>

#include <Eigen/Core>

namespace possibility::dynamics {

/// A vector of SUNDIALS with these values. Its arithmetic, as that of its clones, is Eigen's: the
/// states of robots are so short that SUNDIALS' own took a sixth of a simulation. Null if memory is
/// short; to be freed with N_VDestroy.
N_Vector MakeStateVector(const Eigen::VectorXd& values, SUNContext context);

/// Its values.
Eigen::Map<Eigen::VectorXd> AsVector(N_Vector vector);

}  // namespace possibility::dynamics
