#include "actions/gait/stepped_way.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "actions/wholebody/motion_error.h"
#include "actions/wholebody/whole_body_task.h"

namespace possibility::actions {
namespace {

/// Ways differ if a stride moves or turns the stance by more, m and rad.
constexpr double kBend = 1e-6;

/// Steps are alike if their displacements differ by less, m and rad; of either side.
constexpr double kAlike = 0.01;

/// Steps that fail, those alike, and the neighbours of all are slowed down by this factor at a
/// time, and by the most in all.
constexpr double kSlower = 1.25;
constexpr double kSlowest = 2;

/// Shares of the bounds of steps aside and in turns, one after the other: legs that come too close
/// to each other need shorter steps.
constexpr std::array<double, 3> kShares = {1, 0.75, 0.5};

/// Where each step takes its group, seen from the group's place before. `start`: of all groups.
std::vector<PlanarPose> Displacements(const std::vector<Step>& steps, const PlanarPose& start) {
  std::map<int, PlanarPose> places;
  std::vector<PlanarPose> displacements;
  for (const Step& step : steps) {
    const PlanarPose from = places.contains(step.group) ? places[step.group] : start;
    displacements.push_back(from.Inverse() * step.stance);
    places[step.group] = step.stance;
  }
  return displacements;
}

bool AreAlike(const PlanarPose& a, const PlanarPose& b) {
  return std::abs(a.x - b.x) < kAlike && std::abs(std::abs(a.y) - std::abs(b.y)) < kAlike &&
         std::abs(std::abs(a.yaw) - std::abs(b.yaw)) < kAlike;
}

}  // namespace

bool Bends(const PlanarPose& a, const PlanarPose& b, const PlanarPose& c) {
  const Eigen::Vector2d before = b.position() - a.position();
  const Eigen::Vector2d after = c.position() - b.position();
  const double turn = WrapAngle(c.yaw - b.yaw) - WrapAngle(b.yaw - a.yaw);
  return (after - before).norm() > kBend || std::abs(turn) > kBend;
}

SteppedWay::SteppedWay(const NominalStance& stance, const std::vector<std::vector<int>>& groups,
                       const std::vector<PlanarPose>& strides, const StepBounds& bounds)
    : stance_(stance), groups_(groups), bounds_(bounds) {
  Line line;
  for (std::size_t i = 0; i < strides.size(); ++i) {
    line.strides.push_back(strides[i]);
    const bool is_end =
        i + 1 == strides.size() || (i > 0 && Bends(strides[i - 1], strides[i], strides[i + 1]));
    if (!is_end || line.strides.size() < 2) continue;
    Plan(&line);
    lines_.push_back(line);
    line.strides = {strides[i]};
  }
  if (lines_.empty()) throw MotionError("no footholds along the way");
}

void SteppedWay::Plan(Line* line) const {
  StepBounds bounds = bounds_;
  bounds.lateral *= kShares[line->shortened];
  bounds.turn *= kShares[line->shortened];
  line->steps = PlanSteps(stance_, groups_, line->strides, bounds);
  if (line->steps.empty()) throw MotionError("no footholds along the way");
}

std::vector<Step> SteppedWay::Steps() const {
  std::vector<Step> steps;
  for (const Line& line : lines_) steps.insert(steps.end(), line.steps.begin(), line.steps.end());
  return steps;
}

int SteppedWay::StepOf(int interval) const {
  if (interval < 0) return -1;
  std::size_t count = 0;
  for (const Line& line : lines_) count += line.steps.size();
  return std::clamp((interval - 1) / 2, 0, static_cast<int>(count) - 1);
}

int SteppedWay::LineOf(int step) const {
  int line = 0;
  for (; step >= static_cast<int>(lines_[line].steps.size()); ++line) {
    step -= static_cast<int>(lines_[line].steps.size());
  }
  return line;
}

bool SteppedWay::SlowDown(int interval) {
  const int step = StepOf(interval);
  if (step < 0) return false;
  const std::vector<Step> steps = Steps();
  const int last = static_cast<int>(steps.size()) - 1;
  const double slowness = steps[step].slowness;
  if (kSlower * slowness > kSlowest) return false;
  const std::vector<PlanarPose> displacements = Displacements(steps, start());
  std::set<int> slower;
  for (int i = 0; i <= last; ++i) {
    if (steps[i].slowness != slowness || !AreAlike(displacements[i], displacements[step])) continue;
    slower.insert({std::max(0, i - 1), i, std::min(last, i + 1)});
  }
  int i = 0;
  for (Line& line : lines_) {
    for (Step& one : line.steps) {
      if (slower.contains(i++)) one.slowness *= kSlower;
    }
  }
  return true;
}

bool SteppedWay::Shorten(const std::vector<int>& intervals) {
  std::set<int> lines;
  for (const int interval : intervals) {
    const int step = StepOf(interval);
    if (step >= 0) lines.insert(LineOf(step));
  }
  bool changed = false;
  for (const int line : lines) {
    if (Shorten(&lines_[line])) changed = true;
  }
  return changed;
}

bool SteppedWay::Shorten(Line* line) const {
  const std::size_t before = line->steps.size();
  while (line->shortened + 1 < static_cast<int>(kShares.size())) {
    ++line->shortened;
    Plan(line);
    if (line->steps.size() > before) return true;
  }
  return false;
}

}  // namespace possibility::actions
