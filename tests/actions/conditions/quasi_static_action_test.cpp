#include "actions/conditions/quasi_static_action.h"

#include <gtest/gtest.h>

#include "actions/conditions/exploration_pose.h"
#include "models/world/ground_map.h"
#include "tests/actions/drchubo1.h"
#include "tests/actions/random_scene.h"

namespace possibility::actions {
namespace {

using graph::Point;

class QuasiStaticActionTest : public ::testing::TestWithParam<int> {
 protected:
  QuasiStaticActionTest() {
    for (int gait = 0; gait < 2; ++gait) {
      gaits_.push_back(std::make_unique<QuasiStaticAction>(model_, gait, world_, space_, kStep));
    }
  }

  const QuasiStaticAction& action() const { return *gaits_[GetParam()]; }
  Point StancePoint(int gait, const PlanarPose& pose) const {
    return ToPoint(model_.gaits[gait]->stance.RootPose(pose, 0));
  }

  static constexpr double kStep = 0.25;
  const LocomotionModel& model_ = DrcHubo1Locomotion();
  std::mt19937 generator_{3};
  models::Environment environment_ = RandomEnvironment(&generator_, 10);
  models::GroundMap ground_{environment_};
  World world_{&environment_, &ground_};
  std::shared_ptr<PelvisPoseSpace> space_ =
      std::make_shared<PelvisPoseSpace>(environment_.bounds, ground_.levels(), 0.137);
  std::vector<std::unique_ptr<QuasiStaticAction>> gaits_;
};

TEST_P(QuasiStaticActionTest, ProjectKeepsPlaceAndHeadingAndIsIdempotent) {
  graph::RandomGenerator generator(5);
  for (int i = 0; i < 200; ++i) {
    const Point sample = space_->RandomSample(&generator);
    if (!ground_.LevelBelow(sample.head<2>(), sample[2])) continue;
    const Point projected = action().Project(sample);
    EXPECT_LT((projected.head<2>() - sample.head<2>()).norm(), 1e-12);
    EXPECT_NEAR(WrapAngle(Heading(ToPose(projected).linear()) - Heading(ToPose(sample).linear())),
                0, 1e-9);
    EXPECT_TRUE(AsStance(model_, GetParam(), ToPose(projected)).has_value());
    EXPECT_LT(space_->Distance(action().Project(projected), projected), 1e-9);
  }
}

TEST_P(QuasiStaticActionTest, ExtendTowardsTakesStepsAlongTheAxesOfTheGaitAndArrivesExactly) {
  graph::RandomGenerator generator(6);
  const auto planar = [](const Point& v) {
    return PlanarPose{v[0], v[1], Heading(ToPose(v).linear())};
  };
  for (int i = 0; i < 200; ++i) {
    Point v = action().Project(space_->RandomSample(&generator));
    const Point target = action().Project(space_->RandomSample(&generator));
    // At most two turns of half a circle, and the way between them.
    const double longest = space_->Distance(v, target) + 2 * 0.137 * std::numbers::pi;
    for (int step = 0; v != target; ++step) {
      ASSERT_LE(step, 3 + longest / kStep);
      const Point next = action().ExtendTowards(v, target);
      EXPECT_LE(space_->Distance(v, next), kStep + 1e-12);
      const StrideClass strides = ClassOfStrides(planar(v), planar(next));
      EXPECT_NE(strides, StrideClass::kAny);
      EXPECT_NE(strides, StrideClass::kOblique);
      v = next;
    }
  }
}

TEST_P(QuasiStaticActionTest, ExtendTowardsArrivesFromPosesOfAnyTilt) {
  graph::RandomGenerator generator(7);
  for (int i = 0; i < 50; ++i) {
    Point v = space_->RandomSample(&generator);
    const Point target = action().Project(space_->RandomSample(&generator));
    for (int step = 0; v != target; ++step) {
      ASSERT_LT(step, 1000);
      v = action().ExtendTowards(v, target);
    }
  }
}

TEST_P(QuasiStaticActionTest, TransitionEdgesAreSufficientInBothDirectionsAndForBothGaits) {
  const int other = 1 - GetParam();
  int made = 0;
  for (int i = 0; i < 300; ++i) {
    const Point v = StancePoint(other, RandomStance(&generator_, 2.5));
    const std::vector<Point> path = action().TransitionFrom(v);
    if (path.empty()) continue;
    ++made;
    ASSERT_EQ(path.size(), 1u);
    EXPECT_TRUE(action().CS(path[0]));
    EXPECT_TRUE(action().CS(graph::Edge{v, path[0]}));
    EXPECT_TRUE(action().CS(graph::Edge{path[0], v}));
    EXPECT_TRUE(gaits_[other]->CS(graph::Edge{v, path[0]}));
  }
  EXPECT_GT(made, 10);
}

TEST_P(QuasiStaticActionTest, SufficientImpliesNecessaryEverywhere) {
  int sufficient = 0;
  for (int i = 0; i < 2000; ++i) {
    const PlanarPose pose = RandomStance(&generator_, 2.9);
    const Point a = StancePoint(GetParam(), pose);
    const Point b = StancePoint(GetParam(), pose * PlanarPose{0.3, 0.1, 0.2});
    if (action().CS(a)) {
      EXPECT_TRUE(action().CN(a));
    }
    if (!action().CS(graph::Edge{a, b})) continue;
    ++sufficient;
    EXPECT_TRUE(action().CN(graph::Edge{a, b}));
    EXPECT_TRUE(action().CS(graph::Edge{b, a}));
  }
  EXPECT_GT(sufficient, 20);
}

TEST_P(QuasiStaticActionTest, AForbiddenEdgeStaysForbiddenInBothDirections) {
  const Point a = StancePoint(GetParam(), {0.1, 0.2, 0.3});
  const Point b = StancePoint(GetParam(), {0.2, 0.2, 0.3});
  gaits_[GetParam()]->Forbid({a, b});
  EXPECT_FALSE(action().CS(graph::Edge{a, b}));
  EXPECT_FALSE(action().CS(graph::Edge{b, a}));
}

TEST_P(QuasiStaticActionTest, AStanceOverTheGapIsOffGround) {
  EXPECT_EQ(action().Examine({GetParam(), {20, 0, 0}, 0}), StanceFault::kOutOfBounds);
  // The floor of the random scene ends beyond |x| = 4.
  environment_.bounds.extend(Eigen::Vector2d(30, 0));
  const StanceFault fault = action().Examine({GetParam(), {20, 0, 0}, 0});
  EXPECT_EQ(fault, StanceFault::kOffGround);
  EXPECT_FALSE(action().CN(StancePoint(GetParam(), {20, 0, 0})));
}

TEST(ExplorationPoseTest, DistanceIsAMetricThatWeighsRotationLess) {
  const PelvisPoseSpace space(Eigen::AlignedBox2d(Eigen::Vector2d(-1, -1), Eigen::Vector2d(1, 1)),
                              {0.0}, 0.137);
  graph::RandomGenerator generator(1);
  for (int i = 0; i < 500; ++i) {
    const Point a = space.RandomSample(&generator), b = space.RandomSample(&generator),
                c = space.RandomSample(&generator);
    EXPECT_EQ(space.Distance(a, a), 0);
    EXPECT_DOUBLE_EQ(space.Distance(a, b), space.Distance(b, a));
    EXPECT_LE(space.Distance(a, c), space.Distance(a, b) + space.Distance(b, c) + 1e-12);
  }
  const Point origin = ToPoint(PlanarPose{}.At(1));
  EXPECT_NEAR(space.Distance(origin, ToPoint(PlanarPose{1, 0, 0}.At(1))), 0.863, 1e-12);
  EXPECT_NEAR(space.Distance(origin, ToPoint(PlanarPose{0, 0, 1}.At(1))), 0.137, 1e-9);
}

TEST(ExplorationPoseTest, HalfOfTheGuidedSamplesAreNearTheGuides) {
  PelvisPoseSpace space(Eigen::AlignedBox2d(Eigen::Vector2d(-5, -5), Eigen::Vector2d(5, 5)), {0.0},
                        0.137);
  const double spread = 0.1;
  const std::vector<PlanarPose> guides = {{1, 2, 0.5}, {-3, 0, -2}};
  std::vector<Point> points;
  for (const PlanarPose& guide : guides) points.push_back(ToPoint(guide.At(1.2)));
  space.Guide(points, spread);
  graph::RandomGenerator generator(1);
  std::vector<int> near(guides.size(), 0);
  constexpr int kSamples = 2000;
  for (int i = 0; i < kSamples; ++i) {
    const Eigen::Isometry3d sample = ToPose(space.RandomSample(&generator));
    for (std::size_t g = 0; g < guides.size(); ++g) {
      const Eigen::Isometry3d left = guides[g].At(1.2).inverse() * sample;
      const double turn = std::abs(Heading(left.linear()));
      if (left.translation().norm() <= std::sqrt(2) * spread + 1e-9 && turn <= spread + 1e-9) {
        ++near[g];
      }
    }
  }
  for (const int count : near) EXPECT_NEAR(count, kSamples / 4, kSamples / 20);
}

INSTANTIATE_TEST_SUITE_P(Gaits, QuasiStaticActionTest, ::testing::Values(0, 1),
                         [](const auto& info) { return info.param == 0 ? "walk" : "crawl"; });

}  // namespace
}  // namespace possibility::actions
