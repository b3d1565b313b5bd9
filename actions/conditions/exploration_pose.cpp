#include "actions/conditions/exploration_pose.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "actions/wholebody/planar_pose.h"
#include "graph/action/random.h"

namespace possibility::actions {
namespace {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

Quaterniond Yaw(double yaw) { return Quaterniond(Eigen::AngleAxisd(yaw, Vector3d::UnitZ())); }

/// Uniform in [0, 1), the same on every platform.
double Uniform(graph::RandomGenerator* generator) {
  return static_cast<double>((*generator)() >> 11) * 0x1.0p-53;
}

Quaterniond Orientation(const graph::Point& p) { return {p[3], p[4], p[5], p[6]}; }

}  // namespace

graph::Point ToPoint(const Isometry3d& X_WR) {
  Quaterniond orientation(X_WR.linear());
  if (orientation.w() < 0) orientation.coeffs() *= -1;
  graph::Point point(7);
  point << X_WR.translation(), orientation.w(), orientation.vec();
  return point;
}

Isometry3d ToPose(const graph::Point& point) {
  Isometry3d X_WR = Isometry3d::Identity();
  X_WR.translation() = point.head<3>();
  X_WR.linear() = Orientation(point).normalized().toRotationMatrix();
  return X_WR;
}

bool IsSamePose(const graph::Point& a, const graph::Point& b) {
  return (a - b).lpNorm<Eigen::Infinity>() < kSamePose;
}

double Heading(const Matrix3d& R_WR) { return std::atan2(R_WR(1, 0), R_WR(0, 0)); }

Isometry3d Interpolate(const Isometry3d& a, const Isometry3d& b, double s) {
  const double yaw_a = Heading(a.linear());
  const double yaw_b = Heading(b.linear());
  const Quaterniond tilt_a = Yaw(-yaw_a) * Quaterniond(a.linear());
  const Quaterniond tilt_b = Yaw(-yaw_b) * Quaterniond(b.linear());
  Isometry3d result = Isometry3d::Identity();
  result.translation() = (1 - s) * a.translation() + s * b.translation();
  result.linear() =
      (Yaw(yaw_a + s * WrapAngle(yaw_b - yaw_a)) * tilt_a.slerp(s, tilt_b)).toRotationMatrix();
  return result;
}

PelvisPoseSpace::PelvisPoseSpace(const Eigen::AlignedBox2d& bounds,
                                 std::vector<double> ground_levels, double rotation_weight)
    : bounds_(bounds),
      ground_levels_(std::move(ground_levels)),
      rotation_weight_(rotation_weight) {}

void PelvisPoseSpace::Guide(std::vector<graph::Point> samples, double spread) {
  guides_ = std::move(samples);
  guide_spread_ = spread;
}

/// Where the way is narrow, only small deviations help: spreads of all sizes are equally likely.
graph::Point PelvisPoseSpace::SampleNearGuide(graph::RandomGenerator* generator) const {
  constexpr int kMostHalvings = 5;
  const std::size_t i = graph::UniformIndex(guides_.size(), generator);
  const double spread =
      std::ldexp(guide_spread_, -static_cast<int>(graph::UniformIndex(kMostHalvings, generator)));
  Isometry3d sample = ToPose(guides_[i]);
  sample.translation().x() += graph::UniformReal(-spread, spread, generator);
  sample.translation().y() += graph::UniformReal(-spread, spread, generator);
  sample.linear() = Yaw(graph::UniformReal(-spread, spread, generator)) * sample.linear();
  return ToPoint(sample);
}

graph::Point PelvisPoseSpace::RandomSample(graph::RandomGenerator* generator) const {
  if (!guides_.empty() && graph::UniformIndex(2, generator) == 0) return SampleNearGuide(generator);
  const double x = Uniform(generator), y = Uniform(generator), yaw = Uniform(generator);
  const double level = Uniform(generator) * static_cast<double>(ground_levels_.size());
  const Eigen::Vector2d size = bounds_.sizes();
  const PlanarPose pose{bounds_.min().x() + x * size.x(), bounds_.min().y() + y * size.y(),
                        (2 * yaw - 1) * std::numbers::pi};
  return ToPoint(pose.At(ground_levels_[static_cast<size_t>(level)] + 1));
}

double PelvisPoseSpace::Distance(const graph::Point& a, const graph::Point& b) const {
  // The chord is exactly 0 for equal orientations; an arc cosine is not.
  const double chord =
      std::min((a.tail<4>() - b.tail<4>()).norm(), (a.tail<4>() + b.tail<4>()).norm());
  const double angle = 4 * std::asin(std::min(1.0, chord / 2));
  return (1 - rotation_weight_) * (a.head<3>() - b.head<3>()).norm() + rotation_weight_ * angle;
}

}  // namespace possibility::actions
