#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "actions/jump/jump_motion.h"
#include "actions/jump/jump_problem.h"
#include "collocation/solver/solve_control.h"
#include "collocation/solver/solver.h"
#include "collocation/study/stored_solution.h"

namespace possibility::actions {

/// A jump of the whole robot that keeps every limit: what there is to know of it but where it
/// happens.
struct SolvedJump {
  JumpTask task;
  std::vector<Phase> phases;  ///< in the launch stance's frame, rest to rest, times from 0
  JumpMotionReport report;

  double duration() const { return phases.back().knots.back().t; }  ///< s
};

/// What an answer cost.
struct JumpEffort {
  int attempts = 0;
  int iterations = 0;
  collocation::SolverTimes solver;  ///< of all attempts together, s
  double realisation = 0;           ///< s: from the plane to the whole robot
  double total = 0;                 ///< s
};

struct JumpAnswer {
  std::shared_ptr<const SolvedJump> jump;  ///< null: there is none, or the solve was cancelled
  std::string reason;                      ///< why there is none
  bool cancelled = false;                  ///< nothing is known
  std::optional<collocation::StoredSolution> solution;  ///< of the plane, if there is a jump
  JumpEffort effort;
};

/// Answers whether a jump is possible by finding it: collocation in the sagittal plane, then the
/// motion of the whole robot, then its verification on bare ground. Stateless: any number of solves
/// at once. The same task has the same answer.
class JumpSolver {
 public:
  /// `robot`, `launch` and `landing` must outlive it. @throws what SagittalModel throws.
  JumpSolver(const models::RobotModel& robot, const NominalStance& launch,
             const NominalStance& landing, const JumpSettings& settings = {});

  const SagittalModel& model() const { return model_; }
  const JumpSettings& settings() const { return settings_; }

  /// From nothing. `control` (optional) cancels and pauses.
  JumpAnswer Solve(const JumpTask& task, collocation::SolveControl* control = nullptr) const;
  /// From a solution of the same task, at the cost of its realisation alone.
  /// @throws std::invalid_argument if it is of another problem.
  JumpAnswer Realise(const JumpTask& task, const collocation::StoredSolution& solution) const;
  /// What is wrong with a jump when it is simulated on bare ground; empty if nothing. Takes
  /// seconds.
  std::string FaultInSimulation(const SolvedJump& jump) const;

 private:
  /// True if the attempt decided the answer; a finer mesh may help where only the whole robot
  /// failed.
  bool Attempt(const JumpTask& task, double fineness, collocation::SolveControl* control,
               JumpAnswer* answer) const;
  /// What `is_new` is verified, too.
  void RealiseInSpace(const JumpProblem& problem, const collocation::Trajectory& trajectory,
                      bool is_new, JumpAnswer* answer) const;

  const models::RobotModel& robot_;
  const NominalStance& launch_;
  const NominalStance& landing_;
  JumpSettings settings_;
  SagittalModel model_;
};

}  // namespace possibility::actions
