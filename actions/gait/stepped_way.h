#pragma once

#include <vector>

#include "actions/gait/foothold_plan.h"
#include "actions/wholebody/nominal_stance.h"
#include "actions/wholebody/planar_pose.h"

namespace possibility::actions {

/// Whether a way bends between two strides.
bool Bends(const PlanarPose& a, const PlanarPose& b, const PlanarPose& c);

/// The steps along straight ways, end to end, and how they give way where they cannot be made. All
/// limbs meet in every bend, so that no limb cuts a corner: each swing stays inside the swept
/// volume of one straight way.
class SteppedWay {
 public:
  /// `strides`: of PlanStrides for each way, their common stances once. `stance` and `groups` must
  /// outlive this.
  /// @throws MotionError if there are no footholds.
  SteppedWay(const NominalStance& stance, const std::vector<std::vector<int>>& groups,
             const std::vector<PlanarPose>& strides, const StepBounds& bounds);

  const PlanarPose& start() const { return lines_.front().strides.front(); }
  std::vector<Step> Steps() const;

  /// Slows down the step of an interval of the schedule (ScheduleOf), those alike, and the
  /// neighbours of all. False if the interval is unknown or its step is as slow as it may be.
  bool SlowDown(int interval);
  /// Shortens the steps aside and in turns of the straight ways that have these intervals. False
  /// if none of them can be shortened.
  bool Shorten(const std::vector<int>& intervals);

 private:
  /// A straight way.
  struct Line {
    std::vector<PlanarPose> strides;
    int shortened = 0;  ///< times
    std::vector<Step> steps;
  };
  void Plan(Line* line) const;
  /// Of the step of an interval; -1 if there is none.
  int StepOf(int interval) const;
  int LineOf(int step) const;
  bool Shorten(Line* line) const;

  const NominalStance& stance_;
  const std::vector<std::vector<int>>& groups_;
  StepBounds bounds_;
  std::vector<Line> lines_;
};

}  // namespace possibility::actions
