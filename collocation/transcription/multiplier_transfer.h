#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "collocation/transcription/multipliers.h"
#include "collocation/transcription/placed_name.h"
#include "collocation/transcription/trajectory.h"
#include "collocation/transcription/variable_layout.h"

namespace possibility::collocation {

/// Multipliers of scaled variables or rows as series in the problem's own units. `names`, `scales`
/// and `multipliers`: one per variable or row.
std::vector<MultiplierSeries> SeriesOf(const std::vector<PlacedName>& names,
                                       const std::vector<double>& scales,
                                       const Eigen::VectorXd& multipliers);

/// Whether all phases of a trajectory have this scheme.
bool HasScheme(const Trajectory& trajectory, const TranscriptionScheme& scheme);

/// Series that belong to the trajectory `from`, of the layout's scheme, as multipliers of the
/// layout's scaled variables or rows, interpolated if the mesh differs. One that is unknown is
/// zero; none if `all` is set and one is unknown.
std::optional<Eigen::VectorXd> Transferred(const std::vector<MultiplierSeries>& series,
                                           const Trajectory& from, const VariableLayout& layout,
                                           const std::vector<PlacedName>& names,
                                           const std::vector<double>& scales, bool all);

}  // namespace possibility::collocation
