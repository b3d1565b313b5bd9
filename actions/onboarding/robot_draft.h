#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "models/facts/body_plan.h"
#include "models/facts/mirror_pairs.h"
#include "models/facts/srdf_reader.h"
#include "models/robot/robot_model.h"
#include "models/robot/urdf_reader.h"

namespace possibility::actions {

/// A limit that is not in the URDF, and why it has this value.
struct AssumedLimit {
  std::vector<std::string> joints;
  double limit = 0;  ///< rad/s, m/s, N m or N
  std::string reason;
};

/// Mass properties that replace those of a URDF's link, and why.
struct AssumedInertial {
  std::string link;
  models::Inertial inertial;
  std::string reason;
};

/// A pair of links that is not tested, and why.
struct IgnoredPair {
  int link = 0, other = 0;
  std::string reason;
};

/// What follows from a URDF (and an SRDF) for a robot that walks on two feet, without postures.
struct RobotDraft {
  std::filesystem::path urdf_file;
  std::string urdf;  ///< its text; with a turned root if the robot looks along -x of its own
  models::UrdfTree tree;
  models::BodyPlan plan;
  /// Links, joints, shapes, limits, friction; contacts 0 and 1 are the left and the right sole.
  models::RobotModel robot;
  std::vector<int> left_leg, right_leg, left_arm, right_arm;  ///< joints, from the trunk outwards
  models::MirrorPairs pairs;
  std::vector<AssumedLimit> efforts, speeds;
  std::vector<AssumedInertial> inertials;
  std::vector<std::string> positions;  ///< joints whose limits of position are assumed
  std::vector<IgnoredPair> ignored;
  bool pairs_are_given = false;  ///< `ignored` is complete: postures add none
  /// Of joints outside the legs, which then stay; none: 0, and arms are placed.
  std::optional<Eigen::VectorXd> rest;
  /// rad, GaitParameters::sway of a gait that is fitted again, which then stays.
  std::optional<double> sway;
  double leg_length = 0;              ///< m: height of the hips above the soles at zero
  double sole_width = 0;              ///< m: least width of the left sole
  double sole_breadth = 0;            ///< m: its extent aside
  std::vector<std::string> findings;  ///< what was assumed and why, a sentence each
  std::vector<std::string> warnings;
};

/// Reads a URDF with its meshes and derives the rest. `packages`: see models::ResolveMeshPath.
/// @throws InputError naming the file and what is missing: legs, soles, shapes, inertias.
RobotDraft DraftRobot(const std::filesystem::path& urdf_file,
                      const std::vector<std::filesystem::path>& packages,
                      const std::optional<std::filesystem::path>& srdf_file);

}  // namespace possibility::actions
