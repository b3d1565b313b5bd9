#pragma once

#include <cstddef>
#include <map>
#include <set>
#include <vector>

#include "actions/gait/foothold_plan.h"
#include "actions/gait/rounded_way.h"
#include "actions/wholebody/nominal_stance.h"
#include "actions/wholebody/planar_pose.h"

namespace possibility::actions {

/// The steps along lines, end to end, and how they give way where they cannot be made. All limbs
/// meet where a line ends. If all lines are straight no limb cuts a corner: each swing stays inside
/// the swept volume of one straight way.
class SteppedWay {
 public:
  /// `stance` and `groups` must outlive this.
  /// @throws MotionError if there are no footholds.
  SteppedWay(const NominalStance& stance, const std::vector<std::vector<int>>& groups,
             const std::vector<StanceLine>& lines, const StepBounds& bounds);

  const PlanarPose& start() const { return lines_.front().stances.front(); }
  std::vector<Step> Steps() const;

  /// Slows down the step of an interval of the schedule (ScheduleOf), those alike, and the
  /// neighbours of all. False if the interval is unknown or its step is as slow as it may be.
  bool SlowDown(int interval);
  /// Shortens the steps aside and in turns near these intervals: on the whole of a straight line.
  /// False if none of them can be shortened.
  bool Shorten(const std::vector<int>& intervals);

 private:
  struct Line {
    explicit Line(const StanceLine& along) : stances(along), shortened(along.size() - 1) {}
    StanceLine stances;
    std::vector<int> shortened;  ///< times, by stride
    std::vector<Step> steps;
  };
  using Strides = std::set<std::size_t>;
  void Plan(Line* line) const;
  /// Of the step of an interval; -1 if there is none.
  int StepOf(int interval) const;
  /// Adds the strides near a step of all lines, by line.
  void AddStridesNear(int step, std::map<std::size_t, Strides>* strides) const;
  bool Shorten(const Strides& strides, Line* line) const;

  const NominalStance& stance_;
  const std::vector<std::vector<int>>& groups_;
  StepBounds bounds_;
  std::vector<Line> lines_;
};

}  // namespace possibility::actions
