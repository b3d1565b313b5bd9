#pragma once

#include <string>
#include <vector>

#include "collocation/transcription/transcription_scheme.h"

namespace possibility::collocation {

/// The multipliers of one quantity or one output of a constraint, along a phase's mesh: what the
/// objective changes by per unit of it.
struct MultiplierSeries {
  int phase = -1;  ///< -1: of the whole problem
  std::string name;
  int output = -1;  ///< of a constraint with several; -1: it has one
  /// Of the phase's mesh, ascending; -1 where `phase` is -1. One value for each.
  std::vector<int> points;
  std::vector<double> values;

  bool operator==(const MultiplierSeries&) const = default;
};

/// The multipliers of a solution, in the problem's own units.
struct Multipliers {
  std::vector<MultiplierSeries> constraints;
  /// Of the bounds of variables; a series that is not there is zero.
  std::vector<MultiplierSeries> lower, upper;

  bool operator==(const Multipliers&) const = default;
};

/// The points of a phase's mesh.
struct MeshPoints {
  int per_interval = 1;         ///< points from one knot to before the next
  std::vector<double> shares;   ///< of the phase's duration
  std::vector<double> weights;  ///< share of each in the integral over the phase

  MeshPoints(const std::vector<double>& mesh, const TranscriptionScheme& scheme);
};

/// Carries a series from one mesh to another of the same scheme. What a row or a bound of one
/// instant costs is spread over time: its multiplier is a density times the point's weight, and the
/// density is interpolated, linearly and for each node of the scheme by itself. The multipliers of
/// defects over whole intervals are costates, which do not shrink with the mesh.
class MultiplierInterpolation {
 public:
  /// Keeps no reference. `is_defect`: of a quantity's integral.
  MultiplierInterpolation(const MultiplierSeries& series, const MeshPoints& from, bool is_defect);

  double At(const MeshPoints& to, int point) const;

 private:
  struct Samples {
    std::vector<double> shares, values;
  };
  bool IsDensity(int node) const { return !is_single_ && !(is_defect_ && node == 0); }

  bool is_defect_;
  bool is_single_;  // holds at one point alone: spread over no time
  std::vector<Samples> by_node_;
};

}  // namespace possibility::collocation
