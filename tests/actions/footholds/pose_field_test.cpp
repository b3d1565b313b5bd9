#include "actions/footholds/pose_field.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace possibility::actions {
namespace {

const Eigen::AlignedBox2d kRoom(Eigen::Vector2d(0, 0), Eigen::Vector2d(4, 3));
constexpr double kFieldCell = 0.1;

PoseField FieldTo(const PlanarPose& goal, const PoseField::Paces& paces,
                  const std::function<bool(const PlanarPose&)>& is_open) {
  return PoseField(kRoom, kFieldCell, 0, {{goal}}, paces,
                   [is_open](int, const PlanarPose& pose) { return is_open(pose); }, {});
}

bool Everywhere(const PlanarPose&) { return true; }
bool EverywhereInAllLayers(int, const PlanarPose&) { return true; }

TEST(PoseFieldTest, TimeAlongAnAxisIsDistanceTimesPace) {
  PoseField field = FieldTo({0.55, 1.55, 0}, {2, 5, 1}, Everywhere);
  EXPECT_NEAR(field.At(0, {2.55, 1.55, 0}), 4, 1e-9);
  EXPECT_NEAR(field.At(0, {0.55, 0.55, 0}), 5, 1e-9);
  EXPECT_NEAR(field.At(0, {0.55, 1.55, 0}), 0, 1e-12);
}

TEST(PoseFieldTest, ATurnTakesItsTime) {
  PoseField field = FieldTo({2, 1.5, 0}, {1, 1, 3}, Everywhere);
  EXPECT_NEAR(field.At(0, {2, 1.5, std::numbers::pi}), 3 * std::numbers::pi, 1e-9);
  EXPECT_NEAR(field.At(0, {2, 1.5, -std::numbers::pi / 2}), 1.5 * std::numbers::pi, 1e-9);
}

/// Sideways is dear: it is quicker to turn, walk and turn back.
TEST(PoseFieldTest, ALongWayAsideIsWalked) {
  PoseField field = FieldTo({2, 0.05, 0}, {1, 100, 0.1}, Everywhere);
  EXPECT_NEAR(field.At(0, {2, 2.55, 0}), 2.5 + 0.1 * std::numbers::pi, 1e-9);
}

TEST(PoseFieldTest, AGapThatIsOpenToOneHeadingIsPassedInIt) {
  const double across = std::numbers::pi / 2;
  const auto is_open = [&](const PlanarPose& pose) {
    const bool in_wall = pose.x > 2 && pose.x < 2.3;
    const bool sidles =
        std::abs(WrapAngle(pose.yaw - across)) < 0.1 && std::abs(pose.y - 1.5) < 0.3;
    return !in_wall || sidles;
  };
  PoseField field = FieldTo({3.55, 1.55, 0}, {1, 2, 0.5}, is_open);
  // To the wall and beyond it ahead, through it aside, and a quarter turn there and back.
  const double time = field.At(0, {0.55, 1.55, 0});
  EXPECT_GT(time, 3 + 0.5 * std::numbers::pi);
  EXPECT_LT(time, 3 + 0.5 * std::numbers::pi + 0.7);
}

TEST(PoseFieldTest, WithoutAWayTheTimeIsInfinite) {
  const auto is_open = [](const PlanarPose& pose) { return pose.x < 2 || pose.x > 2.2; };
  PoseField field = FieldTo({3.5, 1.5, 0}, {1, 1, 1}, is_open);
  EXPECT_TRUE(std::isinf(field.At(0, {0.5, 1.5, 0})));
  EXPECT_TRUE(std::isfinite(field.At(0, {2.5, 0.5, 1})));
}

TEST(PoseFieldTest, CancellationEndsIt) {
  PoseField field(kRoom, 0.01, 0, {{{2, 1.5, 0}}}, {1, 1, 1}, EverywhereInAllLayers, {});
  EXPECT_THROW(field.At(0, {0.1, 0.1, 0}, CancellationToken([] { return false; })), Cancelled);
}

/// A floor with a block on it. The ground alone takes 3 s from the floor onto the block.
TEST(PoseFieldTest, BetweenLayersPassesWhatTheGroundTakes) {
  PoseField::Ground ground;
  ground.layers = 2;
  ground.most = 4;
  ground.time = [](int layer, const Eigen::Vector2d& p) {
    const bool is_on_block = p.x() < 1;
    if (layer == 1) return is_on_block ? 0 : std::numeric_limits<double>::infinity();
    return 3.0;
  };
  const std::vector<PoseField::Goal> goals = {{{0.55, 1.55, 0}, 1}};
  PoseField field(kRoom, kFieldCell, 0, goals, {2, 5, 1}, EverywhereInAllLayers, ground);
  EXPECT_NEAR(field.At(1, {0.85, 1.55, 0}), 0.6, 1e-9);
  EXPECT_NEAR(field.At(0, {0.85, 1.55, 0}), 3.6, 1e-9);
  EXPECT_NEAR(field.At(0, {2.55, 1.55, 0}), 7, 1e-9);
  EXPECT_TRUE(std::isinf(field.At(1, {2.55, 1.55, 0})));
  ground.most = 2.9;
  PoseField higher(kRoom, kFieldCell, 0, goals, {2, 5, 1}, EverywhereInAllLayers, ground);
  EXPECT_TRUE(std::isinf(higher.At(0, {2.55, 1.55, 0})));
}

/// Where the ground is slow, poses are.
TEST(PoseFieldTest, InALayerPassesWhatTheGroundTakes) {
  PoseField::Ground ground;
  ground.most = 10;
  ground.time = [](int, const Eigen::Vector2d& p) { return 7 * p.x(); };
  PoseField field(kRoom, kFieldCell, 0, {{{0.55, 1.55, 0}}}, {2, 5, 1}, EverywhereInAllLayers,
                  ground);
  EXPECT_NEAR(field.At(0, {2.55, 1.55, 0}), 14, 1e-9);
  EXPECT_NEAR(field.At(0, {0.55, 2.55, 0}), 5, 1e-9);
}

/// Questions near the goal first, or the farthest one first: the answers are the same.
TEST(PoseFieldTest, AnswersDoNotDependOnTheOrderOfQuestions) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> share(0, 1);
  const auto is_open = [](const PlanarPose& pose) {
    return std::abs(std::sin(2.3 * pose.x) + std::cos(3.1 * pose.y + pose.yaw)) > 0.3;
  };
  std::vector<PlanarPose> poses;
  for (int i = 0; i < 500; ++i) {
    poses.push_back({4 * share(random), 3 * share(random), 6.28 * share(random)});
  }
  PoseField one = FieldTo({2, 1.5, 0}, {1, 3, 0.7}, is_open);
  PoseField other = FieldTo({2, 1.5, 0}, {1, 3, 0.7}, is_open);
  std::vector<double> times;
  for (const PlanarPose& pose : poses) times.push_back(one.At(0, pose));
  for (std::size_t i = poses.size(); i-- > 0;) EXPECT_EQ(other.At(0, poses[i]), times[i]);
}

