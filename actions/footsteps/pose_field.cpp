#include "actions/footsteps/pose_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <queue>

namespace possibility::actions {
namespace {

using Eigen::Vector2d;

constexpr std::size_t kPosesPerQuestion = 1000;
constexpr double kTurn = 2 * std::numbers::pi / PoseField::kHeadings;

struct Entry {
  double time = 0;
  int column = 0, row = 0, heading = 0;
  bool operator>(const Entry& other) const { return time > other.time; }
};

struct Move {
  int column = 0, row = 0, heading = 0;
};

constexpr Move kMoves[] = {{1, 0, 0},   {1, 1, 0},  {0, 1, 0},  {-1, 1, 0}, {-1, 0, 0},
                           {-1, -1, 0}, {0, -1, 0}, {1, -1, 0}, {0, 0, 1},  {0, 0, -1}};

using Times = std::array<std::array<double, std::size(kMoves)>, PoseField::kHeadings>;

/// Of the moves from each heading, s.
Times TimesOfMoves(double cell, double first_heading, const PoseField::Paces& paces) {
  Times times;
  for (int heading = 0; heading < PoseField::kHeadings; ++heading) {
    const Eigen::Rotation2Dd turned(first_heading + heading * kTurn);
    for (std::size_t i = 0; i < std::size(kMoves); ++i) {
      const Move& move = kMoves[i];
      const Vector2d way = turned.inverse() * (cell * Vector2d(move.column, move.row));
      times[heading][i] = paces.ahead * std::abs(way.x()) + paces.aside * std::abs(way.y()) +
                          paces.turn * kTurn * std::abs(move.heading);
    }
  }
  return times;
}

int Cell(double at, int count) {
  return static_cast<int>(std::clamp(std::floor(at), 0.0, count - 1.0));
}

}  // namespace

PoseField::PoseField(const Eigen::AlignedBox2d& bounds, double cell, double first_heading,
                     const std::vector<PlanarPose>& goals, const Paces& paces,
                     const std::function<bool(const PlanarPose&)>& is_open,
                     const CancellationToken& cancellation)
    : bounds_(bounds), cell_(cell), first_heading_(first_heading) {
  columns_ = std::max(1, static_cast<int>(std::ceil(bounds.sizes().x() / cell)));
  rows_ = std::max(1, static_cast<int>(std::ceil(bounds.sizes().y() / cell)));
  const std::size_t poses = Index(0, rows_, 0);
  times_.assign(poses, std::numeric_limits<double>::infinity());
  std::vector<signed char> open(poses, -1);  // not asked yet
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  for (const PlanarPose& goal : goals) {
    const std::size_t index = IndexOf(goal);
    times_[index] = 0;
    const auto place = static_cast<int>(index / kHeadings);
    queue.push({0, place % columns_, place / columns_, static_cast<int>(index % kHeadings)});
  }
  const Times times_of_moves = TimesOfMoves(cell, first_heading, paces);
  std::size_t visited = 0;
  while (!queue.empty()) {
    const Entry at = queue.top();
    queue.pop();
    if (at.time > times_[Index(at.column, at.row, at.heading)]) continue;
    if (++visited % kPosesPerQuestion == 0) cancellation.ThrowIfCancelled();
    for (std::size_t i = 0; i < std::size(kMoves); ++i) {
      const Move& move = kMoves[i];
      const int column = at.column + move.column;
      const int row = at.row + move.row;
      if (column < 0 || row < 0 || column >= columns_ || row >= rows_) continue;
      const int heading = (at.heading + move.heading + kHeadings) % kHeadings;
      const double time = at.time + times_of_moves[at.heading][i];
      const std::size_t index = Index(column, row, heading);
      if (time >= times_[index]) continue;
      if (open[index] < 0) {
        const Vector2d p = bounds_.min() + cell_ * Vector2d(column + 0.5, row + 0.5);
        open[index] = is_open({p.x(), p.y(), first_heading_ + heading * kTurn}) ? 1 : 0;
      }
      if (open[index] == 0) continue;
      times_[index] = time;
      queue.push({time, column, row, heading});
    }
  }
}

std::size_t PoseField::IndexOf(const PlanarPose& pose) const {
  const Vector2d at = (pose.position() - bounds_.min()) / cell_;
  const double turns = WrapAngle(pose.yaw - first_heading_) / kTurn;
  const int heading = (static_cast<int>(std::lround(turns)) + kHeadings) % kHeadings;
  return Index(Cell(at.x(), columns_), Cell(at.y(), rows_), heading);
}

}  // namespace possibility::actions
