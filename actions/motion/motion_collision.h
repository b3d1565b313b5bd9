#pragma once

#include <functional>
#include <string>
#include <vector>

#include "actions/plan/plan.h"
#include "models/robot/robot_model.h"
#include "models/world/collision.h"
#include "models/world/environment.h"

namespace possibility::actions {

/// Where every link is during a motion, in the frame that the motion is given in.
class MotionPoses {
 public:
  /// Samples are no farther apart than this, s.
  static constexpr double kInterval = 0.005;

  MotionPoses(const models::RobotModel& robot, const std::vector<Phase>& motion);

  struct Sample {
    double t = 0;  ///< s
    std::vector<Eigen::Isometry3d> X_SL;
  };
  const std::vector<Sample>& samples() const { return samples_; }

 private:
  std::vector<Sample> samples_;
};

/// What the whole robot hits when it moves so from a place (S at X_WS); empty if nothing: "hits
/// 'bar' with Body_LSP at 1.30 s". Obstacles are kept at a distance; ground may be touched, and by
/// links that bear on it at all be entered by as much as the verifier lets pass.
/// `keep_going`: asked often, may be empty; once it says no the answer means nothing.
std::string FirstHit(const models::RobotModel& robot, const models::Environment& environment,
                     const models::CollisionChecker& checker, const MotionPoses& poses,
                     const Eigen::Isometry3d& X_WS, const std::function<bool()>& keep_going = {});

/// Which of its own links the robot hits; empty if none: "hits Body_LSP with Body_RSP at 1.30 s".
std::string FirstSelfHit(const models::RobotModel& robot, const models::CollisionChecker& checker,
                         const MotionPoses& poses, const std::function<bool()>& keep_going = {});

}  // namespace possibility::actions
