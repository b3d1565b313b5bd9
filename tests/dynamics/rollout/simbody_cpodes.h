#pragma once

#include <vector>

namespace possibility::dynamics {

/// Angle (rad from hanging) of a point pendulum of length 1 m under `gravity`, released at rest
/// from `angle`, at each of `times`: integrated by Simbody's CPodes.
std::vector<double> SwingWithCPodes(double angle, double gravity, const std::vector<double>& times);

}  // namespace possibility::dynamics
