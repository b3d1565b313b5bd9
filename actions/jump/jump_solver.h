#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "actions/jump/jump_problem.h"
#include "actions/jump/solved_jump.h"
#include "collocation/solver/solver.h"
#include "collocation/study/stored_solution.h"
#include "common/cancellation_token.h"

namespace possibility::actions {

/// Cost of an answer.
struct JumpEffort {
  int attempts = 0;
  int iterations = 0;
  collocation::SolverTimes solver;  ///< all attempts together, s
  double realisation = 0;           ///< s: realisation of the planar motion on the whole robot
  double total = 0;                 ///< s
};

struct JumpAnswer {
  std::shared_ptr<const SolvedJump> jump;               ///< null: no jump, or cancelled
  std::string reason;                                   ///< why there is no jump
  bool cancelled = false;                               ///< the answer is unknown
  std::optional<collocation::StoredSolution> solution;  ///< in the plane; none if it was stored
  JumpEffort effort;
};

/// Decides whether a jump is possible by finding it: collocation in the sagittal plane, then the
/// motion of the whole robot, then its verification on bare ground, simulation included. Stateless:
/// any number of solves may run at once. Deterministic: the same task has the same answer.
class JumpSolver {
 public:
  using Log = std::function<void(const collocation::SolverIteration&)>;

  /// `robot`, `launch` and `landing` must outlive the solver. @throws as SagittalModel.
  JumpSolver(const models::RobotModel& robot, const NominalStance& launch,
             const NominalStance& landing, const JumpSettings& settings);
  /// With JumpSettings::For.
  JumpSolver(const models::RobotModel& robot, const NominalStance& launch,
             const NominalStance& landing)
      : JumpSolver(robot, launch, landing, JumpSettings::For(robot, launch, landing)) {}

  const models::RobotModel& robot() const { return robot_; }
  const SagittalModel& model() const { return model_; }
  const JumpSettings& settings() const { return settings_; }
  /// Of this solver's jumps (JumpIdentity).
  std::string Identity() const;

  /// Solves from scratch. `log` (may be empty) is called with every iteration.
  JumpAnswer Solve(const JumpTask& task, const CancellationToken& cancellation = {},
                   const Log& log = {}) const;
  /// Realises a stored solution of the same task, without solving.
  /// @throws std::invalid_argument if it belongs to another problem.
  JumpAnswer Realise(const JumpTask& task, const collocation::StoredSolution& solution) const;

 private:
  /// True if the attempt decided the answer. A finer mesh may help if only the whole robot failed.
  /// `coarser`: the solution to start from, if there is one, and then this attempt's.
  bool Attempt(const JumpTask& task, double fineness, const CancellationToken& cancellation,
               const Log& log, std::optional<collocation::StoredSolution>* coarser,
               JumpAnswer* answer) const;
  /// Verifies the motion, too, if `is_new`.
  void RealiseInSpace(const JumpProblem& problem, const collocation::Trajectory& trajectory,
                      bool is_new, JumpAnswer* answer) const;

  /// The same for all jumps, so it is computed once. @throws MotionError
  const std::optional<Phase>& Preparation(const JumpMotion& motion) const;
  /// On its bare ground: verified, and simulated as planned and with a slightly different mass.
  /// @throws MotionError naming the fault.
  void RequireSound(const SolvedJump& jump) const;

  const models::RobotModel& robot_;
  const NominalStance& launch_;
  const NominalStance& landing_;
  JumpSettings settings_;
  SagittalModel model_;
  mutable std::once_flag prepared_;
  mutable std::optional<Phase> preparation_;
};

}  // namespace possibility::actions
