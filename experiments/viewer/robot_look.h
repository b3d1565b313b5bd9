#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "models/mesh/triangle_mesh.h"
#include "models/robot/robot_model.h"

namespace possibility::experiments {

/// A mesh of RobotLook at a place of a link.
struct PosedMesh {
  int mesh = 0;  ///< index into RobotLook::meshes
  Eigen::Isometry3d X_LM = Eigen::Isometry3d::Identity();
};

/// What is seen of a link. With neither shapes nor meshes nothing is known of it.
struct LinkLook {
  std::vector<models::PosedShape> shapes;
  std::vector<PosedMesh> meshes;
};

/// What a robot looks like, by the `<visual>` elements of its URDF.
struct RobotLook {
  std::vector<LinkLook> links;  ///< as the robot's; empty if its URDF has no `<visual>`
  std::vector<models::TriangleMesh> meshes;
  std::vector<std::string> faults;  ///< why nothing, or not all, is known; a line each
};

/// All meshes together have about so many triangles at most (SimplifyTogether): 0.7 MB of a page.
inline constexpr int kMostSeenTriangles = 30000;

/// Reads the files that `robot` was read from. Nothing is thrown: a mesh that cannot be read, for
/// whatever reason, is a fault, and its link looks like nothing.
RobotLook LookOf(const models::RobotModel& robot);

}  // namespace possibility::experiments
