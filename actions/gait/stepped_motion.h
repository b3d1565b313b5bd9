#pragma once

#include <vector>

#include "actions/gait/quasi_static_gait.h"
#include "actions/plan/plan.h"
#include "actions/wholebody/motion_builder.h"
#include "actions/wholebody/nominal_stance.h"
#include "actions/wholebody/planar_pose.h"
#include "common/cancellation_token.h"
#include "models/robot/robot_model.h"

namespace possibility::actions {

/// How the body is held over one bearing limb, beside the nominal posture on that limb's ground.
struct BodyShift {
  int over = 0;      ///< limb that carries the centre of mass
  double lift = 0;   ///< m, of the root
  double lean = 0;   ///< rad, pitch of the root, forward positive
  double ahead = 0;  ///< m, of the centre of mass, which keeps its margin in the limb's patch
};

/// A limb's swing: up, across and down.
struct SteppedSwing {
  double ahead = 0;         ///< m
  double rise = 0;          ///< m, of the new ground above the one that it leaves
  double clearance = 0.03;  ///< m, above the new ground while it crosses
  double lift_time = 0.8;   ///< s; downwards takes half of it
  double cross_time = 0.8;  ///< s
};

/// A quasi-static motion that is put together step by step, for limbs that bear on ground of
/// different heights. It begins at rest in the nominal stance at the origin, on ground at z = 0.
/// Every phase leads from rest to rest. Heights and lengths are in the frame of the stance that the
/// last strides ended in.
class SteppedMotion {
 public:
  /// Both must outlive this. `time_scale` stretches all durations.
  SteppedMotion(const models::RobotModel& robot, const NominalStance& stance,
                double time_scale = 1);

  /// Walks straight ahead with the gait's strides. Before any other phase.
  SteppedMotion& Walk(double distance);
  /// Shifts the body while all limbs bear.
  SteppedMotion& Shift(const BodyShift& to, double duration);
  /// Swings a limb while the others bear. The body shifts while the limb crosses.
  SteppedMotion& Swing(int limb, const SteppedSwing& swing, const BodyShift& to);
  /// Shifts the body to the nominal posture over where the limbs stand now.
  SteppedMotion& Rest(double duration);

  double duration() const;  ///< s, so far

  /// @throws MotionError naming the limit that the robot would break; Cancelled.
  std::vector<Phase> Build(const CancellationToken& cancellation = {}) const;

 private:
  /// The robot at rest.
  struct State {
    PlanarPose stance;                  ///< where the last strides ended
    std::vector<Eigen::Vector3d> feet;  ///< centres of the patches, by limb
    Eigen::Vector2d centre_of_mass;
    double root_height = 0;
    double lean = 0;
  };
  double GroundOf(int limb) const;
  void Hold(const BodyShift& shift, State* state) const;
  WholeBodyTask TaskOf(const State& state) const;
  void Append(const State& to, double duration, int swinging);

  const models::RobotModel* robot_;
  const NominalStance* nominal_;
  QuasiStaticGait walking_;
  double time_scale_;
  State state_;
  std::vector<MotionPhase> phases_;
};

}  // namespace possibility::actions
