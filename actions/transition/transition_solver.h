#pragma once

#include <vector>

#include "actions/plan/plan.h"
#include "actions/sagittal/sagittal_model.h"
#include "actions/transition/sit_down_problem.h"
#include "collocation/study/stored_solution.h"
#include "common/cancellation_token.h"

namespace possibility::actions {

/// A transition of the whole robot within all limits.
struct SolvedTransition {
  std::vector<Phase> phases;  ///< in the first stance's frame, rest to rest, times from 0
  collocation::StoredSolution solution;  ///< in the sagittal plane
};

/// Finds the motion from the stance of one gait to the stance of another that bears on more
/// patches: collocation in the sagittal plane, then the motion of the whole robot.
class TransitionSolver {
 public:
  /// `robot`, `from` and `to` must outlive it. @throws what SagittalModel throws.
  TransitionSolver(const models::RobotModel& robot, const NominalStance& from,
                   const NominalStance& to, const SitDownSettings& settings = {});

  const SagittalModel& model() const { return model_; }

  /// Solves from scratch and verifies the motion on bare ground. Asks
  /// `cancellation` at every step of the solve.
  /// @throws MotionError if there is no motion, Cancelled.
  SolvedTransition Solve(const CancellationToken& cancellation) const;
  /// Realises a stored solution. @throws std::invalid_argument if it belongs to another problem;
  /// MotionError.
  SolvedTransition Realise(const collocation::StoredSolution& solution) const;

 private:
  std::vector<Phase> InSpace(const collocation::Trajectory& trajectory) const;

  const models::RobotModel& robot_;
  const NominalStance& from_;
  const NominalStance& to_;
  SitDownSettings settings_;
  SagittalModel model_;
};

}  // namespace possibility::actions
