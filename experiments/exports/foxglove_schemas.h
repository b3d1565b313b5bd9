#pragma once

#include <string>

namespace possibility::experiments {

/// JSON schemas of the messages that Foxglove knows by these names (its public schemas), as far as
/// this program uses them.
std::string FrameTransformsSchema();  ///< foxglove.FrameTransforms
std::string SceneUpdateSchema();      ///< foxglove.SceneUpdate
std::string JointStatesSchema();      ///< foxglove.JointStates
/// std_msgs/String: {"data": text}, for the robot's URDF.
std::string TextSchema();
/// Forces of the ground as numbers, to plot them (docs/exports.md).
std::string ContactForcesSchema();

}  // namespace possibility::experiments
