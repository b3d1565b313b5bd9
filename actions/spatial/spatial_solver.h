#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

#include "actions/plan/plan.h"
#include "actions/spatial/spatial_problem.h"
#include "actions/wholebody/motion_builder.h"
#include "actions/wholebody/nominal_stance.h"
#include "collocation/study/optimal_control.h"
#include "collocation/study/stored_solution.h"
#include "common/cancellation_token.h"
#include "models/robot/contact_schedule.h"

namespace possibility::actions {

struct SpatialSolverSettings {
  SpatialSettings problem = ProblemDefaults();
  double interval = 0.05;  ///< s, of the mesh, about
  int least_intervals = 3;
  collocation::SolverOptions solver = SolverDefaults();
  double clearance = 0.01;  ///< m, of links from each other
  int max_rounds = 8;       ///< of solving again with planes between links that came too close
  MotionSettings motion = MotionDefaults();  ///< of the whole robot
  /// Solution of a neighbouring problem. If it has the same quantities, every round begins with its
  /// motion. A round where that leads nowhere, or without any, begins with the straight line.
  std::optional<collocation::StoredSolution> start;

  /// The problem keeps a tenth of the robot's limits for what lies between the knots.
  static SpatialSettings ProblemDefaults();
  /// Multipliers of bounds begin at 0.01 instead of 1: the step over a beam, two rounds, takes 110
  /// iterations instead of 156.
  static collocation::SolverOptions SolverDefaults();
  static MotionSettings MotionDefaults();
};

/// Motion of a whole robot by collocation.
struct SpatialSolution {
  std::vector<Phase> phases;
  collocation::OptimalControlResult result;  ///< of the last round
  collocation::StoredSolution solution;      ///< the same, to keep
  int rounds = 0;
  int iterations = 0;   ///< of all rounds
  int separations = 0;  ///< rows of planes between links, per knot
};

/// A robot's motion through a contact schedule from rest to rest, least in effort, with durations
/// free. The links keep apart: where they do not, planes between them are added to the problem, and
/// it is solved again. `from`, `to`: as of StateSpatialProblem. `limbs`: a
/// gait with a limb for each contact of the schedule.
/// @throws MotionError if there is no motion; Cancelled; std::invalid_argument as
/// StateSpatialProblem.
SpatialSolution SolveSpatialMotion(
    const models::RobotModel& robot, const models::Gait& limbs,
    const models::ContactSchedule& schedule, const Eigen::VectorXd& from, const Eigen::VectorXd& to,
    const SpatialSolverSettings& settings, const CancellationToken& cancellation = {},
    const std::function<void(const collocation::SolverIteration&)>& log = {});

/// The motion of a solution that was kept. Arguments as of SolveSpatialMotion.
/// @throws MotionError; Cancelled; std::invalid_argument if the solution is of another problem, or
/// as StateSpatialProblem.
std::vector<Phase> RealiseSpatialMotion(const models::RobotModel& robot, const models::Gait& limbs,
                                        const models::ContactSchedule& schedule,
                                        const Eigen::VectorXd& from, const Eigen::VectorXd& to,
                                        const SpatialSolverSettings& settings,
                                        const collocation::StoredSolution& solution,
                                        const CancellationToken& cancellation = {});

}  // namespace possibility::actions
