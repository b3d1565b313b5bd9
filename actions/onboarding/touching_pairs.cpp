#include "actions/onboarding/touching_pairs.h"

#include <algorithm>
#include <map>
#include <random>
#include <utility>

#include "models/facts/zero_poses.h"
#include "models/world/collision.h"

namespace possibility::actions {
namespace {

constexpr int kPostureSamples = 60;
constexpr double kNearLinks = 0.01;     // m
constexpr double kPostureSpread = 0.6;  // rad, about the standing posture
constexpr int kFewJoints = 3;           // between two links

/// Joints on the way from one link to the other.
int JointsBetween(const models::RobotModel& robot, int a, int b) {
  int count = 0;
  while (a != b) {
    // Links are numbered from the root outwards.
    int& deeper = a > b ? a : b;
    deeper = robot.joints[deeper - 1].parent;
    ++count;
  }
  return count;
}

}  // namespace

std::vector<IgnoredPair> TouchingPairs(const RobotDraft& draft, const Eigen::VectorXd& joints) {
  const models::RobotModel& robot = draft.robot;
  const models::CollisionChecker checker(robot, models::Environment());
  std::map<std::pair<int, int>, std::string> found;
  for (const models::Proximity& pair :
       checker.SelfProximities(models::PosesInRoot(robot, joints), 1e-3)) {
    found[{pair.link, pair.other}] = "their hulls touch where the robot stands";
  }
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-kPostureSpread, kPostureSpread);
  for (int i = 0; i < kPostureSamples; ++i) {
    Eigen::VectorXd sample = joints;
    for (int j = 0; j < robot.num_joints(); ++j) {
      sample[j] =
          std::clamp(sample[j] + uniform(random), robot.joints[j].lower, robot.joints[j].upper);
    }
    for (const models::Proximity& pair :
         checker.SelfProximities(models::PosesInRoot(robot, sample), kNearLinks)) {
      if (JointsBetween(robot, pair.link, pair.other) > kFewJoints) continue;
      found.try_emplace({pair.link, pair.other},
                        "sampled: around few joints, whose limits keep the parts apart");
    }
  }
  std::vector<IgnoredPair> pairs;
  for (const auto& [links, reason] : found) pairs.push_back({links.first, links.second, reason});
  return pairs;
}

}  // namespace possibility::actions
