#pragma once

#include <Eigen/Core>
#include <vector>

#include "collocation/problem/function.h"
#include "collocation/robot/multibody_functions.h"
#include "dynamics/tree/multibody_dynamics.h"

namespace possibility::collocation {

/// Common base of the functions of a planar multibody system. Inputs are the first ones of q, v, a,
/// f; contact points have a horizontal and a vertical component each.
/// @throws std::invalid_argument unless the model's base is planar.
class PlanarFunction : public Function {
 protected:
  PlanarFunction(const PlanarModel& model, const std::vector<dynamics::ContactPoint>& points,
                 int num_inputs, int num_outputs);

  /// For inputs that include all three.
  void SetPositionVelocityAcceleration(const Eigen::VectorXd& z);
  /// For each point, its `components` (2 points in all) as a part of a scalar that is
  /// differentiated twice.
  std::vector<dynamics::PointTerm> Terms(Eigen::Vector3d dynamics::PointTerm::*part,
                                         const Eigen::VectorXd& components) const;

  /// Writes the Hessian for inputs q, v, a and possibly f; zero where there is no product.
  void PutHessian(const dynamics::HessianProduct& products, Eigen::MatrixXd* H) const;
  /// Writes an nv x nv block with its first element at (row, column), and its mirror image.
  void PutPair(const Eigen::MatrixXd& block, int row, int column, Eigen::MatrixXd* H) const;
  /// Masks of a function that does not depend on the base's x and z in the first `parts` of q, v,
  /// a.
  Mask JacobianMaskWithoutBase(int parts) const;
  void MaskBase(int parts, Mask* hessian_mask) const;

  int num_points() const { return static_cast<int>(points_.size()); }

  int n_;
  dynamics::MultibodyDynamics dynamics_;
  std::vector<dynamics::ContactPoint> points_;
};

}  // namespace possibility::collocation
