#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "models/robot/urdf_reader.h"

namespace possibility::models {

/// A named set of a robot's joints.
struct SrdfGroup {
  std::string name;
  std::vector<std::string> joints;
  std::vector<std::string> links;
  std::vector<std::pair<std::string, std::string>> chains;  ///< base link, tip link
  std::vector<std::string> groups;                          ///< groups that are part of it
};

/// A named posture of a group.
struct SrdfState {
  std::string name;
  std::string group;
  std::map<std::string, double> joints;  ///< rad or m
};

struct SrdfEndEffector {
  std::string name;
  std::string parent_link;
  std::string group;
};

/// A pair of links that need not be tested against each other.
struct SrdfDisabledPair {
  std::string link1, link2;
  std::string reason;  ///< "Adjacent", "Never", ...; may be empty
};

struct Srdf {
  std::vector<SrdfGroup> groups;
  std::vector<SrdfState> states;
  std::vector<SrdfEndEffector> end_effectors;
  std::vector<SrdfDisabledPair> disabled;
};

/// Reads groups, group states, end effectors and disabled collision pairs. Other elements are
/// ignored, and so are disabled pairs of links that the tree does not have. Joints of states that
/// the tree does not have, or that are fixed there, and those with several values (a floating base)
/// are left out.
/// @throws InputError, one line with file and line, if the file is missing or no SRDF, a name is
/// missing or unknown in the tree, a value is no number, or a name is taken.
Srdf ReadSrdf(const std::filesystem::path& file, const UrdfTree& tree);

/// The same from the file's text.
Srdf ParseSrdf(const std::string& text, const std::filesystem::path& file, const UrdfTree& tree);

}  // namespace possibility::models
