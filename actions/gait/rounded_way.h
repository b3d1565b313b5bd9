#pragma once

#include <vector>

#include "actions/wholebody/planar_pose.h"

namespace possibility::actions {

/// Stances along a way; straight lines between them.
using StanceLine = std::vector<PlanarPose>;

/// Whether a way bends between two strides.
bool Bends(const PlanarPose& a, const PlanarPose& b, const PlanarPose& c);

/// Cuts strides where they bend. At least one line; a line that leads nowhere has two stances.
/// `strides`: at least two.
std::vector<StanceLine> StraightLines(const std::vector<PlanarPose>& strides);

/// The straight way through `corners` (at least two), smoothed: each of its stances becomes the
/// mean of those around it, place and heading, as far as a window reaches to both sides. So
/// headings turn along with the way, and a turn on the spot becomes a bend. Ways are measured in m,
/// with 0.03 m for 1 rad. `windows`: half a window at each inner corner, m; elsewhere it is at most
/// by as much wider as the corner is away. The ends stay where they are. Where a window is 0 the
/// way passes through the corner, and is cut if it bends there.
std::vector<StanceLine> RoundedLines(const std::vector<PlanarPose>& corners,
                                     const std::vector<double>& windows);

}  // namespace possibility::actions
