#include "actions/placed_jump.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "dynamics/tree_kinematics.h"

namespace possibility::actions {
namespace {

/// The motion goes on between samples; what it comes closer to than this is taken for hit, m.
constexpr double kClearance = 0.01;
/// The verifier's: links that bear against ground, and all others against anything, m.
constexpr double kGroundTolerance = 1e-3;
constexpr double kTolerance = 1e-4;

std::vector<bool> LinksThatBear(const models::RobotModel& robot) {
  std::vector<bool> bear(robot.links.size(), false);
  for (const models::ContactPatch& patch : robot.contacts) bear[patch.link] = true;
  return bear;
}

}  // namespace

JumpPoses::JumpPoses(const models::RobotModel& robot, const SolvedJump& jump) {
  dynamics::TreeKinematics kinematics(robot);
  const auto add = [&](const Knot& knot) {
    kinematics.SetPosition(knot.q);
    samples_.push_back({knot.t, kinematics.X_WL()});
  };
  for (const Phase& phase : jump.phases) {
    for (size_t i = 0; i + 1 < phase.knots.size(); ++i) {
      const Knot& from = phase.knots[i];
      const Knot& to = phase.knots[i + 1];
      const int parts = std::max(1, static_cast<int>(std::ceil((to.t - from.t) / kInterval)));
      for (int part = 0; part < parts; ++part) {
        add(Interpolate(from, to, from.t + (to.t - from.t) * part / parts));
      }
    }
    add(phase.knots.back());
  }
}

std::string FirstHit(const models::RobotModel& robot, const models::Environment& environment,
                     const models::CollisionChecker& checker, const JumpPoses& poses,
                     const Eigen::Isometry3d& X_WS, const std::function<bool()>& keep_going) {
  const std::vector<bool> bears = LinksThatBear(robot);
  std::vector<Eigen::Isometry3d> X_WL(robot.links.size());
  for (const JumpPoses::Sample& sample : poses.samples()) {
    if (keep_going && !keep_going()) return {};
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

std::string FirstHitOnBareGround(const models::RobotModel& robot, const JumpModel& model,
                                 const SolvedJump& jump, const JumpPoses& poses) {
  constexpr double kVast = 20;  // m
  // No floor in between, where the two would be on top of each other.
  const double launch_end = model.Position(model.toe(), model.ready()).x();
  double landing_begin = model.Position(model.heel(), model.landed()).x();
  for (const dynamics::ContactPoint& hand : model.hands()) {
    landing_begin = std::min(landing_begin, model.Position(hand, model.landed()).x());
  }
  const auto floor = [=](const std::string& name, double x, double height) {
    models::Obstacle obstacle;
    obstacle.name = name;
    obstacle.shape = models::Shape::Box({kVast, kVast, 1});
    obstacle.X_WO.translation() << x, 0, height - 0.5;
    obstacle.is_ground = true;
    return obstacle;
  };
  models::Environment environment;
  environment.obstacles = {
      floor("launch ground", launch_end - kVast / 2, 0),
      floor("landing ground", std::max(launch_end, jump.task.distance + landing_begin) + kVast / 2,
            jump.task.height)};
  const models::CollisionChecker checker(robot, environment);
  return FirstHit(robot, environment, checker, poses, Eigen::Isometry3d::Identity());
}

}  // namespace possibility::actions
