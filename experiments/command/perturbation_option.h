#pragma once

#include <string>
#include <utility>
#include <vector>

#include "actions/rollout/perturbation.h"

namespace possibility::experiments {

/// A perturbation as it is written on the command line.
struct NamedPerturbation {
  std::string text;                                    ///< "mass=1.05,slope_deg=1"; empty: none
  std::vector<std::pair<std::string, double>> values;  ///< by name, in the order of the text
  actions::Perturbation perturbation;
};

/// "mass=1.05,slope_deg=1". docs/command_line.md lists the names.
/// @throws InputError for an unknown or repeated name, or a value that is no number in its range.
NamedPerturbation ParsePerturbation(const std::string& text);

/// The cases that `rollout` simulates if none is given.
std::vector<NamedPerturbation> UsualPerturbations();

}  // namespace possibility::experiments
