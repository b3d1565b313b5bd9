#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "models/robot/robot_model.h"
#include "models/robot/urdf_extract.h"

namespace possibility::models {

/// A `<mimic>` element as written: position = multiplier * position of `joint` + offset.
struct UrdfMimic {
  std::string joint;
  double multiplier = 1;
  double offset = 0;
};

/// One joint of a URDF as written there, before anything is lumped.
struct UrdfJoint {
  std::string name;
  std::string parent;
  std::string child;
  std::string type;  ///< "fixed", "revolute", "continuous", "prismatic", or an unsupported one
  std::optional<UrdfMimic> mimic;
  bool has_limits = false;
  Eigen::Isometry3d X_PJ = Eigen::Isometry3d::Identity();
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();  ///< as written, not normalised
  double lower = 0;
  double upper = 0;
  double velocity = 0;
  double effort = 0;
};

/// A mesh as collision geometry, not read yet.
struct UrdfMesh {
  std::string name;                                 ///< as written: file or package://
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();  ///< m per unit of the file; negative: mirrored
  Eigen::Isometry3d X_LM = Eigen::Isometry3d::Identity();  ///< in the link
};

struct UrdfLink {
  std::string name;
  /// Mass and moments may be those of no body that moves by itself (CheckMovingBody).
  std::optional<Inertial> inertial;
  std::vector<PosedShape> shapes;  ///< `<collision>` elements: box, cylinder, sphere, capsule
  std::vector<UrdfMesh> meshes;    ///< likewise
};

/// A URDF's kinematic tree: one root, every other link the child of exactly one joint. A root
/// without `<inertial>`, from which the robot hangs by one floating joint, is left out with it.
struct UrdfTree {
  std::string root;
  std::vector<UrdfLink> links;    ///< sorted by name
  std::vector<UrdfJoint> joints;  ///< sorted by name
};

/// Parses the text of a URDF; `file` is for messages only. With `kVisual` the links' shapes and
/// meshes are those of `<visual>` elements.
/// @throws InputError if urdfdom rejects it, the links are not a tree, or a mass is negative.
UrdfTree ParseUrdf(const std::string& text, const std::filesystem::path& file,
                   UrdfGeometry geometry = UrdfGeometry::kCollision);

/// What every link's inertia must be: no principal moment is negative, but for rounding.
/// @throws InputError, beginning with `owner`.
void CheckDefinite(const Inertial& inertial, const std::string& owner);

/// What the mass properties of a link must be that moves by itself: a positive mass, and an inertia
/// that is positive definite and satisfies the triangle inequality to 1e-4.
/// @throws InputError, beginning with `owner`.
void CheckMovingBody(const Inertial& inertial, const std::string& owner);

}  // namespace possibility::models
