#include "collocation/transcription/trajectory.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace possibility::collocation {

namespace {

/// Coordinates differentiated `order` times, as if all were of the order `highest`.
Eigen::VectorXd OfOneOrder(const PhaseTrajectory& motion, const MeshPlace& place, int order,
                           int highest) {
  const auto [interval, c] = place;
  const int inside = motion.scheme.num_nodes() - 1;
  const int first = interval * inside;
  const double h = (motion.mesh[interval + 1] - motion.mesh[interval]) * motion.duration;
  const auto nodes = motion.coordinates[highest].middleCols(first, inside + 1);
  if (order > highest) return nodes * motion.scheme.LagrangeSlopes(c) / h;
  // Taylor polynomial at the interval's start, plus the repeated integral of the highest
  // derivative.
  Eigen::VectorXd value = Eigen::VectorXd::Zero(nodes.rows());
  double factor = 1;
  for (int r = order; r < highest; ++r) {
    value += factor * motion.coordinates[r].col(first);
    factor *= c * h / (r - order + 1);
  }
  const int k = highest - order;
  Eigen::VectorXd weights = motion.scheme.LagrangeIntegrals(c, k);
  for (int step = 0; step < k; ++step) weights *= h;
  value.noalias() += nodes * weights;
  return value;
}

}  // namespace

std::pair<int, double> Locate(const Mesh& mesh, double s) {
  const auto after = std::upper_bound(mesh.begin(), mesh.end(), s);
  const int last = static_cast<int>(mesh.size()) - 2;
  const int interval = std::clamp(static_cast<int>(after - mesh.begin()) - 1, 0, last);
  return {interval, (s - mesh[interval]) / (mesh[interval + 1] - mesh[interval])};
}

Mesh UniformMesh(int intervals) {
  if (intervals < 1) {
    throw std::invalid_argument(
        fmt::format("a mesh has {} intervals, expected 1 or more", intervals));
  }
  Mesh mesh(intervals + 1);
  for (int i = 0; i <= intervals; ++i) mesh[i] = static_cast<double>(i) / intervals;
  return mesh;
}

double PhaseTrajectory::PointShare(int point) const {
  const int inside = scheme.num_nodes() - 1;
  if (point == num_points() - 1) return 1;
  const int interval = point / inside;
  return mesh[interval] + scheme.nodes[point % inside] * (mesh[interval + 1] - mesh[interval]);
}

Eigen::VectorXd PhaseTrajectory::Coordinates(double s, int order) const {
  const auto [interval, share] = Locate(mesh, s);
  return Coordinates(MeshPlace{interval, share}, order);
}

Eigen::VectorXd PhaseTrajectory::Controls(double s) const {
  const auto [interval, share] = Locate(mesh, s);
  return Controls(MeshPlace{interval, share});
}

Eigen::VectorXd PhaseTrajectory::Coordinates(const MeshPlace& place, int order) const {
  const int highest = static_cast<int>(coordinates.size()) - 1;
  Eigen::VectorXd value = OfOneOrder(*this, place, order, highest);
  for (int own = 1; own < highest && !orders.empty(); ++own) {
    const Eigen::VectorXd lower = OfOneOrder(*this, place, order, own);
    for (std::size_t i = 0; i < orders.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      if (orders[i] == own) value[row] = lower[row];
    }
  }
  return value;
}

Eigen::VectorXd PhaseTrajectory::Controls(const MeshPlace& place) const {
  const auto [interval, c] = place;
  const int inside = scheme.num_nodes() - 1;
  return controls.middleCols(interval * inside, inside + 1) * scheme.LagrangeIntegrals(c, 0);
}

Eigen::VectorXd PhaseTrajectory::ControlRates(double s) const {
  const auto [interval, c] = Locate(mesh, s);
  const int inside = scheme.num_nodes() - 1;
  const double h = (mesh[interval + 1] - mesh[interval]) * duration;
  return controls.middleCols(interval * inside, inside + 1) * scheme.LagrangeSlopes(c) / h;
}

double Trajectory::Value(const Variable& variable, double time) const {
  const auto check = [](bool fits) {
    if (!fits) throw std::invalid_argument("Trajectory: a variable of another problem");
  };
  if (variable.kind == VariableKind::kParameter) {
    check(variable.index >= 0 && variable.index < parameters.size());
    return parameters[variable.index];
  }
  check(variable.phase >= 0 && variable.phase < static_cast<int>(phases.size()));
  const PhaseTrajectory& phase = phases[variable.phase];
  if (variable.kind == VariableKind::kDuration) return phase.duration;
  // The end may be off by rounding.
  const double rounding = 1e-9 * std::max(1.0, std::abs(phase.begin) + phase.duration);
  if (!(time >= phase.begin - rounding && time <= phase.begin + phase.duration + rounding)) {
    throw std::invalid_argument(fmt::format(
        "Trajectory: {} s lies outside the phase of the variable, which lasts from {} to {} s",
        time, phase.begin, phase.begin + phase.duration));
  }
  if (variable.kind == VariableKind::kTime) return time;
  const double s = std::clamp((time - phase.begin) / phase.duration, 0.0, 1.0);
  if (variable.kind == VariableKind::kShare) return s;
  if (variable.kind == VariableKind::kControl) {
    check(variable.index >= 0 && variable.index < phase.controls.rows());
    return phase.Controls(s)[variable.index];
  }
  check(variable.order >= 0 && variable.order < static_cast<int>(phase.coordinates.size()) &&
        variable.index >= 0 && variable.index < phase.coordinates[0].rows());
  return phase.Coordinates(s, variable.order)[variable.index];
}

}  // namespace possibility::collocation
