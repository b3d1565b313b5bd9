#pragma once

#include <optional>
#include <string>
#include <vector>

namespace possibility::actions {

/// Selects the planner.
enum class PlannerPreset {
  kDefault,  ///< everything enabled
  kPaper,    ///< Algorithms 1 to 4 as the paper prints them
};

/// Switches of a preset. Everything that kPaper turns off is not in the paper.
struct PlannerSwitches {
  /// Reads solved motions from PlanRequest::library. If off, only the jump reach, which is part of
  /// C_N, is read.
  bool solved_motions = true;
  bool straight = true;     ///< straight ways to goals are tried first
  bool lattice = true;      ///< LatticeExplorer
  bool random = true;       ///< Algorithms 2 to 4
  bool floods = true;       ///< floods of the whole space may end the random search with "no"
  bool shortcuts = true;    ///< ShortcutExplorer
  bool footsteps = true;    ///< contact planning where the floods find no route
  bool improvement = true;  ///< search for quicker routes after the first confirmed one
  std::optional<double> skip_jumps;  ///< instead of the scenario's probability
};

inline PlannerSwitches SwitchesOf(PlannerPreset preset) {
  PlannerSwitches switches;
  if (preset == PlannerPreset::kPaper) {
    switches.solved_motions = false;
    switches.straight = false;
    switches.lattice = false;
    switches.shortcuts = false;
    switches.floods = false;
    switches.footsteps = false;
    switches.improvement = false;
    switches.skip_jumps = 0.9;  // section "Experimental Results"
  }
  return switches;
}

/// Keeps only the named explorers of a preset: "straight", "lattice", "random", "shortcuts",
/// "footsteps".
/// @throws InputError for other names, beginning with `where`.
PlannerSwitches WithExplorers(PlannerSwitches switches, const std::vector<std::string>& names,
                              const std::string& where);

}  // namespace possibility::actions
