#include "actions/onboarding/refit_draft.h"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "actions/onboarding/leg_measures.h"
#include "models/facts/mirror_pairs.h"
#include "models/facts/zero_poses.h"
#include "models/input/input_error.h"

namespace possibility::actions {
namespace {

constexpr double kMirrored = 0.025;  // m
constexpr std::size_t kLegJoints = 6;

[[noreturn]] void FailAt(const models::RobotModel& robot, const models::Gait& gait,
                         const std::string& what) {
  throw InputError(fmt::format("{}: gaits: '{}': {}", robot.file.string(), gait.name, what));
}

}  // namespace

RobotDraft DraftToRefit(const models::RobotModel& robot, const models::Gait& gait) {
  if (gait.limbs.size() != 2) {
    FailAt(robot, gait, fmt::format("limbs: expected 2 feet, got {} limbs", gait.limbs.size()));
  }
  for (const models::GaitLimb& limb : gait.limbs) {
    if (limb.hold_orientation && limb.joints.size() == kLegJoints) continue;
    FailAt(robot, gait,
           fmt::format("limbs: expected six joints and hold_orientation: true at '{}', got {} "
                       "joints",
                       robot.contacts[limb.contact].name, limb.joints.size()));
  }
  if (gait.posture.root_pitch != 0) FailAt(robot, gait, "posture: expected root_pitch_deg 0");
  RobotDraft draft;
  draft.urdf_file = robot.file;
  draft.robot = robot;
  draft.robot.gaits.clear();
  draft.robot.transitions.clear();
  draft.robot.jumps.clear();
  const std::vector<Eigen::Isometry3d> X_RL = models::PosesInRoot(robot, gait.posture.joints);
  const auto side = [&](const models::GaitLimb& limb) {
    const models::ContactPatch& patch = robot.contacts[limb.contact];
    return (X_RL[patch.link] * patch.Centre()).y();
  };
  const models::GaitLimb* left = &gait.limbs[0];
  const models::GaitLimb* right = &gait.limbs[1];
  if (side(*left) < side(*right)) std::swap(left, right);
  draft.robot.contacts = {robot.contacts[left->contact], robot.contacts[right->contact]};
  draft.left_leg = left->joints;
  draft.right_leg = right->joints;
  draft.pairs = models::FindMirrorPairs(robot, kMirrored);
  draft.pairs_are_given = true;
  draft.rest = gait.posture.joints;
  draft.sway = gait.parameters.sway;
  for (const auto* leg : {&draft.left_leg, &draft.right_leg}) {
    for (const int joint : *leg) (*draft.rest)[joint] = 0;
  }
  MeasureLegs(&draft);
  return draft;
}

}  // namespace possibility::actions
