#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "models/robot/urdf_reader.h"

namespace possibility::models {

/// A leg or an arm of a URDF: the joints that only it has, from the trunk outwards.
struct LimbChain {
  std::vector<std::string> joints;
  std::string tip;  ///< the link that the last joint moves
};

/// The parts of a humanoid that walk, and what does not take part.
struct BodyPlan {
  LimbChain left_leg, right_leg;
  LimbChain left_arm, right_arm;      ///< without joints if there are no arms
  std::vector<std::string> trunk;     ///< joints between the root and both arms
  std::set<std::string> lump;         ///< every other joint that moves: head, fingers, toes
  std::vector<std::string> findings;  ///< one sentence each: what was decided and why
};

/// Finds legs and arms in the tree at zero, x ahead, y to the left and z up in the root's frame.
/// The legs end in the lowest pair of joints to the left and right, and have six joints at most:
/// what follows (toes) is lumped. The arms are the longest other pair; they end where they branch
/// (fingers) or after seven joints.
/// @throws InputError naming the file if there are no two legs, or they have other than six joints
/// or joints that mimic each other.
BodyPlan FindBodyPlan(const UrdfTree& tree, const std::filesystem::path& urdf_file);

}  // namespace possibility::models
