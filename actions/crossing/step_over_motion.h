#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "actions/crossing/step_over_problem.h"
#include "actions/plan/plan.h"
#include "collocation/study/stored_solution.h"
#include "common/cancellation_token.h"

namespace possibility::actions {

/// The motion of a step over.
class StepOverMotion {
 public:
  /// Reads the motion from the library, or else solves it. The solve begins with the most similar
  /// step over in the library, of another robot with the same joints or of another obstacle, if
  /// there is one. The motion keeps off the highest and thickest obstacle. `library`: folder of
  /// solved motions; empty: none.
  /// @throws MotionError if there is no motion; Cancelled.
  StepOverMotion(const StepOverProblem& problem, const std::filesystem::path& library,
                 const CancellationToken& cancellation);

  /// From rest to rest, times from 0.
  const std::vector<Phase>& phases() const { return phases_; }
  bool was_known() const { return was_known_; }   ///< read from the library
  int iterations() const { return iterations_; }  ///< of the solve; 0 if it was known
  /// Saves the solution to the library. @throws InputError if that fails.
  void Save() const;

 private:
  bool FindInLibrary(const StepOverProblem& problem, const CancellationToken& cancellation);

  std::filesystem::path file_;  ///< of the solution; empty: no library
  std::vector<Phase> phases_;
  collocation::StoredSolution solution_;
  bool was_known_ = false;
  int iterations_ = 0;
};

}  // namespace possibility::actions
