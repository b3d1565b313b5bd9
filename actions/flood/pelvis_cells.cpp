#include "actions/flood/pelvis_cells.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "actions/conditions/blockers.h"
#include "actions/flood/checker_error.h"
#include "models/world/ground_map.h"

namespace possibility::actions {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kLeastRadius = 1e-4;  // m
constexpr double kRounding = 1e-9;     // m
constexpr double kGroundError = 1e-5;  // m, more than the error of a Clearance

/// How often a cell is halved along every axis before it counts as open.
constexpr int kHalvings = 3;

Isometry3d At(const Vector3d& p) {
  Isometry3d X = Isometry3d::Identity();
  X.translation() = p;
  return X;
}

}  // namespace

/// The largest ball inside a shape; among equals, the one closest to the root.
PelvisCells::Ball PelvisCells::LargestBall(const models::PosedShape& posed) {
  const models::Shape& shape = posed.shape;
  double radius = 0;
  Vector3d room = Vector3d::Zero();  // for the ball's centre, along the axes of the shape
  switch (shape.type) {
    case models::ShapeType::kBox:
      radius = shape.size.minCoeff() / 2;
      room = shape.size / 2 - Vector3d::Constant(radius);
      break;
    case models::ShapeType::kSphere:
      radius = shape.radius;
      break;
    case models::ShapeType::kCapsule:
      radius = shape.radius;
      room.z() = shape.length / 2;
      break;
    case models::ShapeType::kCylinder:
      radius = std::min(shape.radius, shape.length / 2);
      room.z() = shape.length / 2 - radius;
      break;
    case models::ShapeType::kConvexMesh:
      break;
  }
  const Vector3d root = posed.X_PS.inverse() * Vector3d::Zero();
  return {posed.X_PS * root.cwiseMax(-room).cwiseMin(room), radius};
}

PelvisCells::Ball PelvisCells::LargestBall(const models::Link& link) {
  Ball largest;
  for (const models::PosedShape& posed : link.shapes) {
    const Ball ball = LargestBall(posed);
    if (ball.radius > largest.radius) largest = ball;
  }
  return largest;
}

PelvisCells::PelvisCells(const LocomotionModel& model, const World& world, double resolution,
                         double leg_reach, const FlightBounds& flight)
    : model_(model),
      world_(world),
      ball_(LargestBall(model.robot->links[model.robot->pelvis_shape_link])),
      resolution_(std::min(resolution, 1.8 * ball_.radius / std::numbers::sqrt3)),
      reach_(leg_reach + ball_.centre_R.norm() + resolution_),
      flight_(flight),
      checker_(*world.environment),
      solids_(*world.environment),
      whole_(models::Shape::Sphere(std::max(kLeastRadius, ball_.radius))),
      prepared_whole_(whole_),
      low_(Corner(-1)),
      high_(Corner(1)),
      num_cells_(((high_ - low_) / resolution_).array().ceil().max(1)),
      size_((high_ - low_).cwiseQuotient(num_cells_)) {
  for (int halvings = 0; halvings <= kHalvings; ++halvings) {
    const double to_corner = size_.norm() / 2 / (1 << halvings);
    shrunk_.emplace_back(models::Shape::Sphere(ShrunkRadius(to_corner)));
  }
  solid_radius_ = ShrunkRadius(size_.norm() / 2) - kCheckerError;
}

Vector3d PelvisCells::BallAt(const GroundedStance& stance) const {
  return model_.gaits[stance.gait]->stance.RootPose(stance.pose, stance.z) * ball_.centre_R;
}

/// Corner of the box of possible ball centres: -1 the lowest, 1 the highest.
Vector3d PelvisCells::Corner(int side) const {
  const Eigen::AlignedBox2d& bounds = world_.environment->bounds;
  const Eigen::AlignedBox3d ground = world_.ground->bounds();
  const double from_root = ball_.centre_R.norm();
  Vector3d corner;
  if (side < 0) {
    corner << bounds.min().array() - from_root, ground.min().z() - reach_;
  } else {
    corner << bounds.max().array() + from_root, ground.max().z() + reach_ + flight_.rise;
  }
  return corner;
}

double PelvisCells::ShrunkRadius(double to_corner) const {
  return std::max(kLeastRadius, ball_.radius - to_corner - kCheckerError);
}

CellBlock PelvisCells::CellOf(const Vector3d& p) const {
  const Vector3d cell =
      (p - low_).cwiseQuotient(size_).array().floor().max(0).min(num_cells_.array() - 1);
  return CellBlock::Of(static_cast<int>(cell.z()), static_cast<int>(cell.x()),
                       static_cast<int>(cell.y()));
}

Vector3d PelvisCells::Centre(const CellBlock& block) const {
  return low_ + size_.cwiseProduct(Vector3d((block.x0 + block.x1) * 0.5,
                                            (block.y0 + block.y1) * 0.5, block.plane + 0.5));
}

BlockState PelvisCells::Judge(const CellBlock& block) const {
  const Vector3d p = Centre(block);
  if (block.IsCell()) {
    return GroundIsNear(p) && MayBeFree(p, 0) ? BlockState::kOpen : BlockState::kClosed;
  }
  const Vector2d half =
      Vector2d(block.x1 - block.x0 - 1, block.y1 - block.y0 - 1).cwiseProduct(size_.head<2>() / 2);
  if (IsAllOpen(block, p, half)) return BlockState::kOpen;
  return IsAllClosed(p, half) ? BlockState::kClosed : BlockState::kMixed;
}

