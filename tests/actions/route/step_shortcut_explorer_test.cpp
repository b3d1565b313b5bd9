#include "actions/route/step_shortcut_explorer.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/actions/footsteps/uneven_world.h"

namespace possibility::actions {
namespace {

/// A manoeuvre between any two stances of the walk, all of which take the same time.
class Hop : public Manoeuvre {
 public:
  Hop(const PlanningContext& context, double duration)
      : Manoeuvre(context, "hop", 0, 0), duration_(duration) {}
  using Manoeuvre::CN;
  bool CN(const graph::Edge&) const override { return true; }
  graph::Point ExtendTowards(const graph::Point& v, const graph::Point&) const override {
    return v;
  }
  graph::Point ReverseExtend(const graph::Point& v, const graph::Point&) const override {
    return v;
  }
  std::optional<graph::Point> FindLaunchPoint(const graph::Point&,
                                              const graph::Point&) const override {
    return std::nullopt;
  }
  std::optional<graph::Point> FindLandingPoint(const graph::Point&,
                                               const graph::Point&) const override {
    return std::nullopt;
  }
  double ExpectedDuration(const graph::Edge&) const override { return duration_; }
  std::vector<Phase> Motion(const graph::Edge&, const CancellationToken&) const override {
    return {};
  }

 private:
  double duration_;
};

/// Two floors, the second one lower by `drop`, and a route of hops from one to the other.
class StepShortcutExplorerTest : public ::testing::Test {
 protected:
  void Load(double gap, double drop, double hop_duration) {
    world_.Ground(-3, 0.3, 0).Ground(0.3 + gap, 4, -drop);
    world_.Built();
    drop_ = drop;
    context_.model = &WalkingHubo();
    context_.world = world_.world;
    context_.space = std::make_shared<PelvisPoseSpace>(world_.environment.bounds,
                                                       world_.ground->levels(), 0.137);
    gaits_ = {
        std::make_shared<QuasiStaticAction>(WalkingHubo(), 0, world_.world, context_.space, 0.25)};
    context_.gaits.assign(gaits_.begin(), gaits_.end());
    steps_ = std::make_shared<PlannedSteps>(context_, 0);
    manoeuvres_ = {
        std::make_shared<SearchedManoeuvre>(std::make_shared<Hop>(context_, hop_duration)),
        std::make_shared<SearchedManoeuvre>(steps_)};
    actions_.assign(gaits_.begin(), gaits_.end());
    actions_.insert(actions_.end(), manoeuvres_.begin(), manoeuvres_.end());
    search_.actions = &actions_;
    search_.deadline = &deadline_;
    explorer_ = std::make_unique<StepShortcutExplorer>(
        RouteSpace{&WalkingHubo(), &gaits_, &manoeuvres_}, *steps_, kSteps, &is_called_, search_);
  }

  graph::Point At(double x) const {
    const GroundedStance at = UnevenWorld::StanceAt(x, x > 0.3 ? -drop_ : 0);
    return ToPoint(WalkingHubo().gaits[0]->stance.RootPose(at.pose, at.z));
  }
  std::vector<graph::PathEdge> Hops(const std::vector<double>& stops) const {
    std::vector<graph::PathEdge> route;
    for (std::size_t i = 0; i + 1 < stops.size(); ++i) {
      route.push_back({kHop, {At(stops[i]), At(stops[i + 1])}});
    }
    return route;
  }

  /// All proposals until the explorer has none.
  std::vector<graph::PathEdge> Explore() {
    std::vector<graph::PathEdge> edges;
    for (;;) {
      const graph::Findings findings = explorer_->Explore();
      edges.insert(edges.end(), findings.route.begin(), findings.route.end());
      if (findings.outlook == graph::Outlook::kOver) return edges;
    }
  }

