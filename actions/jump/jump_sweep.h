#pragma once

#include <functional>
#include <string>
#include <vector>

#include "actions/jump/jump_library.h"
#include "common/cancellation_token.h"

namespace possibility::actions {

/// Grid of jumps to try.
struct JumpSweep {
  double shortest = 0.2;              ///< m
  double farthest = 1.2;              ///< m
  std::vector<double> heights = {0};  ///< m, ascending
  int threads = 1;
  /// Per height, stops after this many refusals in a row beyond a success; 0: tries all distances.
  int refusals_to_stop = 3;
  /// Asked after every answer, from any thread, one question at a time. Once cancelled, the rest is
  /// left out.
  CancellationToken cancellation;
  /// Called after every answer, from any thread, one call at a time, with the number of answers and
  /// the largest possible total. May be empty.
  std::function<void(int, int)> progress;
};

struct JumpSweepEntry {
  JumpTask task;
  bool is_possible = false;
  bool was_known = false;  ///< read from the library's folder
  std::string reason;      ///< why it is not possible
  JumpEffort effort;
};

/// The answers by height, then by distance. Jumps are saved in the library's folder (if any) as
/// soon as they are found, so that an interrupted sweep can resume.
/// @throws InputError if a jump cannot be saved.
std::vector<JumpSweepEntry> SweepJumps(const JumpSweep& sweep, JumpLibrary* library);

/// The least and the greatest possible distance for each height.
JumpReach ReachOf(const std::vector<JumpSweepEntry>& entries);

}  // namespace possibility::actions
