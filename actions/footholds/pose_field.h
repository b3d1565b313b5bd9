#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <functional>
#include <queue>
#include <utility>
#include <vector>

#include "actions/wholebody/planar_pose.h"
#include "common/cancellation_token.h"

namespace possibility::actions {

/// Times of the quickest ways to some goals among poses of a lattice in SE(2), by a search from the
/// goals towards the poses that are asked for first, which goes on as far as the questions need
/// (reverse resumable A*, Silver 2005). There is a lattice for each layer of the ground. A pose has
/// ten neighbours in its layer: eight cells around it, and a turn to either side; and itself in the
/// other layers. One thread at a time.
class PoseField {
 public:
  struct Paces {
    double ahead = 1;  ///< s/m, forwards or backwards
    double aside = 1;  ///< s/m
    double turn = 1;   ///< s/rad
  };
  /// What the ground alone knows.
  struct Ground {
    int layers = 1;
    /// How long it takes from a layer's ground near a place, s; infinite: it has none there.
    /// Between two poses at least the difference passes. Not asked if empty: there is ground
    /// everywhere.
    std::function<double(int layer, const Eigen::Vector2d&)> time;
    /// Where the difference is greater no way leads from the one to the other, s.
    double most = 0;
  };
  struct Goal {
    PlanarPose pose;
    int layer = 0;
    double time = 0;  ///< what its times begin with, s
  };
  /// A pose that will be asked for.
  struct Start {
    PlanarPose pose;
    int layer = 0;
  };
  static constexpr int kHeadings = 16;

  /// `bounds`, `cell`: m. `first_heading`: rad, one of the lattice's headings. `is_open`: of a pose
  /// of the lattice; asked once per pose, and only where a way or a question leads. The poses
  /// nearest to goals are open. `starts`: the search grows towards them; they change no time.
  PoseField(const Eigen::AlignedBox2d& bounds, double cell, double first_heading,
            const std::vector<Goal>& goals, const Paces& paces,
            std::function<bool(int layer, const PlanarPose&)> is_open, Ground ground,
            const std::vector<Start>& starts = {});

  /// From the nearest pose of the lattice, s. Infinite if that is not open or no way leads from
  /// there. @throws Cancelled.
  double At(int layer, const PlanarPose& pose, const CancellationToken& cancellation = {});

 private:
  static constexpr int kMovesOfAPose = 10;
  enum class State : signed char { kUnknown, kOpen, kClosed };

  /// A place in a layer that was asked for: a cell with ground, in any heading.
  struct Spot {
    int layer = 0;
    int column = 0, row = 0;
    double ground_time = 0;  ///< s
    /// Final where time and Rest are at most the value of the queue's first entry.
    std::array<double, kHeadings> times;
    std::array<State, kHeadings> states;
  };
  /// A pose that a way leads to, with its time.
  struct Entry {
    double value = 0;  ///< time and Rest, s
    double time = 0;
    int spot = 0;
    int heading = 0;
    bool operator>(const Entry& other) const {
      if (value != other.value) return value > other.value;
      return spot != other.spot ? spot > other.spot : heading > other.heading;
    }
  };

  bool IsOpen(int spot, int heading);
  Eigen::Vector2d CentreOf(int column, int row) const;
  /// Number of a spot; -1 if the layer has no ground there.
  int SpotAt(int layer, int column, int row);
  int SpotAt(int layer, const PlanarPose& pose);
  int HeadingOf(const PlanarPose& pose) const;
  /// At least, from a pose to the nearest start, s.
  double Rest(int spot, int heading) const;
  void Push(double time, int spot, int heading);
  void Visit(const Entry& at);
  void Offer(int from, int spot, int heading, double begin, double move);

  Eigen::AlignedBox2d bounds_;
  double cell_;
  double first_heading_;
  int columns_ = 1, rows_ = 1;
  Paces paces_;
  std::function<bool(int, const PlanarPose&)> is_open_;
  Ground ground_;
  std::array<std::array<double, kMovesOfAPose>, kHeadings> times_of_moves_;  ///< by heading, s
  std::vector<int> numbers_;  ///< of spots, by layer and cell; kUnknownSpot: not asked yet
  std::vector<Spot> spots_;
  std::vector<std::pair<int, int>> starts_;  ///< spot and heading; empty: grows to all sides
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
  std::size_t visited_ = 0;
};

}  // namespace possibility::actions
