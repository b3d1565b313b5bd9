// Rounded ways, beside means of densely sampled straight ways.

#include "actions/gait/rounded_way.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace possibility::actions {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kMetresPerRadian = 0.03;

double Apart(const PlanarPose& a, const PlanarPose& b) {
  return (a.position() - b.position()).norm() + std::abs(WrapAngle(a.yaw - b.yaw));
}

/// A straight way through corners, by its length.
class SampledWay {
 public:
  explicit SampledWay(const std::vector<PlanarPose>& corners) {
    for (const PlanarPose& corner : corners) {
      Vector3d pose(corner.x, corner.y, corner.yaw);
      double length = 0;
      if (!corners_.empty()) {
        const Vector3d& last = corners_.back();
        pose.z() = last.z() + WrapAngle(corner.yaw - last.z());
        length = lengths_.back() + (pose - last).head<2>().norm() +
                 kMetresPerRadian * std::abs(pose.z() - last.z());
      }
      corners_.push_back(pose);
      lengths_.push_back(length);
    }
  }

  double length() const { return lengths_.back(); }

  Vector3d At(double length) const {
    std::size_t i = 1;
    while (i + 1 < lengths_.size() && lengths_[i] < length) ++i;
    const double share = (length - lengths_[i - 1]) / (lengths_[i] - lengths_[i - 1]);
    return (1 - share) * corners_[i - 1] + share * corners_[i];
  }

  Vector3d Mean(double from, double to) const {
    constexpr int kSamples = 2000;
    Vector3d sum = Vector3d::Zero();
    for (int i = 0; i < kSamples; ++i) sum += At(from + (to - from) * (i + 0.5) / kSamples);
    return sum / kSamples;
  }

 private:
  std::vector<Vector3d> corners_;
  std::vector<double> lengths_;
};

class RoundedWayTest : public ::testing::Test {
 protected:
  double Random() { return std::uniform_real_distribution<double>(-1, 1)(generator_); }

  /// Ways of up to 3 m and turns on the spot, one after the other.
  std::vector<PlanarPose> RandomCorners() {
    std::vector<PlanarPose> corners = {{Random(), Random(), 3 * Random()}};
    for (int i = 0; i < 3; ++i) {
      corners.push_back(corners.back() * PlanarPose{1.6 + 1.4 * Random(), 0.5 * Random(), 0});
      corners.push_back(corners.back() * PlanarPose{0, 0, 1.5 * Random()});
    }
    return corners;
  }

  std::mt19937 generator_{11};
  static constexpr int kTrials = 40;
};

TEST_F(RoundedWayTest, StancesAreMeansOfTheWayAroundThem) {
  for (int trial = 0; trial < kTrials; ++trial) {
    const std::vector<PlanarPose> corners = RandomCorners();
    const SampledWay way(corners);
    const double half = 0.6 + 0.4 * Random();
    const auto lines = RoundedLines(corners, std::vector<double>(corners.size() - 2, half));
    ASSERT_EQ(lines.size(), 1u);
    const StanceLine& line = lines.front();
    for (std::size_t i = 0; i < line.size(); i += 7) {
      const double at =
          way.length() * static_cast<double>(i) / static_cast<double>(line.size() - 1);
      const double window = std::min({half, at, way.length() - at});
      const Vector3d mean = way.Mean(at - window, at + window);
      EXPECT_LT(Apart(line[i], {mean.x(), mean.y(), mean.z()}), 2e-3) << i;
    }
  }
}

TEST_F(RoundedWayTest, BeginsAndEndsWhereTheWayDoes) {
  for (int trial = 0; trial < kTrials; ++trial) {
    const std::vector<PlanarPose> corners = RandomCorners();
    std::vector<double> windows;
    for (std::size_t i = 2; i < corners.size(); ++i) windows.push_back(std::abs(Random()));
    const auto lines = RoundedLines(corners, windows);
    EXPECT_LT(Apart(lines.front().front(), corners.front()), 1e-12);
    EXPECT_LT(Apart(lines.back().back(), corners.back()), 1e-12);
  }
}

TEST_F(RoundedWayTest, PassesThroughCornersWithoutAWindowAndIsCutThere) {
  for (int trial = 0; trial < kTrials; ++trial) {
    const std::vector<PlanarPose> corners = RandomCorners();
    std::vector<double> windows(corners.size() - 2, 0.5);
    const std::size_t sharp = generator_() % windows.size();
    windows[sharp] = 0;
    const auto lines = RoundedLines(corners, windows);
    ASSERT_EQ(lines.size(), 2u);
    EXPECT_LT(Apart(lines[0].back(), corners[sharp + 1]), 1e-9);
    EXPECT_LT(Apart(lines[1].front(), corners[sharp + 1]), 1e-9);
  }
}

TEST_F(RoundedWayTest, WithoutAnyWindowIsTheStraightWay) {
  const std::vector<PlanarPose> corners = RandomCorners();
  const auto lines = RoundedLines(corners, std::vector<double>(corners.size() - 2, 0));
  ASSERT_EQ(lines.size(), corners.size() - 1);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    for (std::size_t k = 1; k + 1 < lines[i].size(); ++k) {
      EXPECT_FALSE(Bends(lines[i][k - 1], lines[i][k], lines[i][k + 1])) << i << ", " << k;
    }
  }
}

TEST_F(RoundedWayTest, NeighbouringStancesOfABendAreClose) {
  for (int trial = 0; trial < kTrials; ++trial) {
    const std::vector<PlanarPose> corners = RandomCorners();
    const auto lines = RoundedLines(corners, std::vector<double>(corners.size() - 2, 1));
    for (std::size_t i = 1; i < lines.front().size(); ++i) {
      const PlanarPose& from = lines.front()[i - 1];
      EXPECT_LT((lines.front()[i].position() - from.position()).norm(), 0.031);
    }
  }
}

TEST_F(RoundedWayTest, ATurnBetweenTwoWaysBecomesABendThatCutsTheCorner) {
  const std::vector<PlanarPose> corners = {{}, {2, 0, 0}, {2, 0, M_PI / 2}, {2, 2, M_PI / 2}};
  const auto lines = RoundedLines(corners, {0.5, 0.5});
  double nearest = std::numeric_limits<double>::infinity();
  double yaw = 0;
  for (const PlanarPose& stance : lines.front()) {
    nearest = std::min(nearest, (stance.position() - Vector2d(2, 0)).norm());
    EXPECT_GE(stance.yaw, yaw - 1e-12);
    yaw = stance.yaw;
  }
  // The mean over both sides of a corner, 0.5 m each, is 0.125 m from either way; the turn takes
  // a part of the window.
  EXPECT_GT(nearest, 0.1);
  EXPECT_LT(nearest, 0.125 * std::sqrt(2));
}

TEST(StraightLines, AreCutWhereStridesBend) {
  const PlanarPose corner{1, 0, 0};
  const auto lines =
      StraightLines({{}, {0.5, 0, 0}, corner, {1, 0, 0.3}, {1, 0, 0.6}, {1.5, 0, 0.6}});
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(lines[0].size(), 3u);
  EXPECT_LT(Apart(lines[1].front(), corner), 1e-12);
  EXPECT_LT(Apart(lines[1].back(), {1, 0, 0.6}), 1e-12);
  EXPECT_EQ(StraightLines({{}}).front().size(), 1u);
}

}  // namespace
}  // namespace possibility::actions
