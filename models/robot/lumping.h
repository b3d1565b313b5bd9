#pragma once

#include <map>
#include <set>
#include <string>

#include "models/robot/robot_model.h"
#include "models/robot/urdf_reader.h"

namespace possibility::models {

/// Adds `body`, moved by X_PL, to `total`; both are rigidly attached to P (parallel-axis theorem).
Inertial Combined(const Inertial& total, const Inertial& body, const Eigen::Isometry3d& X_PL);

/// Meshes of the kept links that are still to be read, by link index, posed in the kept link.
using PendingMeshes = std::multimap<int, UrdfMesh>;

/// Fills `robot->links` and `robot->joints` from the tree: depth first from the root, children in
/// the order of their joints' names. Links below fixed joints and below the joints in `lumped`
/// (held at 0) become part of the nearest link above that is kept. A link without mass there is a
/// frame. Returns the links' meshes, which are not read yet.
/// @throws InputError naming `file` for joints that are unsupported or without limits, and for
/// kept links that are no bodies (CheckMovingBody), with what is lumped into them, and without it
/// unless it outweighs them.
PendingMeshes BuildLumpedTree(const UrdfTree& tree, const std::set<std::string>& lumped,
                              const std::string& file, RobotModel* robot);

}  // namespace possibility::models
