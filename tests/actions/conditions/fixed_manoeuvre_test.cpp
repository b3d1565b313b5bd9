#include "actions/conditions/fixed_manoeuvre.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <thread>

#include "actions/conditions/exploration_pose.h"
#include "actions/wholebody/motion_error.h"
#include "models/world/ground_map.h"
#include "tests/actions/drchubo1.h"

namespace possibility::actions {
namespace {

constexpr double kAhead = 0.6;
constexpr double kHeight = 0.1;

/// A floor, and higher ground from x = 0 on.
models::Environment TwoLevels() {
  models::Environment environment;
  environment.bounds = {Eigen::Vector2d(-4, -4), Eigen::Vector2d(4, 4)};
  const auto add = [&](const char* name, double x, double top) {
    models::Obstacle& ground = environment.obstacles.emplace_back();
    ground.name = name;
    ground.shape = models::Shape::Box({4, 8, 1});
    ground.X_WO.translation() << x, 0, top - 0.5;
    ground.is_ground = true;
  };
  add("floor", -2, 0);
  add("terrace", 2, kHeight);
  return environment;
}

/// One phase of two knots that stands still: the motion's content does not matter here.
std::vector<Phase> StandStill(double rise) {
  Phase phase;
  for (const double t : {0.0, 1.0}) {
    Knot knot;
    knot.t = t;
    knot.q = DrcHubo1Locomotion().gaits[0]->stance.q;
    knot.q[4] += t * kAhead;
    knot.q[6] += t * rise;
    knot.v = knot.a = Eigen::VectorXd::Zero(knot.q.size() - 1);
    phase.knots.push_back(knot);
  }
  return {phase};
}

class FixedManoeuvreTest : public ::testing::Test {
 protected:
  FixedManoeuvreTest() {
    context_.model = &DrcHubo1Locomotion();
    context_.world = {&environment_, &ground_};
    context_.space =
        std::make_shared<PelvisPoseSpace>(environment_.bounds, ground_.levels(), 0.137);
    for (const int gait : {0, 1}) {
      context_.gaits.push_back(std::make_shared<QuasiStaticAction>(
          *context_.model, gait, context_.world, context_.space, 0.25));
    }
    shape_.name = "vault";
    shape_.displacement.x = kAhead;
    shape_.lowest = 0.05;
    shape_.highest = 0.2;
    shape_.duration = 1;
  }

  FixedManoeuvre Make() const {
    return {context_, shape_, [this](double rise, const CancellationToken&) {
              ++calls_;
              if (!fault_.empty()) throw MotionError(fault_);
              return StandStill(rise);
            }};
  }

  static graph::Point At(double x, double y, double yaw, double z) {
    return ToPoint(DrcHubo1Locomotion().gaits[0]->stance.RootPose({x, y, yaw}, z));
  }

