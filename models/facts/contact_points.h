#pragma once

#include <map>
#include <string>

namespace possibility::models {

struct UrdfWithoutPoints {
  std::string urdf;
  std::map<std::string, int> points;  ///< how many were left out, by link
};

/// The URDF without collision spheres of radius 0, by which Drake's robots say where they bear on
/// the ground. They are no shapes. The text is unchanged if there are none, or if it is no XML.
UrdfWithoutPoints WithoutPoints(const std::string& urdf);

}  // namespace possibility::models
