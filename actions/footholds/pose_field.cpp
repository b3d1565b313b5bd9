#include "actions/footholds/pose_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <utility>

namespace possibility::actions {
namespace {

using Eigen::Vector2d;

constexpr std::size_t kPosesPerQuestion = 1000;
constexpr int kUnknownSpot = -2;
/// Among more the search grows to all sides.
constexpr std::size_t kMostStarts = 4;
constexpr double kTurn = 2 * std::numbers::pi / PoseField::kHeadings;

struct Move {
  int column = 0, row = 0, heading = 0;
};

constexpr Move kMoves[] = {{1, 0, 0},   {1, 1, 0},  {0, 1, 0},  {-1, 1, 0}, {-1, 0, 0},
                           {-1, -1, 0}, {0, -1, 0}, {1, -1, 0}, {0, 0, 1},  {0, 0, -1}};

/// Of the moves from each heading, s.
std::array<std::array<double, std::size(kMoves)>, PoseField::kHeadings> TimesOfMoves(
    double cell, double first_heading, const PoseField::Paces& paces) {
  std::array<std::array<double, std::size(kMoves)>, PoseField::kHeadings> times;
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
                     const std::vector<Goal>& goals, const Paces& paces,
                     std::function<bool(int, const PlanarPose&)> is_open, Ground ground,
                     const std::vector<Start>& starts)
    : bounds_(bounds),
      cell_(cell),
      first_heading_(first_heading),
      paces_(paces),
      is_open_(std::move(is_open)),
      ground_(std::move(ground)),
      times_of_moves_(TimesOfMoves(cell, first_heading, paces)) {
  columns_ = std::max(1, static_cast<int>(std::ceil(bounds.sizes().x() / cell)));
  rows_ = std::max(1, static_cast<int>(std::ceil(bounds.sizes().y() / cell)));
  numbers_.assign(static_cast<std::size_t>(columns_) * rows_ * ground_.layers, kUnknownSpot);
  if (starts.size() <= kMostStarts) {
    for (const Start& start : starts) {
      const int spot = SpotAt(start.layer, start.pose);
      if (spot >= 0) starts_.emplace_back(spot, HeadingOf(start.pose));
    }
  }
  for (const Goal& goal : goals) {
    const int spot = SpotAt(goal.layer, goal.pose);
    if (spot < 0) continue;
    const int heading = HeadingOf(goal.pose);
    spots_[spot].states[heading] = State::kOpen;
    if (goal.time >= spots_[spot].times[heading]) continue;
    Push(goal.time, spot, heading);
  }
}

bool PoseField::IsOpen(int spot, int heading) {
  Spot& at = spots_[spot];
  if (at.states[heading] == State::kUnknown) {
    const Vector2d p = CentreOf(at.column, at.row);
    const bool is_open = is_open_(at.layer, {p.x(), p.y(), first_heading_ + heading * kTurn});
    at.states[heading] = is_open ? State::kOpen : State::kClosed;
  }
  return at.states[heading] == State::kOpen;
}

Vector2d PoseField::CentreOf(int column, int row) const {
  return bounds_.min() + cell_ * Vector2d(column + 0.5, row + 0.5);
}

int PoseField::SpotAt(int layer, int column, int row) {
  int& number = numbers_[(static_cast<std::size_t>(layer) * rows_ + row) * columns_ + column];
  if (number != kUnknownSpot) return number;
  const double time = ground_.time ? ground_.time(layer, CentreOf(column, row)) : 0;
  if (!std::isfinite(time)) return number = -1;
  number = static_cast<int>(spots_.size());
  Spot spot{layer, column, row, time, {}, {}};
  spot.times.fill(std::numeric_limits<double>::infinity());
  spot.states.fill(State::kUnknown);
  spots_.push_back(spot);
  return number;
}

int PoseField::SpotAt(int layer, const PlanarPose& pose) {
  const Vector2d at = (pose.position() - bounds_.min()) / cell_;
  return SpotAt(layer, Cell(at.x(), columns_), Cell(at.y(), rows_));
}

int PoseField::HeadingOf(const PlanarPose& pose) const {
  const double turns = WrapAngle(pose.yaw - first_heading_) / kTurn;
  return (static_cast<int>(std::lround(turns)) + kHeadings) % kHeadings;
}

double PoseField::At(int layer, const PlanarPose& pose, const CancellationToken& cancellation) {
  const int spot = SpotAt(layer, pose);
  const int heading = HeadingOf(pose);
  if (spot < 0 || !IsOpen(spot, heading)) return std::numeric_limits<double>::infinity();
  const double rest = Rest(spot, heading);
  while (!queue_.empty() && queue_.top().value < spots_[spot].times[heading] + rest) {
    const Entry at = queue_.top();
    queue_.pop();
    if (at.time > spots_[at.spot].times[at.heading]) continue;
    if (++visited_ % kPosesPerQuestion == 0) cancellation.ThrowIfCancelled();
    Visit(at);
  }
  return spots_[spot].times[heading];
}

/// By the way through the air, and by what the ground alone knows. It never changes by more than a
/// move takes, so that a pose's time is final when the search visits it.
double PoseField::Rest(int spot, int heading) const {
  if (starts_.empty()) return 0;
  const Spot& at = spots_[spot];
  const double pace = cell_ * std::min(paces_.ahead, paces_.aside);
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [start, start_heading] : starts_) {
    const Spot& there = spots_[start];
    const int turns = std::abs(heading - start_heading);
    const double way = pace * std::hypot(there.column - at.column, there.row - at.row) +
                       paces_.turn * kTurn * std::min(turns, kHeadings - turns);
    least = std::min(least, std::max(way, std::abs(there.ground_time - at.ground_time)));
  }
  return least;
}

void PoseField::Push(double time, int spot, int heading) {
  spots_[spot].times[heading] = time;
  queue_.push({time + Rest(spot, heading), time, spot, heading});
}

void PoseField::Visit(const Entry& at) {
  const int layer = spots_[at.spot].layer;
  const int from_column = spots_[at.spot].column, from_row = spots_[at.spot].row;
  for (std::size_t i = 0; i < std::size(kMoves); ++i) {
    const Move& move = kMoves[i];
    const int column = from_column + move.column;
    const int row = from_row + move.row;
    if (column < 0 || row < 0 || column >= columns_ || row >= rows_) continue;
    const int heading = (at.heading + move.heading + kHeadings) % kHeadings;
    Offer(at.spot, SpotAt(layer, column, row), heading, at.time, times_of_moves_[at.heading][i]);
  }
  for (int other = 0; other < ground_.layers; ++other) {
    if (other == layer) continue;
    Offer(at.spot, SpotAt(other, from_column, from_row), at.heading, at.time, 0);
  }
}

void PoseField::Offer(int from, int spot, int heading, double begin, double move) {
  if (spot < 0) return;
  double& known = spots_[spot].times[heading];
  if (begin + move >= known) return;
  const double change = std::abs(spots_[spot].ground_time - spots_[from].ground_time);
  if (change > ground_.most) return;
  const double time = begin + std::max(move, change);
  if (time >= known || !IsOpen(spot, heading)) return;
  Push(time, spot, heading);
}

}  // namespace possibility::actions