  models::Environment environment_ = TwoLevels();
  models::GroundMap ground_{environment_};
  PlanningContext context_;
  FixedManoeuvreShape shape_;
  std::string fault_;
  mutable std::atomic<int> calls_ = 0;
  const graph::Edge up_ = {At(-0.3, 0.5, 0, 0), At(0.3, 0.5, 0, kHeight)};
  const graph::Edge down_ = {up_.to, up_.from};
};

TEST_F(FixedManoeuvreTest, CNRequiresTheDisplacementTheRiseAndBothStances) {
  const FixedManoeuvre vault = Make();
  EXPECT_TRUE(vault.CN(up_));
  EXPECT_FALSE(vault.CN(graph::Edge{up_.from, At(0.31, 0.5, 0, kHeight)})) << "too far";
  EXPECT_FALSE(vault.CN(graph::Edge{up_.from, At(0.3, 0.51, 0, kHeight)})) << "to the side";
  EXPECT_FALSE(vault.CN(graph::Edge{up_.from, At(0.3, 0.5, 0.01, kHeight)})) << "turned";
  EXPECT_FALSE(vault.CN(graph::Edge{At(-1, 0, 0, 0), At(-0.4, 0, 0, 0)})) << "no rise";
  EXPECT_FALSE(vault.CN(graph::Edge{At(-0.05, 0, 0, 0), At(0.55, 0, 0, kHeight)}))
      << "no stance so close to the terrace";
}

TEST_F(FixedManoeuvreTest, OnlyAReversibleOneLeadsBack) {
  const FixedManoeuvre one_way = Make();
  EXPECT_FALSE(one_way.CN(down_));
  EXPECT_EQ(one_way.ExtendTowards(down_.from, down_.to), down_.from);
  EXPECT_LT((one_way.ReverseExtend(up_.to, up_.from) - up_.from).norm(), 1e-9);

  shape_.is_reversible = true;
  const FixedManoeuvre both_ways = Make();
  EXPECT_TRUE(both_ways.CN(down_));
  EXPECT_LT((both_ways.ExtendTowards(down_.from, down_.to) - down_.to).norm(), 1e-9);
  EXPECT_LT((both_ways.ReverseExtend(down_.to, down_.from) - down_.from).norm(), 1e-9);
}

TEST_F(FixedManoeuvreTest, AReversibleOneBetweenTwoGaitsIsRefused) {
  shape_.is_reversible = true;
  shape_.to = 1;
  EXPECT_THROW(Make(), std::invalid_argument);
}

TEST_F(FixedManoeuvreTest, TheMotionIsMadeOncePerRiseAndPlacedAtEveryLaunch) {
  shape_.is_reversible = true;
  const FixedManoeuvre vault = Make();
  for (const double y : {0.5, -1.25, 2.0}) {
    const graph::Edge edge = {At(-0.3, y, 0, 0), At(0.3, y, 0, kHeight)};
    for (const graph::Edge& e : {edge, graph::Edge{edge.to, edge.from}}) {
      const std::vector<Phase> motion = vault.Motion(e, {});
      const Knot& first = motion.front().knots.front();
      const Knot& last = motion.back().knots.back();
      EXPECT_EQ(first.t, 0);
      EXPECT_LT((first.q.segment<3>(4) - e.from.head<3>()).norm(), 1e-6);
      EXPECT_LT((last.q.segment<3>(4) - e.to.head<3>()).norm(), 1e-6);
    }
  }
  EXPECT_EQ(calls_, 1);
}

TEST_F(FixedManoeuvreTest, TheReasonWhyThereIsNoMotionIsKept) {
  fault_ = "a knee needs 120 Nm of 100";
  const FixedManoeuvre vault = Make();
  for (int i = 0; i < 2; ++i) {
    const auto job = vault.SpawnConfirmationJob(up_);
    graph::JobControl control;
    EXPECT_EQ(job->Run(&control), graph::JobVerdict::kRefuted);
    EXPECT_EQ(job->reason(), fault_);
  }
  EXPECT_EQ(calls_, 1);
}

/// The work on a motion takes longer than the search keeps its interest in one edge.
TEST_F(FixedManoeuvreTest, AMotionGoesOnForOtherEdgesWhereACancelledJobHasLeftIt) {
  constexpr int kSteps = 50;
  std::atomic<int> steps = 0;
  const FixedManoeuvre vault(context_, shape_,
                             [&](double rise, const CancellationToken& cancellation) {
                               for (int i = 0; i < kSteps; ++i) {
                                 cancellation.ThrowIfCancelled();
                                 ++steps;
                                 std::this_thread::sleep_for(std::chrono::milliseconds(1));
                               }
                               return StandStill(rise);
                             });
  graph::JobControl cancelled;
  std::jthread first([&] {
    EXPECT_EQ(vault.SpawnConfirmationJob(up_)->Run(&cancelled), graph::JobVerdict::kUndecided);
  });
  while (steps < kSteps / 5) std::this_thread::yield();
  cancelled.Cancel();
  first.join();
  EXPECT_LT(steps, kSteps);
  const graph::Edge elsewhere = {At(-0.3, -2, 0, 0), At(0.3, -2, 0, kHeight)};
  graph::JobControl control;
  EXPECT_NE(vault.SpawnConfirmationJob(elsewhere)->Run(&control), graph::JobVerdict::kUndecided);
  EXPECT_EQ(steps, kSteps);
}

TEST_F(FixedManoeuvreTest, ARiseRefutedOnceIsRefusedEverywhere) {
  FixedManoeuvre vault = Make();
  const graph::Edge elsewhere = {At(-0.3, -2, 0, 0), At(0.3, -2, 0, kHeight)};
  ASSERT_TRUE(vault.CN(elsewhere));
  vault.RefuteEverywhere(up_);
  EXPECT_FALSE(vault.CN(elsewhere));
  EXPECT_EQ(vault.SpawnConfirmationJob(elsewhere), nullptr);
}

TEST_F(FixedManoeuvreTest, BoundsHoldTheLandingsOfBothDirections) {
  shape_.is_reversible = true;
  shape_.displacement = {0.6, 0.1, 0.3};
  shape_.flight = FlightBounds{0.2, 0.4};
  const ManoeuvreBounds bounds = Make().Bounds();
  const PlanarPose back = shape_.displacement.Inverse();
  EXPECT_TRUE(bounds.landings(0.1)->offset.contains(shape_.displacement.position()));
  EXPECT_NEAR(bounds.landings(0.1)->turn, 0.3, 1e-12);
  EXPECT_TRUE(bounds.landings(-0.1)->offset.contains(back.position()));
  EXPECT_FALSE(bounds.landings(0.0).has_value());
  EXPECT_FALSE(bounds.landings(0.3).has_value());
  EXPECT_EQ(bounds.flight->range, 0.4);
}

/// From random places, whatever is found can start an edge, or end one.
TEST_F(FixedManoeuvreTest, LaunchesAndLandingsThatAreFoundBelongToEdges) {
  shape_.is_reversible = true;
  const FixedManoeuvre vault = Make();
  std::mt19937 generator(1);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(generator);
  };
  int found = 0;
  for (int trial = 0; trial < 100; ++trial) {
    const bool low = trial % 2 == 0;
    const double x = uniform(0.5, 1.5);
    const double yaw = uniform(-std::numbers::pi, std::numbers::pi);
    const graph::Point v = At(low ? -x : x, uniform(-1, 1), yaw, low ? 0 : kHeight);
    const graph::Point v1 = At(low ? 2 : -2, uniform(-1, 1), 0, low ? kHeight : 0);
    const auto launch = vault.FindLaunchPoint(v, v1);
    const auto landing = vault.FindLandingPoint(v, v1);
    ASSERT_EQ(launch.has_value(), landing.has_value());
    if (!launch) continue;
    ++found;
    EXPECT_TRUE(vault.CN(graph::Edge{*launch, vault.ExtendTowards(*launch, v1)}));
    EXPECT_TRUE(vault.CN(graph::Edge{vault.ReverseExtend(*landing, v1), *landing}));
    EXPECT_EQ(*vault.FindLaunchPoint(*launch, v1), *launch) << "there already";
  }
  EXPECT_GT(found, 80);
}

/// A level floor with a beam across it, turned.
class CrossingTest : public FixedManoeuvreTest {
 protected:
  static constexpr double kTurn = 0.4;  // rad

