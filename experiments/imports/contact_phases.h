#pragma once

#include <vector>

#include "experiments/imports/imported_trajectory.h"

namespace possibility::experiments {

/// A stretch of an imported motion with one set of contacts in one segment.
struct ImportedPhase {
  int segment = 0;
  std::vector<bool> bears;   ///< by point of AllContactPoints
  std::vector<int> samples;  ///< indices, at least two, their times increasing

  bool AnyBears() const;
};

/// Cuts a motion where contacts or the segment change. Two samples at one time are the end of one
/// phase and the beginning of the next. Otherwise contacts change somewhere between two samples,
/// and only the points that bear at both are taken to bear between: a phase without the points
/// that lift begins at the earlier sample, one with those that touch down at the later. If none
/// bears at both, the points of the earlier one bear until the later.
std::vector<ImportedPhase> CutIntoPhases(const ImportedTrajectory& trajectory);

/// Stretches of samples with one set of contacts, one segment and increasing times: pairs of the
/// first sample and the one after the last. Every sample is in one.
std::vector<std::pair<int, int>> SteadyRuns(const ImportedTrajectory& trajectory);

}  // namespace possibility::experiments
