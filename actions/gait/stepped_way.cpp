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

/// Strides are the same if they differ by less, m and rad.
constexpr double kSame = 1e-6;

/// Displacements are alike if they differ by less, m and rad; of either side.
constexpr double kAlike = 0.01;

/// Steps that fail, those alike, and the neighbours of all are slowed down by these factors, one
/// after the other: many miss a limit by little.
constexpr std::array<double, 5> kSlowness = {1, 1.06, 1.25, 1.5, 2};

/// Shares of the bounds of steps aside and in turns, one after the other: legs that come too close
/// to each other need shorter steps.
constexpr std::array<double, 3> kShares = {1, 0.75, 0.5};

/// Steps are not shorter if they end where they did, but for this, m and rad.
constexpr double kChange = 1e-3;

/// On a line that bends, strides of the way nearer than this to a step are shortened with it, m.
constexpr double kNear = 0.4;

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

/// Whether steps and their neighbours are alike: in a bend a step may fail that does not elsewhere.
bool AreAlike(const std::vector<PlanarPose>& displacements, int a, int b) {
  const int last = static_cast<int>(displacements.size()) - 1;
  for (const int by : {-1, 0, 1}) {
    const bool has = a + by >= 0 && a + by <= last;
    const bool has_other = b + by >= 0 && b + by <= last;
    if (has != has_other || (has && !AreAlike(displacements[a + by], displacements[b + by]))) {
      return false;
    }
  }
  return true;
}

double Difference(const PlanarPose& a, const PlanarPose& b) {
  return (a.position() - b.position()).norm() + std::abs(WrapAngle(a.yaw - b.yaw));
}

bool AreSame(const std::vector<Step>& a, const std::vector<Step>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Step& one, const Step& other) {
    return one.group == other.group && Difference(one.stance, other.stance) < kChange;
  });
}

/// The stride of a line that ends nearest to a stance.
std::size_t NearestStride(const StanceLine& line, const PlanarPose& stance) {
  std::size_t nearest = 0;
  for (std::size_t i = 1; i + 1 < line.size(); ++i) {
    if (Difference(line[i + 1], stance) < Difference(line[nearest + 1], stance)) nearest = i;
  }
  return nearest;
}

/// Whether two strides of a line are the same displacement of the stance, as on a straight line.
bool IsSameStride(const StanceLine& line, std::size_t a, std::size_t b) {
  const PlanarPose& from = line[a];
  const PlanarPose& to = line[a + 1];
  const PlanarPose by{line[b + 1].x - line[b].x, line[b + 1].y - line[b].y,
                      WrapAngle(line[b + 1].yaw - line[b].yaw)};
  return Difference({to.x - from.x, to.y - from.y, WrapAngle(to.yaw - from.yaw)}, by) < kSame;
}

}  // namespace

SteppedWay::SteppedWay(const NominalStance& stance, const std::vector<std::vector<int>>& groups,
                       const std::vector<StanceLine>& lines, const StepBounds& bounds)
    : stance_(stance), groups_(groups), bounds_(bounds) {
  for (const StanceLine& line : lines) {
    lines_.emplace_back(line);
    Plan(&lines_.back());
  }
}

void SteppedWay::Plan(Line* line) const {
  std::vector<double> shares;
  for (const int times : line->shortened) shares.push_back(kShares[times]);
  line->steps = PlanSteps(stance_, groups_, line->stances, bounds_, shares);
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

void SteppedWay::AddStridesNear(int step, std::map<std::size_t, Strides>* strides) const {
  std::size_t index = 0;
  for (; step >= static_cast<int>(lines_[index].steps.size()); ++index) {
    step -= static_cast<int>(lines_[index].steps.size());
  }
  const Line& line = lines_[index];
  const std::size_t nearest = NearestStride(line.stances, line.steps[step].stance);
  for (const int direction : {-1, 1}) {
    double distance = 0;
    for (std::size_t i = nearest; i < line.shortened.size(); i += direction) {
      distance += (line.stances[i + 1].position() - line.stances[i].position()).norm();
      const bool is_near = distance < kNear || IsSameStride(line.stances, i, nearest);
      if (!is_near) break;
      (*strides)[index].insert(i);
    }
  }
}

bool SteppedWay::SlowDown(int interval) {
  const int step = StepOf(interval);
  if (step < 0) return false;
  const std::vector<Step> steps = Steps();
  const int last = static_cast<int>(steps.size()) - 1;
  const double slowness = steps[step].slowness;
  const auto slower_still = std::upper_bound(kSlowness.begin(), kSlowness.end(), slowness);
  if (slower_still == kSlowness.end()) return false;
  const std::vector<PlanarPose> displacements = Displacements(steps, start());
  std::set<int> slower;
  for (int i = 0; i <= last; ++i) {
    if (steps[i].slowness != slowness || !AreAlike(displacements, i, step)) continue;
    slower.insert({std::max(0, i - 1), i, std::min(last, i + 1)});
  }
  int i = 0;
  for (Line& line : lines_) {
    for (Step& one : line.steps) {
      if (slower.contains(i++)) one.slowness = std::max(one.slowness, *slower_still);
    }
  }
  return true;
}

bool SteppedWay::Shorten(const std::vector<int>& intervals) {
  std::map<std::size_t, Strides> strides;
  for (const int interval : intervals) {
    const int step = StepOf(interval);
    if (step >= 0) AddStridesNear(step, &strides);
  }
  bool changed = false;
  for (const auto& [line, near] : strides) {
    if (Shorten(near, &lines_[line])) changed = true;
  }
  return changed;
}

bool SteppedWay::Shorten(const Strides& strides, Line* line) const {
  const std::vector<Step> before = line->steps;
  const auto can_be_shorter = [&](std::size_t stride) {
    return line->shortened[stride] + 1 < static_cast<int>(kShares.size());
  };
  while (std::any_of(strides.begin(), strides.end(), can_be_shorter)) {
    for (const std::size_t stride : strides) {
      if (can_be_shorter(stride)) ++line->shortened[stride];
    }
    Plan(line);
    if (!AreSame(line->steps, before)) return true;
  }
  return false;
}

}  // namespace possibility::actions
