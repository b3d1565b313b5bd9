#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <utility>

#include "actions/blockers.h"
#include "actions/cell_grid.h"
#include "actions/flood_grid.h"
#include "actions/route_flood.h"
#include "models/collision.h"
#include "models/ground_map.h"

namespace possibility::actions {
namespace {

using Cell = CellGrid::Cell;
using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// The collision checker may err by 0.1 mm towards "not free"; cells must not, m.
constexpr double kCheckerError = 0.0002;
constexpr double kLeastRadius = 1e-4;  // m

struct Ball {
  Vector3d centre_R = Vector3d::Zero();  ///< in the root frame
  double radius = 0;
};

/// The largest ball inside a shape, of these the one closest to the root.
Ball LargestBall(const models::PosedShape& posed) {
  const models::Shape& shape = posed.shape;
  double radius = 0;
  Vector3d room = Vector3d::Zero();  // of the ball's centre, along the axes of the shape
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

Ball LargestBall(const models::Link& link) {
  Ball largest;
  for (const models::PosedShape& posed : link.shapes) {
    const Ball ball = LargestBall(posed);
    if (ball.radius > largest.radius) largest = ball;
  }
  return largest;
}

/// Upper bound of how far from the root the robot can bear on ground, in any gait.
double FarthestBearing(const LocomotionModel& model) {
  double reach = 0;
  for (const auto& gait : model.gaits) {
    reach = std::max(reach, BearingReach(*model.robot, *gait->stance.gait));
  }
  return reach;
}

/// How often a cell is halved along every axis before it counts as open.
constexpr int kHalvings = 3;

/// The flood over C_N. Cells: (unused), x, y, z of the ball's centre. The root keeps within the
/// bounds, the ball as far from it as it is, whatever the orientation: so far do cells reach, and
/// no farther. A wall or a floor as long as the bounds is a barrier because the cells at its ends
/// are halved: where a whole cell might hold a free ball, none of its parts does.
class NecessaryFlood {
 public:
  NecessaryFlood(const LocomotionModel& model, const World& world, double resolution,
                 const std::vector<FlightBounds>& flights)
      : model_(model),
        world_(world),
        ball_(LargestBall(model.robot->links[model.robot->pelvis_shape_link])),
        resolution_(std::min(resolution, 1.8 * ball_.radius / std::numbers::sqrt3)),
        reach_(FarthestBearing(model) + ball_.centre_R.norm() + resolution_),
        flight_(FarthestFlight(flights)),
        checker_(*world.environment),
        whole_(models::Shape::Sphere(std::max(kLeastRadius, ball_.radius))),
        prepared_whole_(whole_),
        low_(Corner(-1)),
        high_(Corner(1)),
        size_((high_ - low_).cwiseQuotient(NumCells().cast<double>())),
        grid_({1, NumCells().x(), NumCells().y(), NumCells().z()}) {
    for (int halvings = 0; halvings <= kHalvings; ++halvings) {
      const double to_corner = size_.norm() / 2 / (1 << halvings);
      shrunk_.emplace_back(
          models::Shape::Sphere(std::max(kLeastRadius, ball_.radius - to_corner - kCheckerError)));
    }
  }

  FloodResult Run(const GroundedStance& start, const std::vector<GroundedStance>& goals,
                  const std::function<bool()>& keep_going) {
    std::set<Cell> goal_cells;
    for (const GroundedStance& goal : goals) goal_cells.insert(CellOf(BallAt(goal)));
    return FloodGrid(
        &grid_, CellOf(BallAt(start)), goal_cells, goals, keep_going,
        [this](const Cell& cell) { return Eigen::Vector2d(Centre(cell).head<2>()); },
        [this](const Cell& cell) { OfferNeighbours(cell); },
        [&](const Cell& cell) { return ClosedBy(cell, goals); },
        [&] { return std::vector<ReachedRegion>{Reached(start.z)}; });
  }

 private:
  static FlightBounds FarthestFlight(const std::vector<FlightBounds>& flights) {
    FlightBounds farthest;
    for (const FlightBounds& flight : flights) {
      farthest.rise = std::max(farthest.rise, flight.rise);
      farthest.range = std::max(farthest.range, flight.range);
    }
    return farthest;
  }

  static Isometry3d At(const Vector3d& p) {
    Isometry3d X = Isometry3d::Identity();
    X.translation() = p;
    return X;
  }

  Vector3d BallAt(const GroundedStance& stance) const {
    return model_.gaits[stance.gait]->stance.RootPose(stance.pose, stance.z) * ball_.centre_R;
  }

  /// Of the box of places that the ball's centre can be in: -1 the lowest, 1 the highest.
  Vector3d Corner(int side) const {
    const Eigen::AlignedBox2d& bounds = world_.environment->bounds;
    const std::vector<double>& levels = world_.ground->levels();
    const double from_root = ball_.centre_R.norm();
    Vector3d corner;
    if (side < 0) {
      corner << bounds.min().array() - from_root, levels.front() - reach_;
    } else {
      corner << bounds.max().array() + from_root, levels.back() + reach_ + flight_.rise;
    }
    return corner;
  }

  Eigen::Vector3i NumCells() const {
    return ((high_ - low_) / resolution_).array().ceil().max(1).matrix().cast<int>();
  }

  Cell CellOf(const Vector3d& p) const {
    const Vector3d c = (p - low_).cwiseQuotient(size_);
    Cell cell{};
    for (int axis = 0; axis < 3; ++axis) {
      const int last = grid_.size()[axis + 1] - 1;
      cell[axis + 1] = static_cast<int>(std::clamp(std::floor(c[axis]), 0.0, 1.0 * last));
    }
    return cell;
  }

  Vector3d Centre(const Cell& cell) const {
    return low_ + size_.cwiseProduct(Vector3d(cell[1] + 0.5, cell[2] + 0.5, cell[3] + 0.5));
  }

  bool GroundIsNear(const Vector3d& p) const {
    const std::vector<double>& levels = world_.ground->levels();
    for (size_t level = 0; level < levels.size(); ++level) {
      const double height = p.z() - levels[level];
      const double beyond_legs = std::max(height - flight_.rise, std::min(height, 0.0));
      if (std::abs(beyond_legs) > reach_) continue;
      const double reach = flight_.range + std::sqrt(reach_ * reach_ - beyond_legs * beyond_legs);
      if (world_.ground->IsNear(static_cast<int>(level), p.head<2>(), reach)) return true;
    }
    return false;
  }

  /// Whether the root may be within the bounds while the ball's centre is within `half` of `p`.
  bool IsWithinBounds(const Vector2d& p, const Vector2d& half) const {
    constexpr double kRounding = 1e-9;
    const Eigen::AlignedBox2d part(p - half, p + half);
    return world_.environment->bounds.exteriorDistance(part) <= ball_.centre_R.norm() + kRounding;
  }

  /// Whether the ball may be free with its centre in the box about `p`, halved so often already.
  bool MayBeFree(const Vector3d& p, int halvings) {
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

  void OfferNeighbours(const Cell& cell) {
    const auto is_open = [this](const Cell& neighbour) {
      const Vector3d p = Centre(neighbour);
      return GroundIsNear(p) && MayBeFree(p, 0);
    };
    for (int axis = 1; axis < 4; ++axis) {
      for (int step : {-1, 1}) {
        Cell next = cell;
        next[axis] += step;
        grid_.Offer(next, is_open);
      }
    }
  }

  std::vector<std::string> ClosedBy(const Cell& cell, const std::vector<GroundedStance>& goals) {
    std::set<std::string> names;
    const Vector3d p = Centre(cell);
    for (const GroundedStance& goal : goals) {
      const Vector3d towards = BallAt(goal) - p;
      if (towards.norm() < 1e-9) continue;
      const Vector3d beyond = p + 1.5 * resolution_ * towards.normalized();
      if (!GroundIsNear(beyond)) names.insert("no ground");
      for (std::string& name : Blockers(*world_.environment, {{whole_, At(beyond)}})) {
        names.insert(std::move(name));
      }
    }
    return {names.begin(), names.end()};
  }

  ReachedRegion Reached(double z) const {
    CellMask mask(grid_.size()[1], grid_.size()[2]);
    for (int x = 0; x < grid_.size()[1]; ++x) {
      for (int y = 0; y < grid_.size()[2]; ++y) {
        for (int height = 0; height < grid_.size()[3]; ++height) {
          if (grid_.IsReached({0, x, y, height})) mask.Add(x, y);
        }
      }
    }
    return {"", z, OutlinesOf(mask, low_.head<2>(), size_.head<2>())};
  }

  const LocomotionModel& model_;
  const World& world_;
  Ball ball_;
  double resolution_;
  double reach_;
  FlightBounds flight_;
  models::CollisionChecker checker_;
  models::Shape whole_;
  models::PreparedShape prepared_whole_;
  std::vector<models::PreparedShape> shrunk_;  ///< what a ball covers wherever in a part it is
  Vector3d low_;                               ///< corners of all cells together, m
  Vector3d high_;
  Vector3d size_;  ///< of a cell, m
  CellGrid grid_;
};

}  // namespace

FloodResult FloodNecessary(const LocomotionModel& model, const World& world,
                           const GroundedStance& start, const std::vector<GroundedStance>& goals,
                           double resolution, const std::function<bool()>& keep_going,
                           const std::vector<FlightBounds>& flights) {
  return NecessaryFlood(model, world, resolution, flights).Run(start, goals, keep_going);
}

}  // namespace possibility::actions
