#include "actions/crossing/step_over_motion.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <optional>
#include <string>
#include <vector>

#include "actions/motion/motion_folder.h"
#include "actions/wholebody/motion_builder.h"
#include "actions/wholebody/motion_collision.h"
#include "actions/wholebody/motion_error.h"
#include "collocation/study/stored_solution_reader.h"
#include "collocation/study/stored_solution_writer.h"
#include "models/world/collision.h"
#include "models/world/environment.h"

namespace possibility::actions {
namespace {

using collocation::StoredSolution;

/// The obstacle at its highest and thickest.
models::Environment BeamAlone(const Beam& beam) {
  constexpr double kWidth = 10;  // m
  models::Obstacle obstacle;
  obstacle.name = "obstacle";
  obstacle.shape = models::Shape::Box({beam.end - beam.begin, kWidth, beam.height});
  obstacle.X_WO.translation() << (beam.begin + beam.end) / 2, 0, beam.height / 2;
  models::Environment environment;
  environment.obstacles.push_back(obstacle);
  return environment;
}

/// @throws MotionError; Cancelled.
void RequireOffBeam(const StepOverProblem& problem, const std::vector<Phase>& phases,
                    const CancellationToken& cancellation) {
  const models::Environment environment = BeamAlone(problem.beam());
  const models::CollisionChecker checker(problem.robot(), environment);
  const std::string hit = FirstHit(problem.robot(), environment, checker, phases, cancellation);
  cancellation.ThrowIfCancelled();
  if (!hit.empty()) throw MotionError(hit);
}

std::string FileName(const StepOverProblem& problem) {
  return "step_over_" + problem.limbs().name + ".json";
}

bool HasJointsOf(const StepOverProblem& problem, const StoredSolution& solution) {
  const std::vector<std::string>& names = solution.phases.front().coordinates;
  for (const models::GaitLimb& limb : problem.limbs().limbs) {
    for (const int joint : limb.joints) {
      const std::string& name = problem.robot().joints[joint].name;
      if (std::find(names.begin(), names.end(), name) == names.end()) return false;
    }
  }
  return true;
}

/// How much farther or less far than the problem's a motion leads, m.
double Difference(const StepOverProblem& problem, const StoredSolution& solution) {
  constexpr int kAhead = 0;  // coordinate of the root
  const double end = solution.trajectory.phases.back().coordinates[0].rightCols<1>()(kAhead);
  return std::abs(end - problem.displacement().x);
}

/// The solution of another robot or obstacle in the library whose motion is the most similar.
std::optional<StoredSolution> MostSimilar(const StepOverProblem& problem,
                                          const std::filesystem::path& library) {
  std::optional<StoredSolution> best;
  for (const std::filesystem::path& file : FilesOfIdentities(library, FileName(problem))) {
    try {
      StoredSolution solution = collocation::ReadSolution(file);
      if (!HasJointsOf(problem, solution)) continue;
      if (best && Difference(problem, *best) <= Difference(problem, solution)) continue;
      best = std::move(solution);
    } catch (const std::exception&) {
      // A solution that cannot be read is no beginning.
    }
  }
  return best;
}

}  // namespace

StepOverMotion::StepOverMotion(const StepOverProblem& problem, const std::filesystem::path& library,
                               const CancellationToken& cancellation) {
  if (!library.empty()) {
    file_ = MotionFolder(library, problem.Identity()) / FileName(problem);
  }
  if (FindInLibrary(problem, cancellation)) return;
  SpatialSolverSettings settings = problem.solver();
  settings.start = MostSimilar(problem, library);
  SpatialSolution solved = SolveSpatialMotion(problem.robot(), problem.limbs(), problem.schedule(),
                                              problem.from(), problem.to(), settings, cancellation);
  RequireOffBeam(problem, solved.phases, cancellation);
  phases_ = std::move(solved.phases);
  iterations_ = solved.iterations;
  solution_ = std::move(solved.solution);
  // A solve that begins with it needs its motion alone.
  solution_.multipliers = {};
}

bool StepOverMotion::FindInLibrary(const StepOverProblem& problem,
                                   const CancellationToken& cancellation) {
  if (file_.empty() || !std::filesystem::exists(file_)) return false;
  try {
    solution_ = collocation::ReadSolution(file_);
    phases_ =
        RealiseSpatialMotion(problem.robot(), problem.limbs(), problem.schedule(), problem.from(),
                             problem.to(), problem.solver(), solution_, cancellation);
    RequireOffBeam(problem, phases_, cancellation);
    was_known_ = true;
  } catch (const Cancelled&) {
    throw;
  } catch (const std::exception&) {
    // A solution that cannot be read or realised is solved again.
  }
  return was_known_;
}

void StepOverMotion::Save() const {
  if (file_.empty()) return;
  std::error_code error;
  std::filesystem::create_directories(file_.parent_path(), error);
  collocation::WriteSolution(file_, solution_);
}

}  // namespace possibility::actions
