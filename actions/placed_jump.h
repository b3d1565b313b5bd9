#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "actions/jump_solver.h"
#include "models/collision.h"
#include "models/environment.h"

namespace possibility::actions {

/// Where every link is during a solved jump, in the launch stance's frame.
class JumpPoses {
 public:
  /// Samples are no farther apart than this, s.
  static constexpr double kInterval = 0.005;

  JumpPoses(const models::RobotModel& robot, const SolvedJump& jump);

  struct Sample {
    double t = 0;  ///< s
    std::vector<Eigen::Isometry3d> X_SL;
  };
  const std::vector<Sample>& samples() const { return samples_; }

 private:
  std::vector<Sample> samples_;
};

/// What the whole robot hits when it jumps from a place; empty if nothing: "hits 'bar' with
/// Body_LSP at 1.3 s". Obstacles are kept at a distance; ground may be touched, and by links that
/// bear on it at all be entered by as much as the verifier lets pass.
/// `keep_going`: asked often, may be empty; once it says no the answer means nothing.
std::string FirstHit(const models::RobotModel& robot, const models::Environment& environment,
                     const models::CollisionChecker& checker, const JumpPoses& poses,
                     const Eigen::Isometry3d& X_WS, const std::function<bool()>& keep_going = {});

/// The same in a world of nothing but two floors, at the heights of launch and landing: what a jump
/// hits there it hits anywhere.
std::string FirstHitOnBareGround(const models::RobotModel& robot, const JumpModel& model,
                                 const SolvedJump& jump, const JumpPoses& poses);

}  // namespace possibility::actions
