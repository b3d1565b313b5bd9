#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <functional>
#include <limits>
#include <queue>
#include <vector>

#include "actions/motion/planar_pose.h"
#include "common/cancellation_token.h"

namespace possibility::actions {

/// Times of the quickest ways to some goals among poses of a lattice in SE(2), by Dijkstra's
/// algorithm, which runs as far as the questions need. A pose has ten neighbours: eight cells
/// around it, and a turn to either side. One thread at a time.
class PoseField {
 public:
  struct Paces {
    double ahead = 1;  ///< s/m, forwards or backwards
    double aside = 1;  ///< s/m
    double turn = 1;   ///< s/rad
    double climb = 0;  ///< s/m, up or down, between cells that differ by most_climb at most
    double most_climb = std::numeric_limits<double>::infinity();  ///< m
  };
  static constexpr int kHeadings = 16;

  /// `bounds`, `cell`: m. `first_heading`: rad, one of the lattice's headings. `is_open`: of a pose
  /// of the lattice; asked once per pose, and only where a way or a question leads. The poses
  /// nearest to goals are open. `height`: of the ground at a cell's centre, m; none if it is level.
  /// `goal_times`: what each goal's times begin with, s; empty: 0.
  PoseField(const Eigen::AlignedBox2d& bounds, double cell, double first_heading,
            const std::vector<PlanarPose>& goals, const Paces& paces,
            std::function<bool(const PlanarPose&)> is_open,
            std::function<double(const Eigen::Vector2d&)> height = {},
            const std::vector<double>& goal_times = {});

  /// From the nearest pose of the lattice, s. Infinite if that is not open or no way leads from
  /// there. @throws Cancelled.
  double At(const PlanarPose& pose, const CancellationToken& cancellation = {});

 private:
  static constexpr int kMovesOfAPose = 10;
  enum class State : signed char { kUnknown, kOpen, kClosed };

  /// A pose that a way leads to, with its time.
  struct Entry {
    double time = 0;
    std::size_t index = 0;
    bool operator>(const Entry& other) const {
      return time != other.time ? time > other.time : index > other.index;
    }
  };

  bool IsOpen(std::size_t index);
  // A place is a cell, in any heading.
  Eigen::Vector2d CentreOf(std::size_t place) const;
  double HeightOf(std::size_t place);
  double ClimbTime(std::size_t from, std::size_t to);
  void Visit(const Entry& at);
  std::size_t IndexOf(const PlanarPose& pose) const;
  std::size_t Index(int column, int row, int heading) const {
    return (static_cast<std::size_t>(row) * columns_ + column) * kHeadings + heading;
  }

  Eigen::AlignedBox2d bounds_;
  double cell_;
  double first_heading_;
  int columns_ = 1, rows_ = 1;
  Paces paces_;
  std::function<bool(const PlanarPose&)> is_open_;
  std::function<double(const Eigen::Vector2d&)> height_;
  std::array<std::array<double, kMovesOfAPose>, kHeadings> times_of_moves_;  ///< by heading, s
  std::vector<double> times_;  ///< final up to the time of the queue's first entry
  std::vector<State> states_;
  std::vector<double> heights_;  ///< by place; NaN: not asked yet
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
  std::size_t visited_ = 0;
};

}  // namespace possibility::actions
