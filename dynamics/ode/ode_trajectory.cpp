#include "dynamics/ode/ode_trajectory.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

namespace possibility::dynamics {

Eigen::VectorXd OdePiece::State(double time) const {
  const double s = (time - origin) / length;
  Eigen::VectorXd state = coefficients.rightCols<1>();
  for (Eigen::Index k = coefficients.cols() - 2; k >= 0; --k) {
    state = state * s + coefficients.col(k);
  }
  return state;
}

Eigen::VectorXd OdePiece::Rate(double time) const {
  const double s = (time - origin) / length;
  Eigen::VectorXd rate = Eigen::VectorXd::Zero(coefficients.rows());
  for (Eigen::Index k = coefficients.cols() - 1; k >= 1; --k) {
    rate = rate * s + static_cast<double>(k) * coefficients.col(k);
  }
  return rate / length;
}

OdeTrajectory::OdeTrajectory(double time, const Eigen::Ref<const Eigen::VectorXd>& state)
    : start_time_(time) {
  OdePiece point;
  point.origin = point.end = time;
  point.coefficients = state;
  pieces_.push_back(std::move(point));
}

std::vector<double> OdeTrajectory::StepTimes() const {
  std::vector<double> times = {start_time_};
  for (const OdePiece& piece : pieces_) {
    if (piece.end > times.back()) times.push_back(piece.end);
  }
  return times;
}

Eigen::VectorXd OdeTrajectory::State(double time) const { return PieceAt(time).State(time); }

Eigen::VectorXd OdeTrajectory::Rate(double time) const { return PieceAt(time).Rate(time); }

void OdeTrajectory::Append(OdePiece piece) {
  if (!(piece.end >= end_time())) {
    throw std::invalid_argument("OdeTrajectory: a piece ends before its predecessor");
  }
  // The initial point represents the trajectory only until there is a step.
  if (pieces_.size() == 1 && pieces_.front().coefficients.cols() == 1 &&
      pieces_.front().end == start_time_) {
    pieces_.clear();
  }
  pieces_.push_back(std::move(piece));
}

void OdeTrajectory::CutAt(double time) {
  while (pieces_.size() > 1 && pieces_[pieces_.size() - 2].end >= time) pieces_.pop_back();
  pieces_.back().end = time;
}

const OdePiece& OdeTrajectory::PieceAt(double time) const {
  const double rounding =
      8 * std::numeric_limits<double>::epsilon() * (1 + std::abs(start_time_) + std::abs(time));
  if (pieces_.empty() || !(time >= start_time_ - rounding && time <= end_time() + rounding)) {
    throw std::invalid_argument("OdeTrajectory: time " + std::to_string(time) + " is outside [" +
                                std::to_string(start_time_) + ", " + std::to_string(end_time()) +
                                "]");
  }
  const auto piece =
      std::lower_bound(pieces_.begin(), pieces_.end(), time,
                       [](const OdePiece& candidate, double t) { return candidate.end < t; });
  return piece == pieces_.end() ? pieces_.back() : *piece;
}

}  // namespace possibility::dynamics
