#include "actions/footsteps/foothold_flood.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace possibility::actions {
namespace {

using Eigen::Vector2d;

constexpr double kLeastCell = 0.03;  // m
constexpr double kMostCells = 250e3;
constexpr int kTurns = 60;
constexpr double kTurn = 2 * std::numbers::pi / kTurns;
constexpr double kRounding = 1e-5;  // m
constexpr std::size_t kCellsPerQuestion = 1000;

}  // namespace

double FootholdFlood::ReachOf(const NominalStance& stance, const FootstepLimits& limits) {
  constexpr int kSamples = 32;
  double reach = 0;
  for (const int limb : {0, 1}) {
    const Vector2d centre = stance.patch_centres[limb].head<2>();
    const Vector2d other = stance.patch_centres[1 - limb].head<2>();
    // Between two samples the centre moves by less than this.
    const double between = centre.norm() * limits.turn / kSamples;
    for (int i = -kSamples; i <= kSamples; ++i) {
      const Vector2d turned = Eigen::Rotation2Dd(limits.turn * i / kSamples) * centre;
      for (const double ahead : {-limits.forward, limits.forward}) {
        for (const double aside : {-limits.lateral, limits.lateral}) {
          reach = std::max(reach, (Vector2d(ahead, aside) + turned - other).norm() + between);
        }
      }
    }
  }
  return reach + FootholdGround::kMostShift + kRounding;
}

FootholdFlood::FootholdFlood(const NominalStance& stance, const World& world,
                             const FootstepLimits& limits, const GroundedStance& start,
                             const CancellationToken& cancellation)
    : stance_(stance), world_(world), limits_(limits) {
  for (const int limb : {0, 1}) {
    Sole sole;
    const Vector2d centre = stance.patch_centres[limb].head<2>();
    for (const Vector2d& p : stance.bearing_points[limb]) {
      sole.radius = std::max(sole.radius, (p - centre).norm());
      for (int turn = 0; turn < kTurns; ++turn) {
        sole.points.push_back(Eigen::Rotation2Dd(turn * kTurn) * (p - centre));
      }
    }
    soles_.push_back(std::move(sole));
  }
  SizeGrid(ReachOf(stance, limits));
  Flood(start, cancellation);
}

/// The trunk stays within the world's bounds, so feet come no farther out than by a step.
void FootholdFlood::SizeGrid(double reach) {
  const double around = reach + stance_.X_SR.translation().head<2>().norm() +
                        2 * stance_.patch_centres[0].head<2>().norm();
  bounds_ = world_.environment->bounds;
  bounds_ = {bounds_.min() - Vector2d::Constant(around),
             bounds_.max() + Vector2d::Constant(around)};
  cell_ = std::max(kLeastCell, std::sqrt(bounds_.sizes().prod() / kMostCells));
  columns_ = static_cast<int>(std::ceil(bounds_.sizes().x() / cell_));
  rows_ = static_cast<int>(std::ceil(bounds_.sizes().y() / cell_));
  cells_.assign(world_.ground->levels().size(),
                std::vector<Cell>(static_cast<std::size_t>(columns_) * rows_, Cell::kUnknown));
  // Both ends may be anywhere in their cells.
  const double radius = reach / cell_ + std::numbers::sqrt2;
  for (int row = 0; row <= radius; ++row) {
    half_widths_.push_back(static_cast<int>(std::sqrt(radius * radius - row * row)));
  }
}

FootholdFlood::Place FootholdFlood::PlaceAt(int level, const Vector2d& p) const {
  const Vector2d at = (p - bounds_.min()) / cell_;
  return {level, static_cast<int>(std::clamp(std::floor(at.x()), 0.0, columns_ - 1.0)),
          static_cast<int>(std::clamp(std::floor(at.y()), 0.0, rows_ - 1.0))};
}

std::vector<int> FootholdFlood::LevelsWithin(double z) const {
  std::vector<int> within;
  const std::vector<double>& levels = world_.ground->levels();
  for (int level = 0; level < static_cast<int>(levels.size()); ++level) {
    if (std::abs(levels[level] - z) <= limits_.rise + kRounding) within.push_back(level);
  }
  return within;
}

bool FootholdFlood::MayBear(const Place& place) const {
  const Vector2d centre = CentreOf(place);
  return std::any_of(soles_.begin(), soles_.end(),
                     [&](const Sole& sole) { return MayBear(sole, place.level, centre); });
}

