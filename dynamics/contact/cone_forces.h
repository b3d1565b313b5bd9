#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace possibility::dynamics {

/// Point forces x (3 per point, world axes, as fractions of a unit that makes them about 1) in
/// friction cones that meet
///   balance_loads x = balance_required,   |bounded_required - bounded_loads x| <= bounds.
/// Each cone is replaced by the pyramid inside it whose edges lie on the cone.
struct ConeForceProblem {
  std::vector<Eigen::Vector3d> normals;  ///< unit, out of the ground, one per point
  std::vector<double> slopes;  ///< greatest ratio of tangential to normal force, one per point
  int cone_edges = 8;
  /// Normal force at which every cone starts.
  double normal_reserve = 0;

  Eigen::MatrixXd balance_loads;
  Eigen::VectorXd balance_required;
  Eigen::MatrixXd bounded_loads;
  Eigen::VectorXd bounded_required;
  Eigen::VectorXd bounds;  ///< may be infinite
};

/// The forces of least square norm, where the squares of (bounded_required - bounded_loads x) /
/// bounds are added with a small weight; none if no forces meet the constraints.
std::optional<Eigen::VectorXd> SolveConeForces(const ConeForceProblem& problem);

}  // namespace possibility::dynamics
