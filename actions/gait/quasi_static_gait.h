#pragma once

#include <vector>

#include "actions/gait/gait_motion.h"
#include "actions/wholebody/nominal_stance.h"
#include "actions/wholebody/planar_pose.h"
#include "models/robot/robot_model.h"

namespace possibility::actions {

/// A quasi-static gait. In every stride each limb swings once from one stance to the next, one limb
/// at a time, while the others bear. Between swings the centre of mass shifts over the limbs that
/// bear next. The robot is at rest between phases.
class QuasiStaticGait final : public GaitMotion {
 public:
  QuasiStaticGait(const models::RobotModel& robot, const NominalStance& stance);

  /// Durations are stretched if the motion would break a limit otherwise.
  std::vector<Phase> Motion(const std::vector<PlanarPose>& strides, double knot_spacing,
                            const CancellationToken& cancellation) const override;

  /// From rest in the nominal posture at strides.front() to rest in it at strides.back(), on
  /// ground of height z. `time_scale` >= 1 stretches all durations.
  std::vector<MotionPhase> Phases(const std::vector<PlanarPose>& strides, double z,
                                  double time_scale) const;

  /// Rests in the nominal posture at `stance` for `duration` s.
  MotionPhase Standing(const PlanarPose& stance, double z, double duration) const;

  /// Expected duration of a motion of `strides` strides, s, as if they led straight ahead. Sideways
  /// and turning strides differ by up to a tenth.
  double ExpectedDuration(int strides) const override;

 private:
  struct Progress;
  struct Balance {
    Eigen::Vector2d centre_of_mass;  ///< m
    double roll = 0;                 ///< rad, of the root
  };
  double DurationOfStridesAhead(int count) const;
  Progress AtRest(const PlanarPose& stance, double z) const;
  /// The gait's cycle from its start or from half-way: the one whose first swing ends farther from
  /// the standing limbs, so that feet part before they close.
  std::vector<int> SwingOrder(const PlanarPose& a, const PlanarPose& b) const;
  double ClearanceAfterSwing(int limb, const PlanarPose& a, const PlanarPose& b) const;
  std::vector<Eigen::Vector2d> Placed(int limb, const PlanarPose& at) const;
  Eigen::Vector2d SupportedCentreOfMass(const Progress& progress, int swinging,
                                        const PlanarPose& reference) const;
  /// Roll of the root over the limbs that bear while `swinging` swings, rad: GaitParameters::sway.
  double RollFor(const Progress& progress, int swinging, const PlanarPose& reference) const;
  void AppendShift(const Balance& target, bool is_end, Progress* progress,
                   std::vector<MotionPhase>* phases) const;
  void AppendSwing(int limb, const PlanarPose& to, double root_yaw, Progress* progress,
                   std::vector<MotionPhase>* phases) const;
  WholeBodyTask StandingTask(const Progress& progress) const;
  LimbTask StandingLimb(int limb, const PlanarPose& at, double z) const;

  const models::RobotModel* robot_;
  const NominalStance* stance_;
  double stride_time_ = 0;  ///< s, of each additional stride
  double stop_time_ = 0;    ///< s, of the last shift
};

}  // namespace possibility::actions
