#include "experiments/report/plan_speeds.h"

#include <algorithm>

namespace possibility::experiments {
namespace {

/// Speeds are of actions that lead farther, m.
constexpr double kSomewhere = 0.01;

struct Way {
  std::string action;
  double length = 0;    ///< m
  double duration = 0;  ///< s
};

Way WayOf(const actions::Segment& segment) {
  if (segment.phases.empty()) return {segment.action, 0, 0};
  const actions::Knot& first = segment.phases.front().knots.front();
  const actions::Knot& last = segment.phases.back().knots.back();
  return {segment.action, (last.q - first.q).segment<2>(4).norm(), last.t - first.t};
}

}  // namespace

double PlanarLength(const actions::Plan& plan) {
  double length = 0;
  for (const actions::Segment& segment : plan.segments) length += WayOf(segment).length;
  return length;
}

std::vector<std::pair<std::string, double>> SpeedsByAction(const actions::Plan& plan) {
  std::vector<Way> ways;
  for (const actions::Segment& segment : plan.segments) {
    const Way way = WayOf(segment);
    auto known = std::find_if(ways.begin(), ways.end(),
                              [&](const Way& other) { return other.action == way.action; });
    if (known == ways.end()) known = ways.insert(ways.end(), {way.action, 0, 0});
    known->length += way.length;
    known->duration += way.duration;
  }
  std::vector<std::pair<std::string, double>> speeds;
  for (const Way& way : ways) {
    if (way.length > kSomewhere) speeds.emplace_back(way.action, way.length / way.duration);
  }
  return speeds;
}

}  // namespace possibility::experiments
