#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "graph/action/exploration_space.h"

namespace possibility::actions {

/// A point of E is a pelvis pose: x, y, z (m), then the quaternion w, x, y, z.
graph::Point ToPoint(const Eigen::Isometry3d& X_WR);
Eigen::Isometry3d ToPose(const graph::Point& point);

/// Poses of which all numbers agree to this are the same, m (and elements of the quaternion).
inline constexpr double kSamePose = 1e-6;
bool IsSamePose(const graph::Point& a, const graph::Point& b);

/// Heading of the pelvis: yaw of the decomposition Rz(yaw) Ry(pitch) Rx(roll).
double Heading(const Eigen::Matrix3d& R_WR);

/// Pose between `a` and `b`, s in [0, 1]: linear in position, the shorter way in heading, and the
/// shortest rotation in the remaining tilt.
Eigen::Isometry3d Interpolate(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b, double s);

/// E for one environment: pelvis poses over its bounds and ground levels.
class PelvisPoseSpace : public graph::ExplorationSpace {
 public:
  /// The metric weights a radian by `rotation_weight` and a metre by 1 - `rotation_weight`.
  PelvisPoseSpace(const Eigen::AlignedBox2d& bounds, std::vector<double> ground_levels,
                  double rotation_weight);

  /// From now on every second sample is near one of these: at most `spread` (m) away in x and in y,
  /// and a radian for each metre in heading. For searches that know where a way may lead out.
  void Guide(std::vector<graph::Point> samples, double spread);

  /// Upright pose, uniform in x, y and heading, one metre above one of the levels.
  graph::Point RandomSample(graph::RandomGenerator* generator) const override;
  double Distance(const graph::Point& a, const graph::Point& b) const override;

 private:
  graph::Point SampleNearGuide(graph::RandomGenerator* generator) const;

  Eigen::AlignedBox2d bounds_;
  std::vector<double> ground_levels_;
  double rotation_weight_;
  std::vector<graph::Point> guides_;
  double guide_spread_ = 0;  ///< m
};

}  // namespace possibility::actions
