#include "experiments/report/plan_speeds.h"

#include <algorithm>

namespace possibility::experiments {
namespace {

/// Actions that lead somewhere lead farther, m.
constexpr double kSomewhere = 0.01;

ActionWay WayOf(const actions::Segment& segment) {
  if (segment.phases.empty()) return {segment.action, 0, 0};
  const actions::Knot& first = segment.phases.front().knots.front();
  const actions::Knot& last = segment.phases.back().knots.back();
  return {segment.action, (last.q - first.q).segment<2>(4).norm(), last.t - first.t};
}

}  // namespace

std::vector<ActionWay> WaysByAction(const actions::Plan& plan) {
  std::vector<ActionWay> ways;
  for (const actions::Segment& segment : plan.segments) {
    const ActionWay way = WayOf(segment);
    auto known = std::find_if(ways.begin(), ways.end(),
                              [&](const ActionWay& other) { return other.action == way.action; });
    if (known == ways.end()) known = ways.insert(ways.end(), {way.action, 0, 0});
    known->length += way.length;
    known->duration += way.duration;
  }
  std::erase_if(ways, [](const ActionWay& way) { return way.length <= kSomewhere; });
  return ways;
}

double PlanarLength(const actions::Plan& plan) {
  double length = 0;
  for (const actions::Segment& segment : plan.segments) length += WayOf(segment).length;
  return length;
}

std::vector<std::pair<std::string, double>> SpeedsByAction(const actions::Plan& plan) {
  std::vector<std::pair<std::string, double>> speeds;
  for (const ActionWay& way : WaysByAction(plan)) {
    speeds.emplace_back(way.action, way.length / way.duration);
  }
  return speeds;
}

}  // namespace possibility::experiments
