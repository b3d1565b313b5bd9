#include "actions/flood/least_way.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

#include "actions/flood/necessary_flood.h"
#include "actions/flood/pelvis_cells.h"

namespace possibility::actions {
namespace {

constexpr double kUnreached = std::numeric_limits<double>::infinity();
constexpr double kMostPlanCells = 4e6;  // seen from above

/// The cells that are open at some height, seen from above, and those beside them.
class PlanCells {
 public:
  PlanCells(int nx, int ny, const std::vector<CellBlock>& open)
      : nx_(nx), ny_(ny), open_(static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny), 0) {
    for (const CellBlock& block : open) {
      for (int y = block.y0; y < block.y1; ++y) {
        for (int x = block.x0; x < block.x1; ++x) open_[Index(x, y)] = 1;
      }
    }
    Widen();
  }

  int nx() const { return nx_; }
  int ny() const { return ny_; }
  bool IsOpen(int x, int y) const {
    return x >= 0 && y >= 0 && x < nx_ && y < ny_ && open_[Index(x, y)] != 0;
  }

 private:
  std::size_t Index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(nx_) +
           static_cast<std::size_t>(x);
  }

  void Widen() {
    const std::vector<char> narrow = open_;
    for (int y = 0; y < ny_; ++y) {
      for (int x = 0; x < nx_; ++x) {
        if (narrow[Index(x, y)] == 0) continue;
        for (int dy = -1; dy <= 1; ++dy) {
          for (int dx = -1; dx <= 1; ++dx) {
            if (x + dx < 0 || y + dy < 0 || x + dx >= nx_ || y + dy >= ny_) continue;
            open_[Index(x + dx, y + dy)] = 1;
          }
        }
      }
    }
  }

  int nx_;
  int ny_;
  std::vector<char> open_;
};

/// Dijkstra's algorithm over the corners of open cells.
class CornerDistances {
 public:
  CornerDistances(const PlanCells& cells, const Eigen::Vector2d& size, const CellBlock& start)
      : cells_(cells), size_(size), along_(cells.nx() + 1) {
    distances_.assign(static_cast<std::size_t>(along_) * static_cast<std::size_t>(cells.ny() + 1),
                      kUnreached);
    for (const int x : {start.x0, start.x1}) {
      for (const int y : {start.y0, start.y1}) Reach(x, y, 0);
    }
    while (!queue_.empty()) {
      const auto [distance, corner] = queue_.top();
      queue_.pop();
      if (distance > distances_[static_cast<std::size_t>(corner)]) continue;
      Leave(corner % along_, corner / along_, distance);
    }
  }

  /// To the nearest corner of a cell.
  double To(const CellBlock& cell) const {
    double least = kUnreached;
    for (const int x : {cell.x0, cell.x1}) {
      for (const int y : {cell.y0, cell.y1}) least = std::min(least, distances_[Index(x, y)]);
    }
    return least;
  }

 private:
  std::size_t Index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(along_) +
           static_cast<std::size_t>(x);
  }

  void Reach(int x, int y, double distance) {
    if (!(distance < distances_[Index(x, y)])) return;
    distances_[Index(x, y)] = distance;
    queue_.push({distance, y * along_ + x});
  }

  /// Along the edges and diagonals of open cells at the corner.
  void Leave(int x, int y, double distance) {
    for (const int dx : {-1, 1}) {
      for (const int dy : {-1, 1}) {
        if (!cells_.IsOpen(dx < 0 ? x - 1 : x, dy < 0 ? y - 1 : y)) continue;
        Reach(x + dx, y, distance + size_.x());
        Reach(x, y + dy, distance + size_.y());
        Reach(x + dx, y + dy, distance + size_.norm());
      }
    }
  }

  const PlanCells& cells_;
  Eigen::Vector2d size_;
  int along_;  ///< corners along x
  std::vector<double> distances_;
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
};

/// How much longer steps along edges and diagonals may be than a straight line.
double Detour(const Eigen::Vector2d& size) {
  const double widest = std::max(std::atan2(size.y(), size.x()), std::atan2(size.x(), size.y()));
  return 1 / std::cos(widest / 2);
}

}  // namespace

std::optional<double> LeastWay(const LocomotionModel& model, const World& world,
                               const GroundedStance& start,
                               const std::vector<GroundedStance>& goals, double resolution,
                               const std::vector<FlightBounds>& flights,
                               const CancellationToken& cancellation) {
  const PelvisCells cells = PelvisCellsOf(model, world, resolution, flights);
  if (!(cells.num_cells().head<2>().prod() <= kMostPlanCells)) return std::nullopt;
  const Eigen::Vector2d size = cells.size().head<2>();
  const auto open = ReachedCells(cells, start, {FloodLimits::kMostNodes, cancellation});
  if (!open) return std::nullopt;
  const PlanCells plan(static_cast<int>(cells.num_cells().x()),
                       static_cast<int>(cells.num_cells().y()), *open);
  const CornerDistances distances(plan, size, cells.CellOf(start));
  double least = kUnreached;
  for (const GroundedStance& goal : goals) {
    // Both ends are at most half a diagonal from the nearest corner of their cells.
    const double along = distances.To(cells.CellOf(goal)) / Detour(size) - size.norm();
    const double straight = (cells.BallAt(goal) - cells.BallAt(start)).head<2>().norm();
    least = std::min(least, std::max(along, straight));
  }
  if (least == kUnreached) return std::nullopt;
  return least;
}

}  // namespace possibility::actions
