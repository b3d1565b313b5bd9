#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "collocation/problem/function.h"
#include "collocation/robot/multibody_functions.h"

namespace possibility::collocation {

/// A contact patch where it bears.
struct PlacedPatch {
  std::vector<dynamics::ContactPoint> points;  ///< with the normal of the surface
  std::vector<Eigen::Vector3d> places;         ///< of the points, world, m
  std::vector<Eigen::Vector2d> in_patch;       ///< the points in the patch's own plane, m
};

/// `contact`: index of a contact of `model`'s tree. `X_WF`: pose of its frame
/// (models::ContactPatch::Frame) where it bears, z out of the surface.
PlacedPatch Place(const dynamics::MultibodyModel& model, int contact,
                  const Eigen::Isometry3d& X_WF);

/// As many independent components of the points as hold the patch: six for a surface, five for an
/// edge, three for a point. A flat patch held by all components of all points would be held
/// redundantly.
std::vector<PointComponent> HoldingComponents(const PlacedPatch& patch);

/// The places in the order of HoldingComponents, along their axes, m.
std::vector<double> HeldPlaces(const PlacedPatch& patch);

/// For each edge of the patch's outline, normal force times (distance of the centre of pressure
/// from the edge, less `reserve`), N m: not negative where the centre of pressure keeps the reserve
/// (m). Inputs: the forces of the points, world, three components each. Of a surface only: its
/// points must be the corners of a convex polygon, in order.
std::shared_ptr<Function> PressureReserve(const PlacedPatch& patch, double reserve);

/// Whether the points span a surface.
bool IsSurface(const PlacedPatch& patch);

}  // namespace possibility::collocation