/// Every place and turn of the sole is near a turn that is tested at the cell's centre. Its points
/// are then so far from those tested, and their clearances differ by no more than that.
bool FootholdFlood::MayBear(const Sole& sole, int level, const Vector2d& centre) const {
  const models::GroundMap& ground = *world_.ground;
  if (ground.OneFaceHolds(level, centre, centre, sole.radius)) return true;
  const double slack = cell_ / std::numbers::sqrt2 + sole.radius * kTurn / 2 + kRounding;
  const double needed = limits_.margin - slack;
  if (!ground.IsNear(level, centre, sole.radius + std::max(0.0, -needed))) return false;
  const std::size_t points = sole.points.size() / kTurns;
  for (std::size_t turn = 0; turn < kTurns; ++turn) {
    bool fits = true;
    for (std::size_t i = 0; i < points && fits; ++i) {
      const Vector2d at = centre + sole.points[i * kTurns + turn];
      fits = needed > 0 ? ground.Clearance(level, at) >= needed : ground.IsNear(level, at, -needed);
    }
    if (fits) return true;
  }
  return false;
}

void FootholdFlood::Reach(const Place& place) {
  Cell& cell = At(place);
  if (cell != Cell::kUnknown) return;
  cell = MayBear(place) ? Cell::kReached : Cell::kNoGround;
  if (cell == Cell::kReached) queue_.push_back(place);
}

bool FootholdFlood::ReachNeighbours(const Place& place) {
  bool is_inside = true;
  for (int row = place.row - 1; row <= place.row + 1; ++row) {
    for (int column = place.column - 1; column <= place.column + 1; ++column) {
      const bool is_in_grid = IsInGrid(column, row);
      if (is_in_grid) Reach({place.level, column, row});
      is_inside &= is_in_grid && At({place.level, column, row}) == Cell::kReached;
    }
  }
  return is_inside;
}

void FootholdFlood::ReachAround(const Place& place, const std::vector<int>& levels) {
  const int most = static_cast<int>(half_widths_.size()) - 1;
  const double around = (most + 2) * cell_ + std::max(soles_[0].radius, soles_[1].radius);
  for (const int level : levels) {
    if (!world_.ground->IsNear(level, CentreOf(place), around)) continue;
    const int last = std::min(rows_ - 1, place.row + most);
    for (int row = std::max(0, place.row - most); row <= last; ++row) {
      const int half_width = half_widths_[std::abs(row - place.row)];
      const int end = std::min(columns_ - 1, place.column + half_width);
      for (int column = std::max(0, place.column - half_width); column <= end; ++column) {
        Reach({level, column, row});
      }
    }
  }
}

void FootholdFlood::Flood(const GroundedStance& start, const CancellationToken& cancellation) {
  std::vector<std::vector<int>> levels_of_level;
  for (const double z : world_.ground->levels()) levels_of_level.push_back(LevelsWithin(z));
  for (const int limb : {0, 1}) {
    const Vector2d centre = start.pose * Vector2d(stance_.patch_centres[limb].head<2>());
    ReachAround(PlaceAt(0, centre), LevelsWithin(start.z));
  }
  for (std::size_t i = 0; i < queue_.size(); ++i) {
    if (i % kCellsPerQuestion == 0) cancellation.ThrowIfCancelled();
    const Place place = queue_[i];
    const std::vector<int>& levels = levels_of_level[place.level];
    if (ReachNeighbours(place)) {
      for (const int level : levels) Reach({level, place.column, place.row});
    } else {
      ReachAround(place, levels);
    }
  }
  queue_ = {};
}

bool FootholdFlood::Reaches(int limb, const Foothold& place) const {
  const Vector2d centre = place.stance * Vector2d(stance_.patch_centres[limb].head<2>());
  const std::vector<double>& levels = world_.ground->levels();
  for (int level = 0; level < static_cast<int>(levels.size()); ++level) {
    if (std::abs(levels[level] - place.z) > kRounding) continue;
    const Place at = PlaceAt(level, centre);
    if (cells_[level][static_cast<std::size_t>(at.row) * columns_ + at.column] == Cell::kReached) {
      return true;
    }
  }
  return false;
}

bool FootholdFlood::Reaches(const GroundedStance& goal) const {
  return Reaches(0, {goal.pose, goal.z}) && Reaches(1, {goal.pose, goal.z});
}

}  // namespace possibility::actions
