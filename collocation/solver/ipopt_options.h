#pragma once

#include <IpIpoptApplication.hpp>

#include "collocation/solver/solver.h"

namespace possibility::collocation {

/// Passes SolverOptions to Ipopt. `warm`: the solve starts from multipliers. `largest_bound`:
/// greatest magnitude among finite bounds.
/// @throws std::invalid_argument for an Ipopt option that does not exist, does not take the value,
/// or has its own field in SolverOptions.
void SetIpoptOptions(const SolverOptions& options, bool warm, double largest_bound,
                     Ipopt::IpoptApplication* application);

}  // namespace possibility::collocation