  static constexpr int kHop = 1;    ///< actions
  static constexpr int kSteps = 2;  ///< actions
  UnevenWorld world_;
  double drop_ = 0;
  PlanningContext context_;
  std::vector<std::shared_ptr<QuasiStaticAction>> gaits_;
  std::shared_ptr<PlannedSteps> steps_;
  std::vector<std::shared_ptr<SearchedManoeuvre>> manoeuvres_;
  std::vector<std::shared_ptr<const graph::Action>> actions_;
  bool is_called_ = true;
  Deadline deadline_{60};
  graph::ExplorerContext search_;
  std::unique_ptr<StepShortcutExplorer> explorer_;
};

TEST_F(StepShortcutExplorerTest, SlowHopsAreReplacedWholeAndInParts) {
  Load(0, 0.05, 20);
  const std::vector<graph::PathEdge> route = Hops({-0.2, 0.1, 0.7, 1.1});
  ASSERT_TRUE(explorer_->OnRoute(route, 60));
  const std::vector<graph::PathEdge> proposed = Explore();
  // The whole chain, its first hop, the other two, and each of those.
  ASSERT_EQ(proposed.size(), 5U);
  const std::vector<std::pair<double, double>> ends = {
      {-0.2, 1.1}, {-0.2, 0.1}, {0.1, 1.1}, {0.1, 0.7}, {0.7, 1.1}};
  for (std::size_t i = 0; i < ends.size(); ++i) {
    EXPECT_EQ(proposed[i].action, kSteps);
    EXPECT_EQ(proposed[i].points.from, At(ends[i].first));
    EXPECT_EQ(proposed[i].points.to, At(ends[i].second));
    EXPECT_LT(steps_->ExpectedDuration(proposed[i].points), 60);
    EXPECT_FALSE(steps_->Motion(proposed[i].points, {}).empty());
  }
  EXPECT_FALSE(explorer_->OnRoute(route, 60)) << "everything was tried";
}

TEST_F(StepShortcutExplorerTest, QuickHopsStay) {
  Load(0, 0.05, 0.5);
  ASSERT_TRUE(explorer_->OnRoute(Hops({-0.2, 0.1, 0.7}), 1));
  EXPECT_TRUE(Explore().empty());
}

TEST_F(StepShortcutExplorerTest, HopsOverWhatNoStepCrossesStay) {
  Load(0.8, 0, 20);
  ASSERT_TRUE(explorer_->OnRoute(Hops({0.1, 1.3}), 20));
  EXPECT_TRUE(Explore().empty());
}

TEST_F(StepShortcutExplorerTest, WaysOfTheGaitAndPlannedStepsAreLeftAlone) {
  Load(0, 0, 20);
  std::vector<graph::PathEdge> route = Hops({-0.2, 0.1, 0.7});
  route[0].action = 0;
  route[1].action = kSteps;
  EXPECT_FALSE(explorer_->OnRoute(route, 1));
}

TEST_F(StepShortcutExplorerTest, TakesPartOnceStepsWereNeeded) {
  Load(0, 0.05, 20);
  EXPECT_TRUE(explorer_->TakesPart(graph::SearchStage::kImprovement));
  EXPECT_FALSE(explorer_->TakesPart(graph::SearchStage::kFirstRoute));
  is_called_ = false;
  EXPECT_FALSE(explorer_->TakesPart(graph::SearchStage::kImprovement));
}

TEST_F(StepShortcutExplorerTest, StepsSlowerThanTheHopsAreNotMade) {
  Load(0, 0.05, 20);
  const graph::Edge edge{At(0.1), At(0.7)};
  FootstepSearch search(WalkingHubo(), 0, world_.world, UnevenWorld::StanceAt(0.1),
                        {UnevenWorld::StanceAt(0.7, -0.05)}, steps_->limits());
  while (search.Advance(1000) == FootstepSearch::Status::kSearching) {
  }
  ASSERT_FALSE(search.steps().empty());
  steps_->Suggest(edge, search.steps(), 0.1);
  EXPECT_THROW(steps_->Motion(edge, {}), MotionError);
}

}  // namespace
}  // namespace possibility::actions
