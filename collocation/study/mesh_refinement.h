#pragma once

#include <vector>

#include "collocation/study/control_jumps.h"
#include "collocation/study/mesh_error.h"
#include "collocation/transcription/trajectory.h"

namespace possibility::collocation {

/// How a mesh follows from the errors of the last one.
struct MeshRule {
  /// Intervals whose error exceeds it are split into as many parts as a scheme of that order needs,
  /// at most 4. Infinite: none is split.
  double tolerance = kInfinity;
  int order = 2;
  /// Up to four neighbours become one interval if its error would stay below a tenth of the
  /// tolerance.
  bool coarsen = false;
};

/// Every fifth knot, but at least four intervals; a mesh of up to four stays.
Mesh Coarse(const Mesh& mesh);

/// The mesh for the next solve. `errors`: by interval.
Mesh Refined(const Mesh& mesh, const std::vector<MeshError>& errors, const MeshRule& rule);

/// The mesh `refined` with knots close to the jumps, which were found on the mesh `old`. A jump
/// that is wider than `tolerance` (share of the phase) gets two knots on either side of where it
/// seems to be, at 1/32 and 1/8 of its width, in place of those between its ends; a narrower one
/// keeps its old knots.
Mesh WithKnotsAtJumps(const Mesh& refined, const Mesh& old, const std::vector<ControlJump>& jumps,
                      double tolerance);

}  // namespace possibility::collocation
