#include "actions/spatial/spatial_solver.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "actions/spatial/separating_planes.h"
#include "actions/spatial/spatial_motion.h"
#include "actions/wholebody/motion_error.h"
#include "actions/wholebody/self_clearance.h"

namespace possibility::actions {
namespace {

using collocation::OptimalControlResult;
using collocation::Separation;
using Eigen::VectorXd;

/// Planes are drawn for the whole shapes of a pair; those farther apart need none, m.
constexpr double kNear = 0.03;
/// The motion between the knots keeps this much less, m.
constexpr double kReserve = 0.002;

/// Where two links come closest.
struct Encounter {
  double distance = 0;
  VectorXd q;
};

class Rounds {
 public:
  Rounds(const models::RobotModel& robot, const models::Gait& limbs,
         const models::ContactSchedule& schedule, const VectorXd& from, const VectorXd& to,
         const SpatialSolverSettings& settings)
      : robot_(robot),
        limbs_(limbs),
        schedule_(schedule),
        from_(from),
        to_(to),
        settings_(settings),
        clearance_(robot, {from, to}) {}

  SpatialSolution Solve(const CancellationToken& cancellation,
                        const std::function<void(const collocation::SolverIteration&)>& log) {
    SpatialSolution solution;
    SpatialSettings problem = settings_.problem;
    problem.sequence.limits.friction = robot_.friction;
    for (;;) {
      ++solution.rounds;
      const SpatialProblem stated =
          StateSpatialProblem(robot_, limbs_, schedule_, from_, to_, problem);
      SolveRound(*stated.problem, &solution, cancellation, log);
      if (!solution.result.succeeded()) throw MotionError(solution.result.message);
      solution.phases = Build(stated.model, solution.result.trajectory, cancellation);
      const std::vector<Separation> missing = MissingPlanes(solution.phases);
      if (missing.empty()) {
        solution.solution = Store(*stated.problem, solution.result);
        return solution;
      }
      if (solution.rounds == settings_.max_rounds) throw MotionError(TooClose());
      auto& separations = problem.sequence.separations;
      separations.insert(separations.end(), missing.begin(), missing.end());
      solution.separations = static_cast<int>(separations.size());
    }
  }

  std::vector<Phase> Realise(const collocation::StoredSolution& solution,
                             const CancellationToken& cancellation) const {
    const SpatialProblem stated =
        StateSpatialProblem(robot_, limbs_, schedule_, from_, to_, settings_.problem);
    CheckSameQuantities(*stated.problem, solution);
    return Build(stated.model, solution.trajectory, cancellation);
  }

 private:
  collocation::OptimalControlOptions Options() const {
    collocation::OptimalControlOptions options;
    options.solver = settings_.solver;
    options.intervals.clear();
    for (const models::ContactInterval& interval : schedule_.intervals) {
      const int intervals = static_cast<int>(std::lround(interval.duration / settings_.interval));
      options.intervals.push_back(std::max(settings_.least_intervals, intervals));
    }
    return options;
  }

  void SolveRound(const collocation::OptimalControlProblem& problem, SpatialSolution* solution,
                  const CancellationToken& cancellation,
                  const std::function<void(const collocation::SolverIteration&)>& log) const {
    const auto& start = settings_.start;
    if (start && HasSameQuantities(problem, *start)) {
      solution->result = SolveOptimalControl(problem, *start, Options(), cancellation, log);
      solution->iterations += solution->result.iterations;
      cancellation.ThrowIfCancelled();
      if (solution->result.succeeded()) return;
    }
    // Not with the round before: from its motion, which the planes cut, a walk of 2.8 m did not
    // converge in 100 iterations, from the line it takes 40.
    solution->result = SolveOptimalControl(problem, Options(), std::nullopt, cancellation, log);
    solution->iterations += solution->result.iterations;
    cancellation.ThrowIfCancelled();
  }

