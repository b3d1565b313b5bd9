#pragma once

#include <string>
#include <vector>

#include "actions/plan/plan.h"
#include "common/cancellation_token.h"
#include "models/robot/robot_model.h"
#include "models/world/collision.h"
#include "models/world/environment.h"

namespace possibility::actions {

/// Sampled link poses of a motion, in the motion's frame. Stored for motions that are executed from
/// many places.
class MotionPoses {
 public:
  MotionPoses(const models::RobotModel& robot, const std::vector<Phase>& motion);

  struct Sample {
    double t = 0;  ///< s
    std::vector<Eigen::Isometry3d> X_SL;
  };
  const std::vector<Sample>& samples() const { return samples_; }

 private:
  std::vector<Sample> samples_;
};

/// The first hit of the whole robot when it executes the motion from a place (S at X_WS): "hits
/// 'bar' with Body_LSP at 1.30 s"; empty if none. Requires a clearance from obstacles. Ground may
/// be touched; links that ever bear on ground may enter it by the verifier's tolerance.
/// Once cancelled, the answer is meaningless.
std::string FirstHit(const models::RobotModel& robot, const models::Environment& environment,
                     const models::CollisionChecker& checker, const MotionPoses& poses,
                     const Eigen::Isometry3d& X_WS, const CancellationToken& cancellation = {});

/// The same for a motion in the world.
std::string FirstHit(const models::RobotModel& robot, const models::Environment& environment,
                     const models::CollisionChecker& checker, const std::vector<Phase>& motion,
                     const CancellationToken& cancellation = {});

/// The first hit of a rough motion, of which only the knots' times and configurations count, in the
/// world. `roughness`: how far the links may really be from where it has them, m. So a motion may
/// hit something that its rough one does not, but hardly the other way round.
std::string FirstRoughHit(const models::RobotModel& robot, const models::Environment& environment,
                          const models::CollisionChecker& checker, const std::vector<Phase>& rough,
                          double roughness, const CancellationToken& cancellation = {});

/// The first self-collision: "hits Body_LSP with Body_RSP at 1.30 s"; empty if none.
std::string FirstSelfHit(const models::RobotModel& robot, const models::CollisionChecker& checker,
                         const std::vector<Phase>& motion,
                         const CancellationToken& cancellation = {});

}  // namespace possibility::actions
