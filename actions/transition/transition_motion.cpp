#include "actions/transition/transition_motion.h"

#include <fmt/format.h>

#include "actions/motion/motion_folder.h"
#include "actions/wholebody/motion_builder.h"
#include "actions/wholebody/motion_error.h"
#include "collocation/study/stored_solution_reader.h"
#include "collocation/study/stored_solution_writer.h"
#include "models/input/input_error.h"

namespace possibility::actions {
namespace {

using Eigen::Vector2d;

/// Largest distance between the places of a shared patch in the two stances, m.
constexpr double kAlignmentTolerance = 1e-6;

int LimbOfContact(const models::Gait& gait, int contact) {
  for (size_t i = 0; i < gait.limbs.size(); ++i) {
    if (gait.limbs[i].contact == contact) return static_cast<int>(i);
  }
  return -1;
}

}  // namespace

TransitionMotion::TransitionMotion(const models::RobotModel& robot, const NominalStance& from,
                                   const NominalStance& to, const std::filesystem::path& library,
                                   const CancellationToken& cancellation)
    : from_(&from), to_(&to) {
  AlignStances(robot);
  const TransitionSolver solver(robot, from, to);
  if (!library.empty()) {
    file_ = MotionFolder(library, SitDownIdentity(robot)) /
            fmt::format("transition_{}_{}.json", from.gait->name, to.gait->name);
  }
  if (FindInLibrary(solver)) return;
  try {
    solved_ = solver.Solve(cancellation);
  } catch (const MotionError& error) {
    throw InputError(fmt::format("{}: transitions: {} to {} is not possible: {}",
                                 robot.file.string(), from.gait->name, to.gait->name,
                                 error.what()));
  }
}

void TransitionMotion::AlignStances(const models::RobotModel& robot) {
  Vector2d sum = Vector2d::Zero();
  std::vector<Vector2d> offsets;
  for (size_t i = 0; i < to_->gait->limbs.size(); ++i) {
    const int limb = LimbOfContact(*from_->gait, to_->gait->limbs[i].contact);
    if (limb < 0) continue;
    offsets.push_back((from_->patch_centres[limb] - to_->patch_centres[i]).head<2>());
    sum += offsets.back();
  }
  if (offsets.size() < from_->gait->limbs.size()) {
    throw InputError(fmt::format(
        "{}: transitions: {} bears on a contact that {} does not bear on (a transition leads to "
        "the gait with more contacts, and back)",
        robot.file.string(), from_->gait->name, to_->gait->name));
  }
  const Vector2d mean = sum / static_cast<double>(offsets.size());
  for (const Vector2d& offset : offsets) {
    if ((offset - mean).norm() > kAlignmentTolerance) {
      throw InputError(fmt::format(
          "{}: transitions: the contacts shared by {} and {} stand {:.6f} m differently apart",
          robot.file.string(), from_->gait->name, to_->gait->name, (offset - mean).norm()));
    }
  }
  displacement_ = {mean.x(), mean.y(), 0};
}

bool TransitionMotion::FindInLibrary(const TransitionSolver& solver) {
  if (file_.empty() || !std::filesystem::exists(file_)) return false;
  try {
    solved_ = solver.Realise(collocation::ReadSolution(file_));
    was_known_ = true;
  } catch (const std::exception&) {
    // A solution that cannot be read or realised is solved again.
  }
  return was_known_;
}

void TransitionMotion::Save() const {
  if (file_.empty()) return;
  std::error_code error;
  std::filesystem::create_directories(file_.parent_path(), error);
  collocation::WriteSolution(file_, solved_.solution);
}

}  // namespace possibility::actions
