#include "collocation/robot/placed_patch.h"

#include <algorithm>
#include <cmath>

#include "collocation/problem/function_algebra.h"

namespace possibility::collocation {
namespace {

using dynamics::ContactPoint;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// Points are on one line if they are this close to it, m.
constexpr double kOnLine = 1e-6;

/// The points that determine a patch's pose, and the direction from the first to the second.
struct Triad {
  int second = -1;  ///< -1: a point
  int third = -1;   ///< -1: an edge
  Vector3d along = Vector3d::UnitX();
};

Triad FindTriad(const PlacedPatch& patch) {
  Triad triad;
  const int n = static_cast<int>(patch.places.size());
  const auto farthest = [n](const auto& distance) {
    int best = -1;
    for (int i = 1; i < n; ++i) {
      if (distance(i) > (best < 0 ? kOnLine : distance(best) + kOnLine)) best = i;
    }
    return best;
  };
  const auto from_first = [&patch](int i) -> Vector3d { return patch.places[i] - patch.places[0]; };
  triad.second = farthest([&](int i) { return from_first(i).norm(); });
  if (triad.second < 0) return triad;
  triad.along = from_first(triad.second).normalized();
  triad.third = farthest([&](int i) { return triad.along.cross(from_first(i)).norm(); });
  return triad;
}

struct HeldComponent {
  int point = 0;
  Vector3d axis;
};

std::vector<HeldComponent> Held(const PlacedPatch& patch) {
  const Triad triad = FindTriad(patch);
  const Vector3d normal = patch.points[0].normal_W;
  if (triad.second < 0) {
    return {{0, Vector3d::UnitX()}, {0, Vector3d::UnitY()}, {0, Vector3d::UnitZ()}};
  }
  const Vector3d across = normal.cross(triad.along).normalized();
  std::vector<HeldComponent> held = {
      {0, triad.along}, {0, across}, {0, normal}, {triad.second, across}, {triad.second, normal}};
  if (triad.third >= 0) held.push_back({triad.third, normal});
  return held;
}

}  // namespace

PlacedPatch Place(const dynamics::MultibodyModel& model, int contact,
                  const Eigen::Isometry3d& X_WF) {
  const models::ContactPatch& patch = model.tree().contacts.at(contact);
  const Eigen::Isometry3d X_FL = patch.Frame().inverse();
  PlacedPatch placed;
  for (const Vector3d& p_L : patch.points) {
    const Vector3d p_F = X_FL * p_L;
    placed.points.push_back({patch.link, p_L, X_WF.linear().col(2)});
    placed.places.push_back(X_WF * p_F);
    placed.in_patch.push_back(p_F.head<2>());
  }
  return placed;
}

std::vector<PointComponent> HoldingComponents(const PlacedPatch& patch) {
  std::vector<PointComponent> components;
  for (const HeldComponent& held : Held(patch)) {
    components.push_back({patch.points[held.point], held.axis});
  }
  return components;
}

std::vector<double> HeldPlaces(const PlacedPatch& patch) {
  std::vector<double> places;
  for (const HeldComponent& held : Held(patch)) {
    places.push_back(held.axis.dot(patch.places[held.point]));
  }
  return places;
}

bool IsSurface(const PlacedPatch& patch) { return FindTriad(patch).third >= 0; }

std::shared_ptr<Function> PressureReserve(const PlacedPatch& patch, double reserve) {
  const int n = static_cast<int>(patch.points.size());
  Vector2d centre = Vector2d::Zero();
  for (const Vector2d& p : patch.in_patch) centre += p / n;
  Eigen::MatrixXd rows(n, 3 * n);
  for (int edge = 0; edge < n; ++edge) {
    const Vector2d& begin = patch.in_patch[edge];
    const Vector2d along = (patch.in_patch[(edge + 1) % n] - begin).normalized();
    Vector2d inward(-along.y(), along.x());
    if (inward.dot(centre - begin) < 0) inward = -inward;
    for (int i = 0; i < n; ++i) {
      const double distance = inward.dot(patch.in_patch[i] - begin);
      rows.block<1, 3>(edge, 3 * i) = (distance - reserve) * patch.points[i].normal_W.transpose();
    }
  }
  return LinearMap(rows);
}

}  // namespace possibility::collocation
