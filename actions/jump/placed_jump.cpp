#include "actions/jump/placed_jump.h"

#include <algorithm>

namespace possibility::actions {

std::string FirstHitOnBareGround(const models::RobotModel& robot, const SagittalModel& model,
                                 const SolvedJump& jump, const MotionPoses& poses) {
  constexpr double kVast = 20;  // m
  // No floor in between, where the two would overlap.
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
