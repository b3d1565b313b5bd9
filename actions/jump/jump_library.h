#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "actions/jump/jump_solver.h"
#include "common/cancellation_token.h"

namespace possibility::actions {

/// Distances that a robot can jump, by height of the landing: derived by solving.
struct JumpReach {
  struct Row {
    double height = 0;  ///< m
    double shortest = 0;
    double farthest = 0;  ///< m; below `shortest`: none
  };
  std::vector<Row> rows;  ///< ascending in height; between two rows: the union of both ranges

  /// Whether the table allows a jump. Optimistic between rows: the union of both ranges. False
  /// below the first and above the last row.
  bool Allows(const JumpTask& task) const;
  /// The least and the greatest distance at a height; none if no jump is possible there.
  std::optional<std::pair<double, double>> Distances(double height) const;
};

/// Solved jumps on a grid of distances and heights: those of this run, and those in a folder that
/// earlier runs and `possibility library` filled with their motions and their solutions in the
/// plane. Each robot has its own part of the folder, and gets a new one when anything changes that
/// its jumps depend on. Safe to share between threads.
class JumpLibrary {
 public:
  static constexpr double kDistanceStep = 0.05;  ///< m
  static constexpr double kHeightStep = 0.001;   ///< m; fine, because ground heights are given

  enum class Use {
    kAll,
    kReachAlone,  ///< the folder's jumps are not read: each jump is solved once per run
  };

  /// `solver` must outlive it. `folder`: empty for none; need not exist.
  JumpLibrary(const JumpSolver& solver, const std::filesystem::path& folder, Use use = Use::kAll);

  /// The nearest task on the grid.
  static JumpTask OnGrid(const JumpTask& task);

  /// The known answer to a task on the grid, without solving; none if unknown. A folder that has
  /// only the solution of a jump is enough: the motion is realised again.
  std::optional<JumpAnswer> Find(const JumpTask& task);
  /// Find, or else solves (JumpSolver::Solve); keeps the answer unless it was cancelled. Two
  /// threads that ask for the same jump may both solve it.
  JumpAnswer FindOrSolve(const JumpTask& task, const CancellationToken& cancellation = {},
                         const JumpSolver::Log& log = {});

  const JumpSolver& solver() const { return solver_; }

  /// The table of the folder; if it has none, an optimistic bound from joint speeds and limb
  /// lengths alone.
  const JumpReach& reach() const { return reach_; }
  /// Folder of this robot's jumps; empty if there is none.
  const std::filesystem::path& folder() const { return folder_; }
  bool reach_is_derived() const { return reach_is_derived_; }

  /// Writes an answer that was solved or realised, and the table, into the folder.
  /// @throws InputError if that fails.
  void Save(const JumpAnswer& answer, const JumpTask& task) const;
  void SaveReach(const JumpReach& reach) const;

 private:
  using Key = std::pair<int, int>;
  static Key KeyOf(const JumpTask& task);
  /// Its file with an ending: ".zip" the motion, ".json" the solution.
  std::filesystem::path FileOf(const JumpTask& task, const char* ending) const;
  /// From the folder; no jump if it has none that can be read.
  JumpAnswer Read(const JumpTask& task) const;
  void ReadReach();

  const JumpSolver& solver_;
  std::string identity_;  ///< of the solver
  std::filesystem::path folder_;
  Use use_;
  JumpReach reach_;
  bool reach_is_derived_ = false;
  std::mutex mutex_;
  std::map<Key, JumpAnswer> answers_;
};

}  // namespace possibility::actions
