#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "actions/gait/rounded_way.h"
#include "actions/gait/stride.h"
#include "actions/plan/plan.h"
#include "actions/wholebody/motion_builder.h"
#include "actions/wholebody/motion_error.h"
#include "actions/wholebody/nominal_stance.h"
#include "actions/wholebody/planar_pose.h"
#include "common/cancellation_token.h"
#include "models/robot/robot_model.h"

namespace possibility::actions {

/// How a flow ends at rest, if not in the nominal stance: so that a manoeuvre can follow without a
/// pause.
struct FlowEnd {
  /// num_joints; those of limbs as in the nominal stance. Empty: that stance.
  Eigen::VectorXd joints;
  double turning_time = 1;  ///< s before the end, in which the joints turn; less in a shorter flow
};

/// How a gait executes strides: what distinguishes two gaits of one nominal stance. Immutable, used
/// from several threads at once.
class GaitMotion {
 public:
  virtual ~GaitMotion() = default;

  /// The whole robot's motion from rest in the nominal stance at strides.front() to rest in it at
  /// strides.back(), on ground of height 0, times from 0. `strides`: at least two stances, as of
  /// PlanStrides. `knot_spacing`: s, at most. `cancellation` is to be asked every few
  /// milliseconds. Deterministic.
  /// @throws MotionError if there is no motion; Cancelled.
  virtual std::vector<Phase> Motion(const std::vector<PlanarPose>& strides, double knot_spacing,
                                    const CancellationToken& cancellation) const = 0;

  /// Whether Flow may succeed.
  virtual bool Flows() const { return false; }

  /// Motion along several lines (rounded_way.h), end to end, without a rest where they meet. All
  /// limbs meet there. `end`: how it ends. Otherwise as Motion.
  virtual std::vector<Phase> Flow(const std::vector<StanceLine>& /*lines*/, const FlowEnd& /*end*/,
                                  double /*knot_spacing*/,
                                  const CancellationToken& /*cancellation*/) const {
    throw MotionError("the gait rests where straight ways meet");
  }

  /// All motions along `strides` that Motion may return, now or for strides that are part of a
  /// longer way; for swept volumes. Arguments and errors: as of Motion.
  virtual std::vector<std::vector<Phase>> Variants(const std::vector<PlanarPose>& strides,
                                                   double knot_spacing,
                                                   const CancellationToken& cancellation) const {
    return {Motion(strides, knot_spacing, cancellation)};
  }

  /// Expected duration of a motion of `strides` strides straight ahead, s; 0 for none.
  /// A gait that flows begins and ends it in motion.
  virtual double ExpectedDuration(int strides) const = 0;

  /// The same of the motion along PlanStrides from `from` to `to`. `parameters`: of the gait.
  virtual double WayDuration(const models::GaitParameters& parameters, const PlanarPose& from,
                             const PlanarPose& to) const {
    return ExpectedDuration(StrideCount(parameters, from, to));
  }

  /// The share of a displacement in it, s. `parameters`: of the gait.
  virtual double DisplacementDuration(const models::GaitParameters& parameters,
                                      const PlanarPose& displacement) const {
    return StrideEffort(parameters, displacement) * (ExpectedDuration(2) - ExpectedDuration(1));
  }

  /// Expected duration of getting into motion, or to rest, between a gait that flows and something
  /// else, s.
  virtual double RestTime() const { return 0; }
};

/// Expected duration per metre in the gait's quickest direction, s/m.
inline double LeastSecondsPerMetre(const GaitMotion& motion,
                                   const models::GaitParameters& parameters) {
  return std::min(motion.DisplacementDuration(parameters, {1, 0, 0}),
                  motion.DisplacementDuration(parameters, {0, 1, 0}));
}

/// Frame of the swept volume of the stride from a to b.
inline PlanarPose StrideFrame(const PlanarPose& a, const PlanarPose& b) {
  return Interpolate(a, b, 0.5);
}

/// A gait in addition to those of the robot's file: another way to execute strides from the nominal
/// stance of one of them. The robot changes between gaits of one stance while it stands.
struct GaitFactory {
  std::string name;                   ///< used in scenarios and requests
  std::string stance_of;              ///< gait of the robot's file
  models::GaitParameters parameters;  ///< bounds of a stride: forward, lateral, turn
  /// `stance` outlives the motion; `stance.gait` has the name and the parameters above.
  std::function<std::unique_ptr<GaitMotion>(const models::RobotModel&, const NominalStance& stance)>
      make;
};

}  // namespace possibility::actions