/// On ground of random speed, with random walls, in two layers.
TEST(PoseFieldTest, StartsChangeNoTime) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> share(0, 1);
  const auto pose = [&] {
    return PlanarPose{4 * share(random), 3 * share(random), 6.28 * share(random)};
  };
  for (int world = 0; world < 20; ++world) {
    const double shift = 6 * share(random);
    const auto is_open = [shift](int layer, const PlanarPose& at) {
      return std::abs(std::sin(2.3 * at.x + shift + layer) + std::cos(3.1 * at.y + at.yaw)) > 0.3;
    };
    PoseField::Ground ground;
    ground.layers = 2;
    ground.most = 3;
    ground.time = [shift](int layer, const Eigen::Vector2d& p) {
      return 4 * std::sin(p.x() + shift) + 2 * p.y() + layer;
    };
    const std::vector<PoseField::Goal> goals = {{pose(), 0}, {pose(), 1, 0.5}};
    const std::vector<PoseField::Start> starts = {{pose(), 1}, {pose(), 0}};
    const PoseField::Paces paces{1, 3, 0.7};
    PoseField plain(kRoom, kFieldCell, 0.1, goals, paces, is_open, ground);
    PoseField grown(kRoom, kFieldCell, 0.1, goals, paces, is_open, ground, starts);
    for (const PoseField::Start& start : starts) {
      EXPECT_EQ(grown.At(start.layer, start.pose), plain.At(start.layer, start.pose));
    }
    for (int i = 0; i < 200; ++i) {
      const PlanarPose asked = pose();
      const double expected = plain.At(i % 2, asked);
      if (std::isinf(expected)) {
        EXPECT_TRUE(std::isinf(grown.At(i % 2, asked)));
      } else {
        EXPECT_NEAR(grown.At(i % 2, asked), expected, 1e-9);
      }
    }
  }
}

}  // namespace
}  // namespace possibility::actions
