#pragma once

#include <functional>
#include <string>
#include <vector>

#include "actions/jump/jump_library.h"

namespace possibility::actions {

/// Which jumps to try: a grid.
struct JumpSweep {
  double shortest = 0.2;              ///< m
  double farthest = 1.2;              ///< m
  std::vector<double> heights = {0};  ///< m, ascending
  int threads = 1;
  /// Of each height: after this many refusals beyond a success, farther jumps are not tried; 0:
  /// all are.
  int refusals_to_stop = 2;
  /// A new jump counts only if its simulation follows it; takes seconds.
  bool simulates = false;
  /// Asked after every answer, from any thread, one at a time, with how many of how many (at most)
  /// are answered; false abandons the rest. May be empty.
  std::function<bool(int, int)> keep_going;
};

struct JumpSweepEntry {
  JumpTask task;
  bool is_possible = false;
  bool was_known = false;  ///< from the library's folder
  std::string reason;      ///< why not
  JumpEffort effort;
};

/// The answers by height, then by distance. Jumps that are found are saved in the library's
/// folder, if it has one, at once: what is interrupted goes on where it was.
/// @throws InputError if one cannot be saved.
std::vector<JumpSweepEntry> SweepJumps(const JumpSweep& sweep, JumpLibrary* library);

/// By height the least and the greatest distance that is possible.
JumpReach ReachOf(const std::vector<JumpSweepEntry>& entries);

}  // namespace possibility::actions