bool PelvisCells::IsAllOpen(const CellBlock& block, const Vector3d& p, const Vector2d& half) const {
  Vector3d reach(half.x(), half.y(), 0);
  reach.array() += ball_.radius;
  const models::Prism around(Eigen::AlignedBox3d(-reach, reach), At(p));
  if (!checker_.AreCertainlyFree({around})) return false;
  // The bounds are convex, so the farthest point from them is in a corner.
  for (const int x : {block.x0, block.x1 - 1}) {
    for (const int y : {block.y0, block.y1 - 1}) {
      const Vector3d corner = Centre(CellBlock::Of(block.plane, x, y));
      if (!IsWithinBounds(corner.head<2>(), size_.head<2>() / 2)) return false;
    }
  }
  return GroundIsNearAllAround(p, half.norm());
}

bool PelvisCells::IsAllClosed(const Vector3d& p, const Vector2d& half) const {
  if (!GroundIsNear(p, half.norm() + kRounding) ||
      !IsWithinBounds(p.head<2>(), half + size_.head<2>() / 2)) {
    return true;
  }
  // Wherever the ball's centre is, some point of the shrunk ball lies inside the same solid.
  const Vector3d reach(half.x(), half.y(), 0);
  for (const double up : {0.0, -solid_radius_, solid_radius_}) {
    const Vector3d middle = p + Vector3d(0, 0, up);
    if (solids_.OneHolds({middle - reach, middle + reach})) return true;
  }
  return false;
}

/// Largest horizontal distance from p of ground of a level within reach; negative: none is within
/// reach.
double PelvisCells::Reach(const Vector3d& p, double level) const {
  const double height = p.z() - level;
  const double beyond_legs = std::max(height - flight_.rise, std::min(height, 0.0));
  if (std::abs(beyond_legs) > reach_) return -1;
  return flight_.range + std::sqrt(reach_ * reach_ - beyond_legs * beyond_legs);
}

/// Whether ground is within reach of p, or of some point at its height within `displaced` of it.
bool PelvisCells::GroundIsNear(const Vector3d& p, double displaced) const {
  const std::vector<double>& levels = world_.ground->levels();
  for (size_t level = 0; level < levels.size(); ++level) {
    const double reach = Reach(p, levels[level]);
    if (reach < 0) continue;
    if (world_.ground->IsNear(static_cast<int>(level), p.head<2>(), reach + displaced)) {
      return true;
    }
  }
  const double far = reach_ + std::hypot(flight_.rise, flight_.range);
  return world_.ground->RoughGroundIsNear(p, far + displaced);
}

/// Sufficient: true only if ground is near every point at p's height within `displaced` of it.
bool PelvisCells::GroundIsNearAllAround(const Vector3d& p, double displaced) const {
  const std::vector<double>& levels = world_.ground->levels();
  for (size_t i = 0; i < levels.size(); ++i) {
    const double reach = Reach(p, levels[i]);
    if (reach < 0) continue;
    const int level = static_cast<int>(i);
    const double needed = displaced - reach + kGroundError;
    const Vector2d from_above = p.head<2>();
    if (needed > 0 && world_.ground->OneFaceHolds(level, from_above, from_above, needed)) {
      return true;
    }
    if (world_.ground->Clearance(level, from_above) >= needed) return true;
  }
  return false;
}

/// Whether the root may be within the bounds while the ball's centre is within `half` of `p`.
bool PelvisCells::IsWithinBounds(const Vector2d& p, const Vector2d& half) const {
  const Eigen::AlignedBox2d part(p - half, p + half);
  return world_.environment->bounds.exteriorDistance(part) <= ball_.centre_R.norm() + kRounding;
}

/// Whether the ball may be free with its centre in the box about `p`, the result of `halvings`
/// halvings.
bool PelvisCells::MayBeFree(const Vector3d& p, int halvings) const {
  if (!IsWithinBounds(p.head<2>(), size_.head<2>() / (2 << halvings))) return false;
  if (checker_.IsFree(prepared_whole_, At(p), 0)) return true;
  if (!checker_.IsFree(shrunk_[halvings], At(p), 0)) return false;
  if (halvings == kHalvings) return true;
  const Vector3d quarter = size_ / 4 / (1 << halvings);
  for (int part = 0; part < 8; ++part) {
    const Vector3d side(part & 1 ? 1 : -1, part & 2 ? 1 : -1, part & 4 ? 1 : -1);
    if (MayBeFree(p + quarter.cwiseProduct(side), halvings + 1)) return true;
  }
  return false;
}

std::vector<std::string> PelvisCells::Blockers(const CellBlock& cell,
                                               const GroundedStance& goal) const {
  const Vector3d p = Centre(cell);
  const Vector3d towards = BallAt(goal) - p;
  if (towards.norm() < 1e-9) return {};
  const Vector3d beyond = p + 1.5 * resolution_ * towards.normalized();
  std::vector<std::string> names = actions::Blockers(*world_.environment, {{whole_, At(beyond)}});
  if (!GroundIsNear(beyond)) names.emplace_back("no ground");
  return names;
}

}  // namespace possibility::actions