  CrossingTest() {
    environment_.obstacles.clear();
    models::Obstacle& floor = environment_.obstacles.emplace_back();
    floor.name = "floor";
    floor.shape = models::Shape::Box({20, 20, 1});
    floor.X_WO.translation() << 0, 0, -0.5;
    floor.is_ground = true;
    shape_.lowest = shape_.highest = 0;
    shape_.displacement.x = 1;
    shape_.is_reversible = true;
    shape_.over = CrossedSpace{0.45, 0.6, 0.2};
  }

  /// The beam lies across the line at `place` (m) along the turned x axis.
  void AddBeam(double place, double thickness, double height, double width = 6) {
    models::Obstacle& beam = environment_.obstacles.emplace_back();
    beam.name = "beam";
    beam.shape = models::Shape::Box({thickness, width, height});
    beam.X_WO = PlanarPose{place * std::cos(kTurn), place * std::sin(kTurn), kTurn}.At(height / 2);
    Prepare();
  }

  /// `x`, `y`, `turn`: in the turned frame.
  static graph::Point Turned(double x, double y, double turn = 0) {
    const PlanarPose pose = PlanarPose{0, 0, kTurn} * PlanarPose{x, y, turn};
    return At(pose.x, pose.y, pose.yaw, 0);
  }

 private:
  void Prepare() {
    ground_ = models::GroundMap(environment_);
    context_.gaits.clear();
    for (const int gait : {0, 1}) {
      context_.gaits.push_back(std::make_shared<QuasiStaticAction>(
          *context_.model, gait, context_.world, context_.space, 0.25));
    }
  }
};

TEST_F(CrossingTest, AnEdgeNeedsAnObstacleWithinTheSpace) {
  AddBeam(0.5, 0.1, 0.2);
  const FixedManoeuvre over = Make();
  const auto edge = [](double x, double y) { return graph::Edge{Turned(x, y), Turned(x + 1, y)}; };
  EXPECT_TRUE(over.CN(edge(0, 0)));
  EXPECT_TRUE(over.CN(edge(0, 2)));
  EXPECT_TRUE(over.CN(graph::Edge{edge(0, 0).to, edge(0, 0).from})) << "backwards";
  EXPECT_FALSE(over.CN(edge(-0.06, 0))) << "behind the space";
  EXPECT_FALSE(over.CN(edge(0.01, 0))) << "before the space";
  EXPECT_FALSE(over.CN(edge(-2, 0))) << "nothing to lead over";
}

TEST_F(CrossingTest, AnObstacleTooHighOrTooThickOrAsideIsNone) {
  const graph::Edge edge = {Turned(0, 0), Turned(1, 0)};
  AddBeam(0.525, 0.1, 0.21);
  EXPECT_FALSE(Make().CN(edge)) << "too high";
  environment_.obstacles.pop_back();
  AddBeam(0.525, 0.16, 0.1);
  EXPECT_FALSE(Make().CN(edge)) << "too thick";
  environment_.obstacles.pop_back();
  AddBeam(0.525, 0.1, 0.1, 0.1);
  EXPECT_TRUE(Make().CN(edge));
  EXPECT_FALSE(Make().CN(graph::Edge{Turned(0, 0.5), Turned(1, 0.5)})) << "beside it";
}

TEST_F(CrossingTest, WithoutAnObstacleThatFitsItLeadsNowhere) {
  AddBeam(0.525, 0.1, 0.3);
  EXPECT_FALSE(Make().Bounds().landings(0).has_value());
  AddBeam(0.525, 0.1, 0.2);
  EXPECT_TRUE(Make().Bounds().landings(0).has_value());
}

TEST_F(CrossingTest, LaunchesAndLandingsHaveTheObstacleInTheMiddle) {
  AddBeam(0.5, 0.05, 0.2);
  const FixedManoeuvre over = Make();
  const graph::Point v = Turned(-1, 0.3, 1);
  const graph::Point v1 = Turned(2, 0.5, 2);
  const auto launch = over.FindLaunchPoint(v, v1);
  ASSERT_TRUE(launch.has_value());
  EXPECT_LT((*launch - Turned(-0.025, 0.3)).norm(), 1e-6) << "forwards: the smaller turn";
  const auto backwards = over.FindLaunchPoint(Turned(-1, 0.3, 3), v1);
  ASSERT_TRUE(backwards.has_value());
  EXPECT_LT((*backwards - Turned(0.025, 0.3, std::numbers::pi)).norm(), 1e-6);
  EXPECT_TRUE(over.CN(graph::Edge{*launch, over.ExtendTowards(*launch, v1)}));
  const auto landing = over.FindLandingPoint(v, v1);
  ASSERT_TRUE(landing.has_value());
  EXPECT_TRUE(over.CN(graph::Edge{over.ReverseExtend(*landing, v1), *landing}));
  EXPECT_FALSE(over.FindLaunchPoint(v, Turned(-3, 0.3)).has_value()) << "the other way";
  EXPECT_FALSE(over.FindLaunchPoint(Turned(-3.5, 0.3), v1).has_value()) << "too far away";
}

}  // namespace
}  // namespace possibility::actions
