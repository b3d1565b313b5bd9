#include "actions/jump/jump_motion_file.h"

#include <fmt/format.h>

#include <utility>

#include "actions/plan/contact_name.h"
#include "actions/plan/packed_reader.h"
#include "actions/plan/packed_writer.h"
#include "models/input/file_contents.h"
#include "models/input/input_error.h"

namespace possibility::actions {
namespace {

constexpr const char* kPreparation = "preparation";
constexpr const char* kJump = "jump";

/// Beyond those of a plan: 5e-7 m/s^2 and 1e-7 N, a thousandth of what a plan may be off.
constexpr int kFinerBits = 8;

std::vector<std::string> JointNames(const models::RobotModel& robot) {
  std::vector<std::string> names;
  for (const models::Joint& joint : robot.joints) names.push_back(joint.name);
  return names;
}

[[noreturn]] void Reject(const std::filesystem::path& file, const std::string& what) {
  throw InputError(fmt::format("{}: {}", file.string(), what));
}

void RequireRobots(const Plan& plan, const models::RobotModel& robot,
                   const std::filesystem::path& file) {
  if (plan.joints != JointNames(robot)) Reject(file, "joints: expected those of the robot");
  for (const Segment& segment : plan.segments) {
    for (const Phase& phase : segment.phases) {
      if (phase.knots.front().tau.size() != robot.num_joints()) Reject(file, "has no torques");
      if (phase.knots.front().forces.cols() != CountPoints(robot, phase)) {
        Reject(file, "points: expected those of the contacts");
      }
    }
  }
}

}  // namespace

void WriteJumpMotion(const SolvedJump& jump, const models::RobotModel& robot,
                     const std::filesystem::path& file) {
  Plan plan;
  plan.version = 2;
  plan.force_bits += kFinerBits;
  plan.joints = JointNames(robot);
  const auto jump_begins = jump.phases.begin() + (jump.preparation > 0 ? 1 : 0);
  if (jump.preparation > 0) plan.segments.push_back({kPreparation, {jump.phases.front()}});
  plan.segments.push_back({kJump, {jump_begins, jump.phases.end()}});
  for (Segment& segment : plan.segments) {
    for (Phase& phase : segment.phases) phase.acceleration_bits += kFinerBits;
  }
  WritePackedPlan(plan, file);
}

SolvedJump ReadJumpMotion(const JumpTask& task, const models::RobotModel& robot,
                          const std::filesystem::path& file) {
  Plan plan = ReadPackedPlan(models::ReadFileContents(file), file);
  const std::size_t count = plan.segments.size();
  if (count < 1 || count > 2 || plan.segments.back().action != kJump ||
      plan.segments.front().action != (count == 2 ? kPreparation : kJump)) {
    Reject(file, "segments: expected \"jump\", after \"preparation\" at most");
  }
  RequireRobots(plan, robot, file);
  SolvedJump jump{task, {}};
  if (count == 2) jump.preparation = plan.segments.front().phases.back().knots.back().t;
  for (Segment& segment : plan.segments) {
    for (Phase& phase : segment.phases) {
      phase.acceleration_bits = Phase().acceleration_bits;
      jump.phases.push_back(std::move(phase));
    }
  }
  return jump;
}

}  // namespace possibility::actions
