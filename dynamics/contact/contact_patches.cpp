#include "dynamics/contact/contact_patches.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <utility>

namespace possibility::dynamics {

namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using Eigen::VectorXd;

// m: points closer to an edge than this are on it.
constexpr double kOnEdge = 1e-6;

void AddEdge(const VectorXd& distances, std::vector<TippingEdge>* edges) {
  const VectorXd levers = distances.cwiseMax(0) / distances.maxCoeff();
  const bool is_known = std::any_of(edges->begin(), edges->end(), [&](const TippingEdge& edge) {
    return (edge.levers - levers).lpNorm<Eigen::Infinity>() < 1e-6;
  });
  if (!is_known) edges->push_back({levers});
}

VectorXd Distances(const Matrix3Xd& points, const Vector3d& origin, const Vector3d& inward) {
  return (inward.transpose() * (points.colwise() - origin)).transpose();
}

/// Lines through two points with all other points on one side. If all points lie on one line, the
/// ends of their segment.
std::vector<TippingEdge> Edges(const Matrix3Xd& points, const Vector3d& normal) {
  const Eigen::Index count = points.cols();
  std::vector<TippingEdge> edges;
  Vector3d along = Vector3d::Zero();
  for (Eigen::Index i = 0; i < count; ++i) {
    for (Eigen::Index j = 0; j < count; ++j) {
      Vector3d side = points.col(j) - points.col(i);
      side -= normal * normal.dot(side);
      if (side.norm() <= kOnEdge) continue;
      if (side.norm() > along.norm()) along = side;
      const VectorXd distances = Distances(points, points.col(i), normal.cross(side).normalized());
      if (distances.minCoeff() < -kOnEdge || distances.maxCoeff() <= kOnEdge) continue;
      AddEdge((distances.array().abs() <= kOnEdge).select(0, distances), &edges);
    }
  }
  if (!edges.empty()) return edges;
  if (along.isZero()) return {{VectorXd::Ones(count)}};
  const VectorXd positions = Distances(points, points.col(0), along.normalized());
  AddEdge(positions.array() - positions.minCoeff(), &edges);
  AddEdge(positions.maxCoeff() - positions.array(), &edges);
  return edges;
}

}  // namespace

double ContactPatchBalance::Moment(const TippingEdge& edge, const Matrix3Xd& forces) const {
  double moment = 0;
  for (size_t i = 0; i < points.size(); ++i) {
    moment += edge.levers[i] * normal_W.dot(forces.col(points[i]));
  }
  return moment;
}

Vector3d ContactPatchBalance::Resultant(const Matrix3Xd& forces) const {
  Vector3d sum = Vector3d::Zero();
  for (const int point : points) sum += forces.col(point);
  return sum;
}

double ContactPatchBalance::FrictionUtilisation(const Matrix3Xd& forces, double friction) const {
  const Vector3d force = Resultant(forces);
  const double normal = normal_W.dot(force);
  const double tangential = (force - normal * normal_W).norm();
  if (force.isZero(1e-9)) return 0;
  if (normal <= 0) return std::numeric_limits<double>::infinity();
  return tangential == 0 ? 0 : tangential / (friction * normal);
}

std::vector<ContactPatchBalance> MakePatches(const std::vector<HeldPoint>& points) {
  std::vector<ContactPatchBalance> patches;
  std::vector<int> links;
  for (size_t i = 0; i < points.size(); ++i) {
    size_t patch = 0;
    while (patch < patches.size() &&
           (links[patch] != points[i].point.link ||
            !patches[patch].normal_W.isApprox(points[i].point.normal_W))) {
      ++patch;
    }
    if (patch == patches.size()) {
      patches.push_back({{}, points[i].point.normal_W, {}});
      links.push_back(points[i].point.link);
    }
    patches[patch].points.push_back(static_cast<int>(i));
  }
  for (ContactPatchBalance& patch : patches) {
    Matrix3Xd places(3, patch.points.size());
    for (size_t i = 0; i < patch.points.size(); ++i) places.col(i) = points[patch.points[i]].anchor;
    patch.edges = Edges(places, patch.normal_W);
  }
  return patches;
}

}  // namespace possibility::dynamics
