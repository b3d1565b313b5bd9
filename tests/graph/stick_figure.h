#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "graph/action/action.h"
#include "graph/action/exploration_space.h"
#include "graph/action/random.h"

namespace possibility::graph::test {

inline Point MakePoint(double x, double z) {
  Point point(2);
  point << x, z;
  return point;
}

/// The room of Fig. 3: x and z of the stick figure's chest, 10 m x 1 m.
class Room : public ExplorationSpace {
 public:
  Point RandomSample(RandomGenerator* generator) const override {
    const double x = UniformReal(0, 10, generator);
    return MakePoint(x, UniformReal(0, 1, generator));
  }
  double Distance(const Point& a, const Point& b) const override { return (a - b).norm(); }
};

struct Interval {
  double low;
  double high;
  bool Overlaps(double a, double b) const {
    return std::max(a, b) >= low && std::min(a, b) <= high;
  }
};

/// Walking or crawling of the stick figure. Its chest stays within a band of heights and out of the
/// stretches of x that are blocked for it.
class BandAction : public HolonomicAction {
 public:
  BandAction(std::string name, Interval band, double transition_height,
             std::vector<Interval> blocked)
      : name_(std::move(name)),
        band_(band),
        transition_height_(transition_height),
        blocked_(std::move(blocked)) {}

  std::string name() const override { return name_; }

  Point ExtendTowards(const Point& v0, const Point& v1) const override {
    constexpr double kStep = 0.25;
    const double distance = (v1 - v0).norm();
    return distance <= kStep ? v1 : Point(v0 + (v1 - v0) * (kStep / distance));
  }

  bool CN(const Point& v) const override { return InBand(v) && Free(v[0], v[0]); }
  bool CN(const Edge& edge) const override {
    const bool transition = !InBand(edge.from) || !InBand(edge.to);
    return (transition ? edge.from[0] == edge.to[0] : true) && Free(edge.from[0], edge.to[0]);
  }
  bool CS(const Point& v) const override { return CN(v); }
  bool CS(const Edge& edge) const override { return CN(edge); }

  std::vector<Point> TransitionFrom(const Point& v) const override {
    constexpr double kLowest = 0.1;  // nobody can stand up with the chest on the ground
    if (!Free(v[0], v[0]) || v[1] < kLowest) {
      return {};
    }
    return {MakePoint(v[0], transition_height_)};
  }
  bool IsReversible() const override { return true; }
  double ExpectedDuration(const Edge& edge) const override { return (edge.to - edge.from).norm(); }
  std::unique_ptr<ConfirmationJob> SpawnConfirmationJob(const Edge&) const override {
    return nullptr;
  }
  Point Project(const Point& v) const override {
    return MakePoint(v[0], std::clamp(v[1], band_.low, band_.high));
  }

 protected:
  bool InBand(const Point& v) const { return v[1] >= band_.low && v[1] <= band_.high; }
  bool Free(double x0, double x1) const {
    return std::none_of(blocked_.begin(), blocked_.end(),
                        [&](const Interval& stretch) { return stretch.Overlaps(x0, x1); });
  }

 private:
  std::string name_;
  Interval band_;
  double transition_height_;
  std::vector<Interval> blocked_;
};

/// A bar hangs over x = 4..6, too low to walk under. Rubble lies on the ground over x = 2..2.5; it
/// can be stepped over but not crawled through.
inline std::shared_ptr<BandAction> MakeWalk() {
  return std::make_shared<BandAction>("walk", Interval{0.7, 1.0}, 0.85,
                                      std::vector<Interval>{{4, 6}});
}
inline std::shared_ptr<BandAction> MakeCrawl(bool closed = false) {
  std::vector<Interval> blocked = {{2, 2.5}};
  if (closed) {
    blocked.push_back({4.8, 5.0});
  }
  return std::make_shared<BandAction>("crawl", Interval{0.2, 0.4}, 0.3, blocked);
}

inline const Point& Start() {
  static const Point start = MakePoint(0.5, 0.85);
  return start;
}
inline const Point& Goal() {
  static const Point goal = MakePoint(9.5, 0.85);
  return goal;
}

}  // namespace possibility::graph::test
