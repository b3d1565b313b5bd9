#include "actions/motion/motion_collision.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "actions/plan/interpolation.h"
#include "dynamics/tree/tree_kinematics.h"

namespace possibility::actions {
namespace {

/// Distances below this count as hits, because the robot moves between samples, m.
constexpr double kClearance = 0.01;
/// Tolerances of the verifier: bearing links against ground, and all other pairs, m.
constexpr double kGroundTolerance = 1e-3;
constexpr double kTolerance = 1e-4;

/// Samples between questions to the token: a millisecond or less.
constexpr size_t kSamplesPerQuestion = 16;

bool GoOn(size_t sample, const CancellationToken& cancellation) {
  return sample % kSamplesPerQuestion != 0 || cancellation.Proceed();
}

std::vector<bool> LinksThatBear(const models::RobotModel& robot) {
  std::vector<bool> bear(robot.links.size(), false);
  for (const models::ContactPatch& patch : robot.contacts) bear[patch.link] = true;
  return bear;
}

}  // namespace

MotionPoses::MotionPoses(const models::RobotModel& robot, const std::vector<Phase>& motion) {
  dynamics::TreeKinematics kinematics(robot);
  const auto add = [&](double t, const Eigen::VectorXd& q) {
    kinematics.SetPosition(q);
    samples_.push_back({t, kinematics.X_WL()});
  };
  for (const Phase& phase : motion) {
    if (phase.knots.empty()) continue;
    for (size_t i = 0; i + 1 < phase.knots.size(); ++i) {
      const Knot& from = phase.knots[i];
      const Knot& to = phase.knots[i + 1];
      add(from.t, from.q);
      const int parts = std::max(1, static_cast<int>(std::ceil((to.t - from.t) / kInterval)));
      if (parts == 1) continue;
      const KnotInterpolant between(from, to);
      for (int part = 1; part < parts; ++part) {
        const double t = from.t + (to.t - from.t) * part / parts;
        add(t, between.ConfigurationAt(t));
      }
    }
    add(phase.knots.back().t, phase.knots.back().q);
  }
}

std::string FirstHit(const models::RobotModel& robot, const models::Environment& environment,
                     const models::CollisionChecker& checker, const MotionPoses& poses,
                     const Eigen::Isometry3d& X_WS, const CancellationToken& cancellation) {
  const std::vector<bool> bears = LinksThatBear(robot);
  std::vector<Eigen::Isometry3d> X_WL(robot.links.size());
  for (size_t i = 0; i < poses.samples().size(); ++i) {
    const MotionPoses::Sample& sample = poses.samples()[i];
    if (!GoOn(i, cancellation)) return {};
    for (size_t link = 0; link < X_WL.size(); ++link) X_WL[link] = X_WS * sample.X_SL[link];
    for (const models::Proximity& pair : checker.EnvironmentProximities(X_WL, kClearance)) {
      const models::Obstacle& obstacle = environment.obstacles[pair.other];
      const double allowed = !obstacle.is_ground ? kClearance
                             : bears[pair.link]  ? -kGroundTolerance
                                                 : -kTolerance;
      if (pair.distance >= allowed) continue;
      return fmt::format("hits '{}' with {} at {:.2f} s", obstacle.name,
                         robot.links[pair.link].name, sample.t);
    }
  }
  return {};
}

std::string FirstSelfHit(const models::RobotModel& robot, const models::CollisionChecker& checker,
                         const MotionPoses& poses, const CancellationToken& cancellation) {
  for (size_t i = 0; i < poses.samples().size(); ++i) {
    const MotionPoses::Sample& sample = poses.samples()[i];
    if (!GoOn(i, cancellation)) return {};
    const std::vector<models::Proximity> close = checker.SelfProximities(sample.X_SL, 0);
    if (close.empty()) continue;
    return fmt::format("hits {} with {} at {:.2f} s", robot.links[close.front().other].name,
                       robot.links[close.front().link].name, sample.t);
  }
  return {};
}

}  // namespace possibility::actions
