#pragma once

#include <Eigen/Core>
#include <vector>

namespace possibility::dynamics {

/// A held point as the balance of its patch sees it.
struct PatchPoint {
  int link = 0;
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal_W = Eigen::Vector3d::UnitZ();  ///< unit, out of the ground
};

/// An edge of the polygon that a patch's points span, about which it may tip. The moment of the
/// normal forces about it is the same however points that a rigid body cannot tell apart share
/// them; while the moments about all edges are positive, shares exist that only push.
struct TippingEdge {
  /// By point of the patch: distance from the edge over the greatest of them; 0 on the edge.
  Eigen::VectorXd levers;
};

/// Points of one link on ground of one normal.
struct ContactPatchBalance {
  std::vector<int> points;  ///< indices into what MakePatches was given
  Eigen::Vector3d normal_W = Eigen::Vector3d::UnitZ();
  std::vector<TippingEdge> edges;

  /// Moment over the greatest lever, N. `forces`: 3 x all points.
  double Moment(const TippingEdge& edge, const Eigen::Matrix3Xd& forces) const;
  Eigen::Vector3d Resultant(const Eigen::Matrix3Xd& forces) const;
  /// Tangential over normal part of the resultant over `friction`; 0 if it vanishes, infinite if
  /// it pulls.
  double FrictionUtilisation(const Eigen::Matrix3Xd& forces, double friction) const;
};

std::vector<ContactPatchBalance> MakePatches(const std::vector<PatchPoint>& points);

}  // namespace possibility::dynamics
