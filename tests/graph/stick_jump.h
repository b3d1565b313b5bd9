#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "graph/action/action.h"
#include "tests/graph/stick_figure.h"

namespace possibility::graph::test {

/// The stick figure jumps from standing upright to its nominal crawl, at most `reach` far, over
/// whatever lies between. A job has to find out whether it really gets that far.
class JumpAction : public NonholonomicAction {
 public:
  static constexpr double kStandingHeight = 0.85;
  static constexpr double kCrawlingHeight = 0.3;
  static constexpr double kShortest = 0.2;
  using Script = std::function<std::unique_ptr<ConfirmationJob>(const Edge&)>;

  JumpAction(std::shared_ptr<const Action> walk, std::shared_ptr<const Action> crawl, double reach,
             Script script)
      : walk_(std::move(walk)),
        crawl_(std::move(crawl)),
        reach_(reach),
        script_(std::move(script)) {}

  std::string name() const override { return "jump"; }

  Point ExtendTowards(const Point& v0, const Point& v1) const override {
    return MakePoint(v0[0] + Leap(v0, v1), kCrawlingHeight);
  }
  Point ReverseExtend(const Point& v0, const Point& v1) const override {
    return MakePoint(v0[0] + Leap(v0, v1), kStandingHeight);
  }
  std::optional<Point> FindLaunchPoint(const Point& v, const Point& v1) const override {
    targets.insert({v1[0], v1[1]});
    return Upright(v) ? std::optional(MakePoint(v[0], kStandingHeight)) : std::nullopt;
  }
  std::optional<Point> FindLandingPoint(const Point& v, const Point& v1) const override {
    targets.insert({v1[0], v1[1]});
    return Crawling(v) ? std::optional(MakePoint(v[0], kCrawlingHeight)) : std::nullopt;
  }

  bool CN(const Point& v) const override { return Upright(v) || Crawling(v); }
  bool CN(const Edge& edge) const override {
    const double length = std::abs(edge.to[0] - edge.from[0]);
    return edge.from[1] == kStandingHeight && Upright(edge.from) && edge.to[1] == kCrawlingHeight &&
           Crawling(edge.to) && length >= kShortest && length <= reach_ + 1e-12;
  }
  bool CS(const Point& v) const override { return CN(v); }
  bool CS(const Edge&) const override { return false; }
  double ExpectedDuration(const Edge& edge) const override {
    return 0.5 + std::abs(edge.to[0] - edge.from[0]) / 4;
  }
  std::unique_ptr<ConfirmationJob> SpawnConfirmationJob(const Edge& edge) const override {
    return script_(edge);
  }

  mutable std::set<std::pair<double, double>> targets;  ///< of all growth so far

 private:
  double Leap(const Point& v0, const Point& v1) const {
    return std::clamp(v1[0] - v0[0], -reach_, reach_);
  }
  bool Upright(const Point& v) const { return walk_->CN(v); }
  bool Crawling(const Point& v) const { return crawl_->CN(v); }

  std::shared_ptr<const Action> walk_;
  std::shared_ptr<const Action> crawl_;
  double reach_;
  Script script_;
};

/// An action that takes ten times as long.
class SlowBandAction : public BandAction {
 public:
  using BandAction::BandAction;
  double ExpectedDuration(const Edge& edge) const override {
    return 10 * BandAction::ExpectedDuration(edge);
  }
};

}  // namespace possibility::graph::test
