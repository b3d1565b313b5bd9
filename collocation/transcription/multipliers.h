#pragma once

#include <string>
#include <vector>

#include "collocation/transcription/transcription_scheme.h"

namespace possibility::collocation {

/// The multipliers of one quantity or one output of a constraint, along a phase's mesh: the change
/// of the objective per unit of it.
struct MultiplierSeries {
  int phase = -1;  ///< -1: of the whole problem
  std::string name;
  int output = -1;  ///< for a constraint with several outputs; -1: it has one
  /// Indices of points of the phase's mesh, ascending; -1 if `phase` is -1. One value per point.
  std::vector<int> points;
  std::vector<double> values;

  bool operator==(const MultiplierSeries&) const = default;
};

/// The multipliers of a solution, in the problem's own units.
struct Multipliers {
  std::vector<MultiplierSeries> constraints;
  /// Multipliers of the bounds of variables. A missing series is zero.
  std::vector<MultiplierSeries> lower, upper;

  bool operator==(const Multipliers&) const = default;
};

/// The points of a phase's mesh.
struct MeshPoints {
  int per_interval = 1;         ///< points from one knot to just before the next
  std::vector<double> shares;   ///< of the phase's duration
  std::vector<double> weights;  ///< share of each point in the integral over the phase

  MeshPoints(const std::vector<double>& mesh, const TranscriptionScheme& scheme);
};

/// Carries a series from one mesh to another of the same scheme. The multiplier of a row or bound
/// that holds at each instant is a density times the point's weight. The density is interpolated
/// linearly, separately for each node of the scheme. The multipliers of defects over whole
/// intervals are costates, which do not shrink with the mesh.
class MultiplierInterpolation {
 public:
  /// Keeps no reference. `is_defect`: the series belongs to the integral of a quantity.
  MultiplierInterpolation(const MultiplierSeries& series, const MeshPoints& from, bool is_defect);

  double At(const MeshPoints& to, int point) const;

 private:
  struct Samples {
    std::vector<double> shares, values;
  };
  /// Points without a weight have no density.
  bool IsDensity(int node, double weight) const {
    return !is_single_ && !(is_defect_ && node == 0) && weight > 0;
  }

  bool is_defect_;
  bool is_single_;  // holds at one point only, so its multiplier is no density
  std::vector<Samples> by_node_;
};

}  // namespace possibility::collocation
