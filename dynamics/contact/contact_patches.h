#pragma once

#include <Eigen/Core>
#include <vector>

#include "dynamics/forward/forward_dynamics.h"

namespace possibility::dynamics {

/// An edge of the polygon that a patch's points span, about which the patch may tip. Points of a
/// rigid body may share a load in many ways; the moment of the normal forces about the edge is the
/// same for all of them. While the moments about all edges are positive, there is a way in which
/// all points push.
struct TippingEdge {
  /// By point of the patch: distance from the edge, divided by the greatest such distance; 0 on the
  /// edge.
  Eigen::VectorXd levers;
};

/// Points of one link on ground with one normal.
struct ContactPatchBalance {
  std::vector<int> points;  ///< indices into the argument of MakePatches
  Eigen::Vector3d normal_W = Eigen::Vector3d::UnitZ();
  std::vector<TippingEdge> edges;

  /// Moment about the edge divided by the greatest lever, N. `forces`: 3 x all points.
  double Moment(const TippingEdge& edge, const Eigen::Matrix3Xd& forces) const;
  Eigen::Vector3d Resultant(const Eigen::Matrix3Xd& forces) const;
  /// Ratio of tangential to normal part of the resultant, divided by `friction`; 0 if the resultant
  /// vanishes, infinite if it pulls.
  double FrictionUtilisation(const Eigen::Matrix3Xd& forces, double friction) const;
};

/// The patches of held points at their anchors.
std::vector<ContactPatchBalance> MakePatches(const std::vector<HeldPoint>& points);

}  // namespace possibility::dynamics
