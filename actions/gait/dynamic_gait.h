#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "actions/gait/foothold_plan.h"
#include "actions/gait/gait_motion.h"
#include "actions/gait/pace.h"
#include "actions/gait/quasi_static_gait.h"
#include "actions/gait/stepped_way.h"
#include "actions/motion/pattern_motion.h"
#include "actions/wholebody/nominal_stance.h"
#include "actions/wholebody/self_clearance.h"
#include "models/robot/robot_model.h"

namespace possibility::actions {

/// Time after which a flow rests, s. A robot with feedback of its joints alone strays a little at
/// every touchdown: by up to 0.05 m in 80 s of walking straight.
inline constexpr double kLongestFlow = 40;

/// A gait that flows: limbs swing in turn while the centre of mass falls from one support to the
/// next (pattern_motion.h), without a rest for kLongestFlow. Its pace is the quickest of a family
/// that keeps the robot's limits. Where no pace fits, the gait is quasi-static.
class DynamicGait final : public GaitMotion {
 public:
  /// With the paces of FitPaces. `stance` must outlive this.
  DynamicGait(const models::RobotModel& robot, const NominalStance& stance);
  /// With paces that were fitted before.
  DynamicGait(const models::RobotModel& robot, const NominalStance& stance,
              std::vector<Pace> paces);

  std::vector<Phase> Motion(const std::vector<PlanarPose>& strides, double knot_spacing,
                            const CancellationToken& cancellation) const override;
  bool Flows() const override { return !paces_.empty(); }
  std::vector<Phase> Flow(const std::vector<StanceLine>& lines, const FlowEnd& end,
                          double knot_spacing,
                          const CancellationToken& cancellation) const override;
  std::vector<std::vector<Phase>> Variants(const std::vector<PlanarPose>& strides,
                                           double knot_spacing,
                                           const CancellationToken& cancellation) const override;
  double ExpectedDuration(int strides) const override;
  double WayDuration(const models::GaitParameters& parameters, const PlanarPose& from,
                     const PlanarPose& to) const override;
  double DisplacementDuration(const models::GaitParameters& parameters,
                              const PlanarPose& displacement) const override;
  double RestTime() const override;

  /// From quick to slow; empty if none fits.
  const std::vector<Pace>& paces() const { return paces_; }

  /// Knots and margins of its motions.
  MotionSettings Settings() const;

  /// The motion at a pace. With `adapts`, steps that fail, and their neighbours, are slowed down up
  /// to half the speed; where that does not help, or links come too close to each other, steps
  /// aside and in turns become shorter, along that line only.
  /// @throws MotionError naming the limit it would exceed; Cancelled.
  std::vector<Phase> MotionAt(const Pace& pace, const std::vector<PlanarPose>& strides,
                              const MotionSettings& settings, bool adapts,
                              const CancellationToken& cancellation = {}) const;

 private:
  /// Of a displacement at the quickest pace, of which there must be one, s, if a turn costs this
  /// share of one on the spot.
  double DurationOf(const PlanarPose& displacement, double share_of_turn) const;
  /// Ways of about equal durations, of kLongestFlow at most, end to end.
  std::vector<std::vector<StanceLine>> Divided(const std::vector<StanceLine>& lines) const;
  /// Flow without a rest on the way.
  std::vector<Phase> FlowThrough(const std::vector<StanceLine>& lines, const FlowEnd& end,
                                 double knot_spacing, const CancellationToken& cancellation) const;
  /// The paces by the duration of the way, s, as long as no step has to be slowed down.
  std::vector<std::pair<double, const Pace*>> ByDuration(
      const std::vector<StanceLine>& lines) const;
  /// What a motion must keep, besides its pace.
  struct Demands {
    MotionSettings settings;
    FlowEnd end;
    SelfClearance self_clearance;
    double clearance = 0;  ///< m, between links
  };
  Demands DemandsOf(const MotionSettings& settings, const FlowEnd& end) const;
  std::vector<Phase> MotionAt(const Pace& pace, const std::vector<StanceLine>& lines,
                              const Demands& demands, bool adapts,
                              const CancellationToken& cancellation) const;
  std::vector<Phase> MotionOf(const Pace& pace, const SteppedWay& way, const Demands& demands,
                              const CancellationToken& cancellation) const;
  /// PatternSettings::shares: the more the farther limbs swing ahead.
  std::vector<double> SharesOf(const Pace& pace, const models::ContactSchedule& schedule) const;
  /// @throws CloseLinks if links come closer to each other than demanded.
  void RequireSelfClearance(const std::vector<Phase>& motion, const Demands& demands) const;

  const models::RobotModel* robot_;
  const NominalStance* stance_;
  QuasiStaticGait quasi_static_;
  std::vector<std::vector<int>> groups_;
  double reach_ = 0;  ///< m: of the farthest limb from the stance's origin, seen from above
  std::optional<Waist> waist_;
  std::vector<Pace> paces_;
};

}  // namespace possibility::actions
