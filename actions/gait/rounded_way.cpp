#include "actions/gait/rounded_way.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace possibility::actions {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Ways differ if a stride moves or turns the stance by more, m and rad.
constexpr double kBend = 1e-6;

/// Radius that makes a length of a heading, m.
constexpr double kHeadingRadius = 0.03;

/// Distance of the stances of a rounded line, m.
constexpr double kSpacing = 0.03;

/// A straight way through corners by its length, with headings that do not jump.
class CornerWay {
 public:
  explicit CornerWay(const std::vector<PlanarPose>& corners) {
    for (const PlanarPose& corner : corners) Append(corner);
  }

  double length() const { return lengths_.back(); }
  double LengthTo(std::size_t corner) const { return lengths_[corner]; }

  /// Mean of the way from `from` to `to`; the stance there if they are the same.
  PlanarPose Mean(double from, double to) const {
    if (to - from < kBend) return Pose(At((from + to) / 2));
    return Pose((IntegralTo(to) - IntegralTo(from)) / (to - from));
  }

 private:
  void Append(const PlanarPose& corner) {
    Vector3d pose(corner.x, corner.y, corner.yaw);
    if (poses_.empty()) {
      poses_ = {pose};
      lengths_ = {0};
      integrals_ = {Vector3d::Zero()};
      return;
    }
    const Vector3d& last = poses_.back();
    pose.z() = last.z() + WrapAngle(corner.yaw - last.z());
    const double length =
        (pose - last).head<2>().norm() + kHeadingRadius * std::abs(pose.z() - last.z());
    integrals_.push_back(integrals_.back() + length * (pose + last) / 2);
    lengths_.push_back(lengths_.back() + length);
    poses_.push_back(pose);
  }

  static PlanarPose Pose(const Vector3d& pose) { return {pose.x(), pose.y(), pose.z()}; }

  std::size_t LineAt(double length) const {
    const auto next = std::upper_bound(lengths_.begin() + 1, lengths_.end() - 1, length);
    return static_cast<std::size_t>(next - lengths_.begin()) - 1;
  }
  Vector3d At(double length) const {
    const std::size_t line = LineAt(length);
    const double whole = lengths_[line + 1] - lengths_[line];
    const double share = whole > 0 ? (length - lengths_[line]) / whole : 0;
    return poses_[line] + share * (poses_[line + 1] - poses_[line]);
  }
  Vector3d IntegralTo(double length) const {
    const std::size_t line = LineAt(length);
    return integrals_[line] + (length - lengths_[line]) * (poses_[line] + At(length)) / 2;
  }

  std::vector<Vector3d> poses_;  ///< x, y, heading
  std::vector<double> lengths_;
  std::vector<Vector3d> integrals_;  ///< of the pose, up to each corner
};

/// Half the window at a length of the way.
double Window(const CornerWay& way, const std::vector<double>& windows, double at) {
  double window = std::min(at, way.length() - at);
  if (!windows.empty()) {
    window = std::min(window, *std::max_element(windows.begin(), windows.end()));
  }
  for (std::size_t i = 0; i < windows.size(); ++i) {
    window = std::min(window, windows[i] + std::abs(way.LengthTo(i + 1) - at));
  }
  return std::max(window, 0.0);
}

}  // namespace

bool Bends(const PlanarPose& a, const PlanarPose& b, const PlanarPose& c) {
  const Vector2d before = b.position() - a.position();
  const Vector2d after = c.position() - b.position();
  const double turn = WrapAngle(c.yaw - b.yaw) - WrapAngle(b.yaw - a.yaw);
  return (after - before).norm() > kBend || std::abs(turn) > kBend;
}

std::vector<StanceLine> StraightLines(const std::vector<PlanarPose>& strides) {
  std::vector<StanceLine> lines = {{strides.front()}};
  for (std::size_t i = 1; i < strides.size(); ++i) {
    lines.back().push_back(strides[i]);
    const bool bends = i + 1 < strides.size() && Bends(strides[i - 1], strides[i], strides[i + 1]);
    if (bends) lines.push_back({strides[i]});
  }
  return lines;
}

std::vector<StanceLine> RoundedLines(const std::vector<PlanarPose>& corners,
                                     const std::vector<double>& windows) {
  const CornerWay way(corners);
  std::vector<double> ends;  // of the lines
  for (std::size_t i = 0; i < windows.size(); ++i) {
    const bool cuts = windows[i] <= 0 && Bends(corners[i], corners[i + 1], corners[i + 2]);
    if (cuts) ends.push_back(way.LengthTo(i + 1));
  }
  ends.push_back(way.length());
  std::vector<StanceLine> lines;
  double begin = 0;
  for (const double end : ends) {
    const int parts = std::max(1, static_cast<int>(std::ceil((end - begin) / kSpacing)));
    lines.emplace_back();
    for (int i = 0; i <= parts; ++i) {
      const double at = begin + (end - begin) * i / parts;
      const double window = Window(way, windows, at);
      lines.back().push_back(way.Mean(at - window, at + window));
    }
    begin = end;
  }
  return lines;
}

}  // namespace possibility::actions
