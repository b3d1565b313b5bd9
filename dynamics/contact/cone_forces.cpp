#include "dynamics/contact/cone_forces.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "dynamics/contact/quadratic_program.h"

namespace possibility::dynamics {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

// Weight of the bounded quantities (as fractions of their bounds) relative to the forces: small, so
// that sharing the load comes first.
constexpr double kBoundedWeight = 0.01;
// Below this slope the sides of a pyramid no longer ensure accurately that the force pushes.
constexpr double kSteep = 1e-3;
// Points on one line bear no moment about it, so the balance has a row too many. Inverse kinematics
// leaves them on the line to some 1e-11 m only.
constexpr double kBalanceTolerance = 1e-9;

/// Two unit vectors perpendicular to `normal`; x and y if it points up.
Eigen::Matrix<double, 3, 2> Tangents(const Vector3d& normal) {
  const bool steep = std::abs(normal.x()) > 0.9;
  const Vector3d reference = steep ? Vector3d::UnitZ() : Vector3d::UnitX();
  Eigen::Matrix<double, 3, 2> tangents;
  tangents.col(0) = (reference - normal * normal.dot(reference)).normalized();
  tangents.col(1) = normal.cross(tangents.col(0));
  return tangents;
}

void WriteCost(const ConeForceProblem& problem, QuadraticProgram* program) {
  const Index n = problem.balance_loads.cols();
  VectorXd weights(problem.bounds.size());
  for (Index k = 0; k < weights.size(); ++k) {
    const double bound = problem.bounds[k];
    weights[k] = bound > 0 && std::isfinite(bound) ? kBoundedWeight / (bound * bound) : 0;
  }
  const MatrixXd weighted = weights.asDiagonal() * problem.bounded_loads;
  program->H.noalias() = problem.bounded_loads.transpose() * weighted;
  program->H += MatrixXd::Identity(n, n);
  program->g.noalias() = -(weighted.transpose() * problem.bounded_required);
}

/// Whether the cone of a point is too narrow for its sides to ensure that the force pushes.
bool NeedsPush(const ConeForceProblem& problem, std::size_t point) {
  return problem.slopes[point] < kSteep;
}

/// A regular polygon inscribed in the circle of radius slope * (normal force - reserve): half
/// planes at cos(pi / edges) of the radius. Together they imply a normal force >= the reserve,
/// unless the slope is almost zero.
int WriteCones(const ConeForceProblem& problem, QuadraticProgram* program) {
  const double inscribed = std::cos(std::numbers::pi / problem.cone_edges);
  int row = 0;
  for (std::size_t i = 0; i < problem.normals.size(); ++i) {
    const double slope = problem.slopes[i] * inscribed;
    const Eigen::Matrix<double, 3, 2> tangents = Tangents(problem.normals[i]);
    for (int edge = 0; edge < problem.cone_edges; ++edge, ++row) {
      const double angle = 2 * std::numbers::pi * edge / problem.cone_edges;
      program->C.block<1, 3>(row, 3 * i) =
          (std::cos(angle) * tangents.col(0) + std::sin(angle) * tangents.col(1) -
           slope * problem.normals[i])
              .transpose();
      program->d[row] = -slope * problem.normal_reserve;
    }
  }
  for (std::size_t i = 0; i < problem.normals.size(); ++i) {
    if (!NeedsPush(problem, i)) continue;
    program->C.block<1, 3>(row, 3 * i) = -problem.normals[i].transpose();
    program->d[row++] = -problem.normal_reserve;
  }
  return row;
}

void WriteBounds(const ConeForceProblem& problem, int row, QuadraticProgram* program) {
  for (Index k = 0; k < problem.bounds.size(); ++k) {
    const double bound = problem.bounds[k];
    if (!std::isfinite(bound)) continue;
    program->C.row(row) = -problem.bounded_loads.row(k);
    program->d[row++] = bound - problem.bounded_required[k];
    program->C.row(row) = problem.bounded_loads.row(k);
    program->d[row++] = bound + problem.bounded_required[k];
  }
}

/// Removes what rounding put outside the true cones.
void MoveIntoCones(const ConeForceProblem& problem, VectorXd* x) {
  for (std::size_t i = 0; i < problem.normals.size(); ++i) {
    const Vector3d& normal = problem.normals[i];
    auto force = x->segment<3>(3 * i);
    const double along = force.dot(normal);
    Vector3d tangential = force - along * normal;
    const double excess = std::max(0.0, along - problem.normal_reserve);
    const double size = tangential.norm();
    const double most = problem.slopes[i] * excess;
    if (size > most) tangential *= most / size;
    force = tangential + (excess + problem.normal_reserve) * normal;
  }
}

}  // namespace

std::optional<VectorXd> SolveConeForces(const ConeForceProblem& problem) {
  const Index n = problem.balance_loads.cols();
  QuadraticProgram program;
  WriteCost(problem, &program);
  program.E = problem.balance_loads;
  program.e = problem.balance_required;
  program.equality_tolerance = kBalanceTolerance;
  int cone_rows = static_cast<int>(problem.normals.size()) * problem.cone_edges;
  for (std::size_t i = 0; i < problem.normals.size(); ++i) cone_rows += NeedsPush(problem, i);
  const Index bounded = (problem.bounds.array().isFinite()).count();
  program.C.setZero(cone_rows + 2 * bounded, n);
  program.d.setZero(cone_rows + 2 * bounded);
  WriteBounds(problem, WriteCones(problem, &program), &program);
  QuadraticProgramSolution solution = Solve(program);
  if (solution.status != QuadraticProgramStatus::kSolved) return std::nullopt;
  MoveIntoCones(problem, &solution.x);
  return std::move(solution.x);
}

}  // namespace possibility::dynamics
