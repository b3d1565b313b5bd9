#include "actions/planner/planner_switches.h"

#include <fmt/format.h>

#include "models/input/input_error.h"

namespace possibility::actions {

PlannerSwitches WithExplorers(PlannerSwitches switches, const std::vector<std::string>& names,
                              const std::string& where) {
  switches.straight = switches.lattice = switches.random = switches.shortcuts = false;
  switches.footsteps = false;
  for (const std::string& name : names) {
    if (name == "straight") {
      switches.straight = true;
    } else if (name == "lattice") {
      switches.lattice = true;
    } else if (name == "random") {
      switches.random = true;
    } else if (name == "shortcuts") {
      switches.shortcuts = true;
    } else if (name == "footsteps") {
      switches.footsteps = true;
    } else {
      throw InputError(fmt::format(
          "{}: no explorer is called '{}', expected straight, lattice, random, shortcuts or "
          "footsteps",
          where, name));
    }
  }
  return switches;
}

}  // namespace possibility::actions
