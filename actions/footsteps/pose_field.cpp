#include "actions/footsteps/pose_field.h"

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
                     const std::vector<PlanarPose>& goals, const Paces& paces,
                     std::function<bool(const PlanarPose&)> is_open,
                     std::function<double(const Eigen::Vector2d&)> height,
                     const std::vector<double>& goal_times)
    : bounds_(bounds),
      cell_(cell),
      first_heading_(first_heading),
      paces_(paces),
      is_open_(std::move(is_open)),
      height_(std::move(height)),
      times_of_moves_(TimesOfMoves(cell, first_heading, paces)) {
  columns_ = std::max(1, static_cast<int>(std::ceil(bounds.sizes().x() / cell)));
  rows_ = std::max(1, static_cast<int>(std::ceil(bounds.sizes().y() / cell)));
  const std::size_t poses = Index(0, rows_, 0);
  times_.assign(poses, std::numeric_limits<double>::infinity());
  states_.assign(poses, State::kUnknown);
  if (height_) heights_.assign(poses / kHeadings, std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < goals.size(); ++i) {
    const std::size_t index = IndexOf(goals[i]);
    const double time = goal_times.empty() ? 0 : goal_times[i];
    states_[index] = State::kOpen;
    if (time >= times_[index]) continue;
    times_[index] = time;
    queue_.push({time, index});
  }
}

bool PoseField::IsOpen(std::size_t index) {
  if (states_[index] == State::kUnknown) {
    const Vector2d p = CentreOf(index / kHeadings);
    const double yaw = first_heading_ + static_cast<double>(index % kHeadings) * kTurn;
    states_[index] = is_open_({p.x(), p.y(), yaw}) ? State::kOpen : State::kClosed;
  }
  return states_[index] == State::kOpen;
}

Vector2d PoseField::CentreOf(std::size_t place) const {
  return bounds_.min() + cell_ * Vector2d(static_cast<double>(place % columns_) + 0.5,
                                          static_cast<double>(place / columns_) + 0.5);
}

double PoseField::HeightOf(std::size_t place) {
  double& height = heights_[place];
  if (std::isnan(height)) height = height_(CentreOf(place));
  return height;
}

double PoseField::ClimbTime(std::size_t from, std::size_t to) {
  if (heights_.empty() || from == to) return 0;
  const double climb = std::abs(HeightOf(to) - HeightOf(from));
  return climb <= paces_.most_climb ? paces_.climb * climb : 0;
}

double PoseField::At(const PlanarPose& pose, const CancellationToken& cancellation) {
  const std::size_t index = IndexOf(pose);
  if (!IsOpen(index)) return std::numeric_limits<double>::infinity();
  while (!queue_.empty() && queue_.top().time < times_[index]) {
    const Entry at = queue_.top();
    queue_.pop();
    if (at.time > times_[at.index]) continue;
    if (++visited_ % kPosesPerQuestion == 0) cancellation.ThrowIfCancelled();
    Visit(at);
  }
  return times_[index];
}

void PoseField::Visit(const Entry& at) {
  const auto place = static_cast<int>(at.index / kHeadings);
  const auto at_heading = static_cast<int>(at.index % kHeadings);
  for (std::size_t i = 0; i < std::size(kMoves); ++i) {
    const Move& move = kMoves[i];
    const int column = place % columns_ + move.column;
    const int row = place / columns_ + move.row;
    if (column < 0 || row < 0 || column >= columns_ || row >= rows_) continue;
    const int heading = (at_heading + move.heading + kHeadings) % kHeadings;
    const std::size_t index = Index(column, row, heading);
    const double time = at.time + times_of_moves_[at_heading][i] +
                        ClimbTime(at.index / kHeadings, index / kHeadings);
    if (time >= times_[index] || !IsOpen(index)) continue;
    times_[index] = time;
    queue_.push({time, index});
  }
}

std::size_t PoseField::IndexOf(const PlanarPose& pose) const {
  const Vector2d at = (pose.position() - bounds_.min()) / cell_;
  const double turns = WrapAngle(pose.yaw - first_heading_) / kTurn;
  const int heading = (static_cast<int>(std::lround(turns)) + kHeadings) % kHeadings;
  return Index(Cell(at.x(), columns_), Cell(at.y(), rows_), heading);
}

}  // namespace possibility::actions
