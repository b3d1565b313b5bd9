#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace possibility::experiments {

struct NamedBytes {
  std::string name;  ///< relative to the folder that the files go to
  std::string bytes;
};

/// A robot of an MJCF file, restated as a URDF.
struct MjcfRobot {
  std::string urdf;                   ///< its text; meshes are named as in `files`
  std::string srdf;                   ///< the pairs of links that MJCF excludes; empty without any
  std::vector<NamedBytes> files;      ///< the meshes, binary STL
  std::vector<std::string> findings;  ///< what was left out or changed, a sentence each
};

/// Reads an MJCF file through MuJoCo, in a process of its own.
///
/// The robot is the one tree of bodies with hinges or slides. Each joint ends in a link whose frame
/// is in the joint; where a body has several, the links between them have a millionth of its mass.
/// Joints are zero where the file's `ref` puts them. Limits of effort are those of the actuators.
/// @param robot the name that the URDF gets.
/// @throws InputError naming the file if MuJoCo refuses it, it holds no or several robots, a ball
///     joint, or an equality that is not a mimic joint, or if this program was built without
///     MuJoCo.
MjcfRobot ReadMjcf(const std::filesystem::path& file, const std::string& robot);

}  // namespace possibility::experiments
