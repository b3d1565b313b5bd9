#pragma once

#include <Eigen/Core>
#include <vector>

#include "collocation/problem/function.h"
#include "collocation/robot/multibody_functions.h"
#include "dynamics/tree/multibody_dynamics.h"

namespace possibility::collocation {

/// Common base of the functions of a multibody system. Inputs are the first ones of q, v, a, f, one
/// f per component.
/// @throws std::invalid_argument if the model's base is a quaternion.
class RobotFunction : public Function {
 protected:
  RobotFunction(const RobotSystem& model, const std::vector<PointComponent>& components,
                int num_inputs, int num_outputs);

  /// A point with its components.
  struct Point {
    dynamics::ContactPoint point;
    std::vector<int> components;
  };

  /// For inputs that include all three.
  void SetPositionVelocityAcceleration(const Eigen::VectorXd& z);
  /// For each point, the sum of its components' axes, each times its `weight`, as a part of a
  /// scalar that is differentiated twice.
  std::vector<dynamics::PointTerm> Terms(Eigen::Vector3d dynamics::PointTerm::*part,
                                         const Eigen::VectorXd& weights) const;
  /// The sum of a point's axes, each times its weight.
  Eigen::Vector3d Combined(const Point& point, const Eigen::VectorXd& weights) const;

  /// Writes the Hessian for inputs q, v, a and possibly f; zero where there is no product.
  void PutHessian(const dynamics::HessianProduct& products, Eigen::MatrixXd* H) const;
  /// Writes an nv x nv block with its first element at (row, column), and its mirror image.
  void PutPair(const Eigen::MatrixXd& block, int row, int column, Eigen::MatrixXd* H) const;

  // Masks, from which velocities move which links. Nothing here depends on where the robot is as a
  // whole or on how it translates.
  bool Translates(int velocity) const { return translates_[velocity]; }
  /// Whether a rate of v changes the component at once: the mask of its Jacobian.
  bool Drives(int velocity, const PointComponent& component) const;
  /// Components by velocities: the mask of d component / dv, and of d component / dq without
  /// translations.
  Mask DriveMask() const;
  Mask TurnMask() const;
  /// nv x nv: pairs of velocities that move one of the points together, none of them a translation.
  Mask PointPairMask() const;
  /// nv x nv: pairs of velocities that move a link together. `rows`, `columns`: with translations.
  Mask RelatedMask(bool rows, bool columns) const;

  const dynamics::MultibodyModel& model() const { return dynamics_.model(); }
  int num_components() const { return static_cast<int>(components_.size()); }

  int n_;
  dynamics::MultibodyDynamics dynamics_;
  std::vector<PointComponent> components_;
  std::vector<Point> points_;

 private:
  std::vector<bool> translates_;
};

}  // namespace possibility::collocation
