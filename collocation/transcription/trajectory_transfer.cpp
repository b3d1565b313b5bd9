#include "collocation/transcription/trajectory_transfer.h"

#include <fmt/format.h>

#include <string>

namespace possibility::collocation {

namespace {

/// The derivatives at the points that are no variables.
void AddSlopes(PhaseTrajectory* phase) {
  for (std::size_t i = 0; i < phase->orders.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    for (int order = phase->orders[i] + 1; order < static_cast<int>(phase->coordinates.size());
         ++order) {
      for (int k = 0; k < phase->num_points(); ++k) {
        phase->coordinates[order](row, k) = phase->Coordinates(phase->PointShare(k), order)[row];
      }
    }
  }
}

}  // namespace

void CheckFits(const VariableLayout& layout, const Trajectory& trajectory) {
  const OptimalControlProblem& problem = layout.problem();
  const auto expect = [&](const std::string& where, const char* what, std::ptrdiff_t expected,
                          std::ptrdiff_t found) {
    if (expected == found) return;
    problem.Fail(fmt::format("{}a guess has {} {}, expected {}", where, found, what, expected));
  };
  expect("", "phases", problem.num_phases(), std::ssize(trajectory.phases));
  expect("", "parameters", std::ssize(layout.parameters()), trajectory.parameters.size());
  for (int p = 0; p < problem.num_phases(); ++p) {
    const Phase& phase = problem.phase(p);
    const PhaseTrajectory& motion = trajectory.phases[p];
    const std::string where = fmt::format("phase '{}': ", phase.name());
    const auto points = (std::ssize(motion.mesh) - 1) * (motion.scheme.num_nodes() - 1) + 1;
    expect(where, "points", points, motion.controls.cols());
    expect(where, "controls", std::ssize(phase.controls()), motion.controls.rows());
    expect(where, "derivatives", phase.order(), std::ssize(motion.coordinates) - 1);
    if (motion.orders != phase.Names().orders) {
      problem.Fail(where + "a guess has coordinates of other orders");
    }
    for (const Eigen::MatrixXd& values : motion.coordinates) {
      expect(where, "points", points, values.cols());
      expect(where, "coordinates", std::ssize(phase.coordinates()), values.rows());
    }
  }
}

Eigen::VectorXd VariablesOf(const VariableLayout& layout, const Trajectory& trajectory) {
  CheckFits(layout, trajectory);
  const OptimalControlProblem& problem = layout.problem();
  Eigen::VectorXd x = Eigen::VectorXd::Zero(layout.num_variables());
  for (std::size_t i = 0; i < layout.parameters().size(); ++i) {
    x[layout.parameters()[i]] = trajectory.parameters[static_cast<Eigen::Index>(i)];
  }
  for (int p = 0; p < problem.num_phases(); ++p) {
    const PhaseLayout& phase_layout = layout.phase(p);
    const PhaseTrajectory& phase = trajectory.phases[p];
    if (phase_layout.duration >= 0) x[phase_layout.duration] = phase.duration;
    for (std::size_t k = 0; k < phase_layout.points.size(); ++k) {
      const double share = phase_layout.points[k].share;
      for (int order = 0; order <= problem.phase(p).order(); ++order) {
        const Eigen::VectorXd values = phase.Coordinates(share, order);
        for (std::size_t c = 0; c < phase_layout.coordinates[k].size(); ++c) {
          if (order > problem.phase(p).OrderOf(static_cast<int>(c))) continue;
          const int index = phase_layout.coordinates[k][c][order];
          if (index >= 0) x[index] = values[static_cast<Eigen::Index>(c)];
        }
      }
      const Eigen::VectorXd controls = phase.Controls(share);
      for (std::size_t c = 0; c < phase_layout.controls[k].size(); ++c) {
        const int index = phase_layout.controls[k][c];
        if (index >= 0) x[index] = controls[static_cast<Eigen::Index>(c)];
      }
    }
  }
  return layout.ScaledWithinBounds(x);
}

Trajectory TrajectoryOf(const VariableLayout& layout, const Eigen::VectorXd& scaled) {
  const OptimalControlProblem& problem = layout.problem();
  const Eigen::VectorXd x = layout.Unscaled(scaled);
  Trajectory trajectory;
  trajectory.parameters.resize(static_cast<Eigen::Index>(layout.parameters().size()));
  for (std::size_t i = 0; i < layout.parameters().size(); ++i) {
    trajectory.parameters[static_cast<Eigen::Index>(i)] = x[layout.parameters()[i]];
  }
  double begin = 0;
  for (int p = 0; p < problem.num_phases(); ++p) {
    const Phase& problem_phase = problem.phase(p);
    const PhaseLayout& phase_layout = layout.phase(p);
    PhaseTrajectory phase;
    phase.begin = begin;
    phase.duration = layout.DurationOf(p, x);
    phase.mesh = phase_layout.mesh;
    phase.scheme = layout.scheme();
    phase.orders = problem_phase.Names().orders;
    begin += phase.duration;
    const auto points = static_cast<Eigen::Index>(phase_layout.points.size());
    const auto n = static_cast<Eigen::Index>(problem_phase.coordinates().size());
    phase.coordinates.assign(problem_phase.order() + 1, Eigen::MatrixXd::Zero(n, points));
    phase.controls.resize(static_cast<Eigen::Index>(problem_phase.controls().size()), points);
    for (int k = 0; k < points; ++k) {
      for (int order = 0; order <= problem_phase.order(); ++order) {
        for (int c = 0; c < n; ++c) {
          if (order > problem_phase.OrderOf(c)) continue;
          phase.coordinates[order](c, k) =
              layout.FormOf(problem_phase.Coordinate(c, order), p, k).Value(x);
        }
      }
      for (int c = 0; c < phase.controls.rows(); ++c) {
        phase.controls(c, k) = layout.FormOf(problem_phase.Control(c), p, k).Value(x);
      }
    }
    AddSlopes(&phase);
    trajectory.phases.push_back(std::move(phase));
  }
  return trajectory;
}

}  // namespace possibility::collocation
