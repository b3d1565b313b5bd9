#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "collocation/problem/optimal_control_problem.h"
#include "collocation/transcription/transcription_scheme.h"

namespace possibility::collocation {

/// Knots of a phase as shares of its duration, ascending from 0 to 1.
using Mesh = std::vector<double>;
Mesh UniformMesh(int intervals);
/// The interval that contains share s, and the position of s in it, 0 to 1.
std::pair<int, double> Locate(const Mesh& mesh, double s);

/// A place on a mesh; a knot belongs to the interval before it or to that after it.
struct MeshPlace {
  int interval = 0;
  double share = 0;  ///< of the interval, 0 to 1
};

/// A motion of one phase: every coordinate with its derivatives at every point of the mesh.
struct PhaseTrajectory {
  double begin = 0;     ///< s, since the beginning of the problem
  double duration = 0;  ///< s
  Mesh mesh;
  TranscriptionScheme scheme;
  std::vector<Eigen::MatrixXd> coordinates;  ///< by order: coordinates x points
  Eigen::MatrixXd controls;                  ///< controls x points
  /// By coordinate: the order of its highest derivative that was a variable; empty: for all that of
  /// the last of `coordinates`. Derivatives beyond it are slopes of its polynomial.
  std::vector<int> orders = {};

  int num_points() const { return static_cast<int>(controls.cols()); }
  double PointShare(int point) const;  ///< of the duration
  /// Coordinates differentiated `order` times at share s of the duration. These are the polynomials
  /// that were transcribed, so each is the exact derivative of the one below.
  Eigen::VectorXd Coordinates(double s, int order = 0) const;
  Eigen::VectorXd Controls(double s) const;
  // The same at a place: at a knot, highest derivatives and controls may jump
  // (TranscriptionScheme).
  Eigen::VectorXd Coordinates(const MeshPlace& place, int order) const;
  Eigen::VectorXd Controls(const MeshPlace& place) const;
  /// Per second; at a knot, those of the interval that begins there.
  Eigen::VectorXd ControlRates(double s) const;
};

struct Trajectory {
  std::vector<PhaseTrajectory> phases;
  Eigen::VectorXd parameters;

  /// A variable of the problem at `time` (s, since the beginning of the problem); parameters and
  /// durations have one value for all times.
  /// @throws std::invalid_argument if the variable is none of the problem's, or its phase does not
  /// contain the time.
  double Value(const Variable& variable, double time) const;
};

}  // namespace possibility::collocation
