#pragma once

#include <optional>
#include <string>
#include <vector>

namespace possibility::actions {

/// Which planner is asked.
enum class PlannerPreset {
  kDefault,  ///< everything we know
  kPaper,    ///< Algorithms 1 to 4 as the paper prints them
};

/// What a preset switches. Whatever is off in kPaper is ours and not in the paper.
struct PlannerSwitches {
  /// Solved motions are read from PlanRequest::library; if not, only how far the robot jumps is,
  /// which is part of C_N.
  bool solved_motions = true;
  bool straight = true;     ///< straight ways to goals are asked for first
  bool lattice = true;      ///< LatticeExplorer
  bool random = true;       ///< Algorithms 2 to 4
  bool floods = true;       ///< a search over the whole space may end the random one with "no"
  bool shortcuts = true;    ///< ShortcutExplorer
  bool improvement = true;  ///< quicker routes than the first confirmed one are looked for
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
    switches.improvement = false;
    switches.skip_jumps = 0.9;  // section "Experimental Results"
  }
  return switches;
}

/// Leaves of a preset's explorers only those that are named: "straight", "lattice", "random",
/// "shortcuts". @throws InputError for other names, beginning with `where`.
PlannerSwitches WithExplorers(PlannerSwitches switches, const std::vector<std::string>& names,
                              const std::string& where);

}  // namespace possibility::actions
