#pragma once

#include "models/robot/robot_model.h"

namespace possibility::experiments {

/// The planar biped of the walking problems: stance shank, stance thigh, torso, swing thigh, swing
/// shank; joints stance_knee, stance_hip, swing_hip, swing_knee about +y (positive tips the child
/// forward, to +x). The root's frame is at the stance foot; at zero both legs are stretched and the
/// torso stands upright. Masses and lengths of the robot RABBIT are from Westervelt, Grizzle &
/// Koditschek (2003). The torso's centre of mass is as in OptimTraj's demo/fiveLinkBiped: 0.2 m
/// below the shoulders, 0.425 m above the hip.
models::RobotModel FiveLinkBiped();
inline constexpr int kSwingShank = 4;  ///< link index
/// The tip of the swing foot in the swing shank's frame.
Eigen::Vector3d SwingFoot();

/// A body of 10 kg on a telescopic leg: the lower tube is the root, its frame at the point foot,
/// 1 kg; the hip's block, 1 kg, slides on it (joint leg: its height above the foot along the tube,
/// 0.3 to 0.7 m) and carries the body (joint hip, about +y).
models::RobotModel Hopper();

}  // namespace possibility::experiments
