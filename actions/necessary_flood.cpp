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

struct Ball {
  Vector3d centre_R = Vector3d::Zero();  ///< in the root frame
  double radius = 0;
};

Ball LargestBall(const models::Link& link) {
  Ball ball;
  for (const models::PosedShape& posed : link.shapes) {
    const models::Shape& shape = posed.shape;
    double radius = 0;
    switch (shape.type) {
      case models::ShapeType::kBox:
        radius = shape.size.minCoeff() / 2;
        break;
      case models::ShapeType::kSphere:
      case models::ShapeType::kCapsule:
        radius = shape.radius;
        break;
      case models::ShapeType::kCylinder:
        radius = std::min(shape.radius, shape.length / 2);
        break;
      case models::ShapeType::kConvexMesh:
        break;
    }
    if (radius > ball.radius) ball = {posed.X_PS.translation(), radius};
  }
  return ball;
}

/// Upper bound of how far a leg's ground contact can be from the root.
double LegReach(const LocomotionModel& model) {
  double reach = 0;
  for (const auto& gait : model.gaits) {
    for (const models::GaitLimb& limb : gait->stance.gait->limbs) {
      if (limb.hold_orientation) {
        reach = std::max(reach, ChainLength(*model.robot, model.robot->contacts[limb.contact]));
      }
    }
  }
  return reach;
}

/// The flood over C_N. Cells: (unused), x, y, z of the ball's centre.
class NecessaryFlood {
 public:
  NecessaryFlood(const LocomotionModel& model, const World& world, double resolution,
                 const std::vector<FlightBounds>& flights)
      : model_(model),
        world_(world),
        ball_(LargestBall(model.robot->links[model.robot->pelvis_shape_link])),
        resolution_(std::min(resolution, 1.8 * ball_.radius / std::numbers::sqrt3)),
        reach_(LegReach(model) + ball_.centre_R.norm() + resolution_),
        flight_(FarthestFlight(flights)),
        checker_(*world.environment),
        shrunk_(models::Shape::Sphere(
            std::max(1e-4, ball_.radius - resolution_ * std::numbers::sqrt3 / 2 - kCheckerError))),
        prepared_(shrunk_),
        grid_(GridSize()) {}

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

  Vector3d Origin() const {
    Vector3d origin;
    origin << world_.environment->bounds.min(), world_.ground->levels().front() - reach_;
    return origin;
  }

  Cell GridSize() const {
    Vector3d top;
    top << world_.environment->bounds.max(), world_.ground->levels().back() + reach_ + flight_.rise;
    const Vector3d size = (top - Origin()) / resolution_;
    return {1, static_cast<int>(size.x()) + 1, static_cast<int>(size.y()) + 1,
            static_cast<int>(size.z()) + 1};
  }

  Cell CellOf(const Vector3d& p) const {
    const Vector3d c = (p - Origin()) / resolution_;
    return {0, static_cast<int>(std::floor(c.x())), static_cast<int>(std::floor(c.y())),
            static_cast<int>(std::floor(c.z()))};
  }

  Vector3d Centre(const Cell& cell) const {
    return Origin() + resolution_ * Vector3d(cell[1] + 0.5, cell[2] + 0.5, cell[3] + 0.5);
  }

  bool GroundIsNear(const Vector3d& p) const {
    const std::vector<double>& levels = world_.ground->levels();
    for (size_t level = 0; level < levels.size(); ++level) {
      const double height = p.z() - levels[level];
      const double beyond_legs = std::max(height - flight_.rise, std::min(height, 0.0));
      if (std::abs(beyond_legs) > reach_) continue;
      const double reach = flight_.range + std::sqrt(reach_ * reach_ - beyond_legs * beyond_legs);
      if (world_.ground->Clearance(static_cast<int>(level), p.head<2>()) >= -reach) return true;
    }
    return false;
  }

  void OfferNeighbours(const Cell& cell) {
    const auto is_open = [this](const Cell& neighbour) {
      const Vector3d p = Centre(neighbour);
      return GroundIsNear(p) && checker_.IsFree(prepared_, At(p), 0);
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
      for (std::string& name : Blockers(*world_.environment, {{shrunk_, At(beyond)}})) {
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
    return {"", z, OutlinesOf(mask, Origin().head<2>(), Vector2d::Constant(resolution_))};
  }

  const LocomotionModel& model_;
  const World& world_;
  Ball ball_;
  double resolution_;
  double reach_;
  FlightBounds flight_;
  models::CollisionChecker checker_;
  models::Shape shrunk_;
  models::PreparedShape prepared_;
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
