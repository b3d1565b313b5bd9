#include "experiments/imports/sample_rates.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

#include "experiments/imports/contact_phases.h"
#include "experiments/imports/differences.h"
#include "models/robot/rotation_vector.h"

namespace possibility::experiments {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr int kStencil = 7;  // samples: sixth order where they are evenly spaced
/// Samples near the ends of a run. There a polynomial extrapolates, and the more so the higher its
/// degree: where feet lift after 40 ms on both, seven samples every 4 ms gave a walk accelerations
/// that were wrong by up to 2 rad/s^2, five by half of that.
constexpr int kStencilAtEnds = 5;
constexpr int kShortestRun = 4;  // a shorter run borrows samples of its neighbours

Eigen::Quaterniond Orientation(const VectorXd& q) { return {q[0], q[1], q[2], q[3]}; }

/// q relative to the orientation of `origin`: rotation vector, position, joints. At `origin` itself
/// the derivatives of the rotation vector are the angular velocity and acceleration.
VectorXd Coordinates(const VectorXd& q, const VectorXd& origin) {
  VectorXd x(q.size() - 1);
  x << models::RotationVector(Eigen::Quaterniond(Orientation(q) * Orientation(origin).conjugate())),
      q.tail(q.size() - 4);
  return x;
}

/// The samples whose times are nearest to that of `i`, within [first, last], each time once.
std::vector<int> Stencil(const ImportedTrajectory& trajectory, int i, int first, int last) {
  std::vector<int> stencil = {i};
  int before = i - 1;
  int after = i + 1;
  const auto time = [&](int k) { return trajectory.samples[k].t; };
  const bool is_inside = std::min(i - first, last - i) >= kStencil / 2;
  while (static_cast<int>(stencil.size()) < (is_inside ? kStencil : kStencilAtEnds)) {
    while (before >= first && time(stencil.front()) - time(before) < kSameTime) --before;
    while (after <= last && time(after) - time(stencil.back()) < kSameTime) ++after;
    const bool has_before = before >= first;
    const bool has_after = after <= last;
    if (!has_before && !has_after) break;
    if (has_before && (!has_after || time(i) - time(before) < time(after) - time(i))) {
      stencil.insert(stencil.begin(), before--);
    } else {
      stencil.push_back(after++);
    }
  }
  return stencil;
}

void SetRates(const ImportedTrajectory& trajectory, int i, const std::vector<int>& stencil,
              SampleRates* rates) {
  const ImportedSample& sample = trajectory.samples[i];
  std::vector<double> times;
  for (const int k : stencil) times.push_back(trajectory.samples[k].t);
  const DifferenceWeights weights = WeightsAt(sample.t, times);
  VectorXd first = VectorXd::Zero(sample.q.size() - 1);
  VectorXd second = first;
  for (std::size_t k = 0; k < stencil.size(); ++k) {
    const ImportedSample& other = trajectory.samples[stencil[k]];
    const VectorXd x = Coordinates(other.q, sample.q);
    first += weights.first[static_cast<Index>(k)] * x;
    second += trajectory.has_velocities() ? VectorXd(weights.first[static_cast<Index>(k)] * other.v)
                                          : VectorXd(weights.second[static_cast<Index>(k)] * x);
  }
  rates->v[i] = trajectory.has_velocities() ? sample.v : first;
  rates->a[i] = trajectory.has_accelerations() ? sample.a : second;
}

}  // namespace

SampleRates RatesOf(const ImportedTrajectory& trajectory) {
  const int n = static_cast<int>(trajectory.samples.size());
  SampleRates rates{std::vector<VectorXd>(n), std::vector<VectorXd>(n)};
  for (const auto& [begin, end] : SteadyRuns(trajectory)) {
    const bool is_short = end - begin < kShortestRun;
    const int first = is_short ? std::max(0, begin - kShortestRun) : begin;
    const int last = is_short ? std::min(n, end + kShortestRun) - 1 : end - 1;
    for (int i = begin; i < end; ++i) {
      SetRates(trajectory, i, Stencil(trajectory, i, first, last), &rates);
    }
  }
  if (trajectory.has_velocities()) return rates;
  for (const int i : {0, n - 1}) {
    rates.v[i].setZero();
    rates.a[i].setZero();
  }
  return rates;
}

}  // namespace possibility::experiments
