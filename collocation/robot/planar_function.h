#pragma once

#include <Eigen/Core>
#include <vector>

#include "collocation/problem/function.h"
#include "collocation/robot/multibody_functions.h"
#include "dynamics/tree/multibody_dynamics.h"

namespace possibility::collocation {

/// What the functions of a planar multibody system have in common: the first of the inputs q, v, a,
/// f, and contact points with a horizontal and a vertical component each.
/// @throws std::invalid_argument unless the model's base is planar.
class PlanarFunction : public Function {
 protected:
  PlanarFunction(const PlanarModel& model, const std::vector<dynamics::ContactPoint>& points,
                 int num_inputs, int num_outputs);

  /// Of inputs that have all three.
  void SetPositionVelocityAcceleration(const Eigen::VectorXd& z);
  /// Of each point, `components` (2 points) as its part in a scalar that is differentiated twice.
  std::vector<dynamics::PointTerm> Terms(Eigen::Vector3d dynamics::PointTerm::*part,
                                         const Eigen::VectorXd& components) const;

  /// A Hessian of q, v, a and maybe f, with zeros where there is no product.
  void PutHessian(const dynamics::HessianProduct& products, Eigen::MatrixXd* H) const;
  /// nv x nv, with its first element at (row, column), and its mirror image.
  void PutPair(const Eigen::MatrixXd& block, int row, int column, Eigen::MatrixXd* H) const;
  /// Nothing depends on the base's x and z in the first `parts` of q, v, a.
  Mask JacobianMaskWithoutBase(int parts) const;
  void MaskBase(int parts, Mask* hessian_mask) const;

  int num_points() const { return static_cast<int>(points_.size()); }

  int n_;
  dynamics::MultibodyDynamics dynamics_;
  std::vector<dynamics::ContactPoint> points_;
};

}  // namespace possibility::collocation
