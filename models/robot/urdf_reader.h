#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "models/robot/robot_model.h"

namespace possibility::models {

/// A <mimic> element as written: position = multiplier * position of `joint` + offset.
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

struct UrdfLink {
  std::string name;
  std::optional<Inertial> inertial;
  std::vector<PosedShape> shapes;  ///< <collision> elements: box, cylinder, sphere
};

/// A URDF's kinematic tree: one root, every other link the child of exactly one joint.
struct UrdfTree {
  std::string root;
  std::vector<UrdfLink> links;    ///< sorted by name
  std::vector<UrdfJoint> joints;  ///< sorted by name
};

/// Parses the text of a URDF; `file` is for messages only. Mass properties are checked.
/// @throws InputError if urdfdom rejects it, the links are not a tree, a mass or an inertia is
/// not physically possible, or a collision geometry is a mesh.
UrdfTree ParseUrdf(const std::string& text, const std::filesystem::path& file);

}  // namespace possibility::models