  std::vector<Phase> Build(const collocation::RobotSystem& model,
                           const collocation::Trajectory& trajectory,
                           const CancellationToken& cancellation) const {
    return MotionBuilder(robot_, settings_.motion)
        .Build(SpatialMotion(robot_, limbs_, schedule_, model, trajectory), from_, cancellation);
  }

  /// Planes for the pairs that come too close, each at the knot of the interval where it is worst.
  std::vector<Separation> MissingPlanes(const std::vector<Phase>& phases) {
    std::vector<Separation> missing;
    for (std::size_t k = 0; k < phases.size(); ++k) {
      std::map<std::pair<int, int>, Encounter> encounters;
      for (const Knot& knot : phases[k].knots) {
        for (const auto& fault : clearance_.Faults(knot.q, settings_.clearance)) {
          const auto [at, is_new] = encounters.try_emplace({fault.pair.link, fault.pair.other});
          if (!is_new && at->second.distance <= fault.pair.distance) continue;
          at->second = {fault.pair.distance, knot.q};
        }
      }
      for (const auto& [links, encounter] : encounters) {
        worst_ = fmt::format("{} is {:.4f} m from {}", robot_.links[links.first].name,
                             encounter.distance, robot_.links[links.second].name);
        const std::vector<Separation> planes =
            SeparatingPlanes(robot_, encounter.q, links.first, links.second, kNear,
                             settings_.clearance + kReserve, static_cast<int>(k));
        missing.insert(missing.end(), planes.begin(), planes.end());
      }
    }
    return missing;
  }

  std::string TooClose() const {
    return fmt::format("{}, expected {:.4f}, after {} rounds", worst_, settings_.clearance,
                       settings_.max_rounds);
  }

  const models::RobotModel& robot_;
  const models::Gait& limbs_;
  const models::ContactSchedule& schedule_;
  const VectorXd& from_;
  const VectorXd& to_;
  const SpatialSolverSettings& settings_;
  SelfClearance clearance_;
  std::string worst_;  ///< encounter, for the message
};

}  // namespace

SpatialSettings SpatialSolverSettings::ProblemDefaults() {
  SpatialSettings problem;
  problem.sequence.limits.friction_fraction = 0.85;
  problem.sequence.limits.torque_fraction = 0.9;
  problem.sequence.limits.speed_fraction = 0.9;
  problem.sequence.limits.joint_margin = 0.01;
  problem.sequence.pressure_reserve = 0.02;
  problem.sequence.quickest = 0.75;
  return problem;
}

collocation::SolverOptions SpatialSolverSettings::SolverDefaults() {
  collocation::SolverOptions options;
  options.ipopt = {{"bound_mult_init_val", "0.01"}};
  return options;
}

MotionSettings SpatialSolverSettings::MotionDefaults() {
  MotionSettings motion;
  motion.knot_spacing = 0.01;
  motion.minimum_intervals = 6;
  // A foot unloads to zero before it lifts.
  motion.normal_reserve = 0;
  motion.friction_margin = 0.95;
  motion.torque_margin = 0.99;
  motion.speed_margin = 0.99;
  return motion;
}

SpatialSolution SolveSpatialMotion(
    const models::RobotModel& robot, const models::Gait& limbs,
    const models::ContactSchedule& schedule, const VectorXd& from, const VectorXd& to,
    const SpatialSolverSettings& settings, const CancellationToken& cancellation,
    const std::function<void(const collocation::SolverIteration&)>& log) {
  return Rounds(robot, limbs, schedule, from, to, settings).Solve(cancellation, log);
}

std::vector<Phase> RealiseSpatialMotion(const models::RobotModel& robot, const models::Gait& limbs,
                                        const models::ContactSchedule& schedule,
                                        const VectorXd& from, const VectorXd& to,
                                        const SpatialSolverSettings& settings,
                                        const collocation::StoredSolution& solution,
                                        const CancellationToken& cancellation) {
  return Rounds(robot, limbs, schedule, from, to, settings).Realise(solution, cancellation);
}

}  // namespace possibility::actions
