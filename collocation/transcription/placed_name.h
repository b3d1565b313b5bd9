#pragma once

#include <string>

namespace possibility::collocation {

/// The name of a variable, a row or a cost of a program, and where it stands.
struct PlacedName {
  int phase;  ///< -1: of no phase
  int point;  ///< of the phase's mesh
  std::string name;
  int output;  ///< for a function with several outputs; -1: it has one
  bool is_defect = false;
};

}  // namespace possibility::collocation
