#include "actions/footholds/foothold_cells.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "actions/footholds/foothold_flood.h"

namespace possibility::actions {
namespace {

using Eigen::Vector2d;

constexpr double kLeastCell = 0.05;   // m
constexpr double kMostCells = 400e3;  // of all planes
constexpr int kSoleTurns = 16;        // by half a turn
constexpr double kSoleTurn = std::numbers::pi / kSoleTurns;

}  // namespace

FootholdCells::FootholdCells(const NominalStance& stance, const World& world,
                             std::vector<int> planes, const FootstepLimits& limits)
    : stance_(stance),
      world_(world),
      planes_(std::move(planes)),
      margin_(limits.margin),
      reach_(FootholdFlood::ReachOf(stance, limits)),
      cover_(stance, *world.environment),
      bounds_(world.environment->bounds) {
  for (const int limb : {0, 1}) {
    const Vector2d centre = stance_.patch_centres[limb].head<2>();
    for (int turn = 0; turn < kSoleTurns; ++turn) {
      std::vector<Vector2d> sole;
      for (const Vector2d& p : stance_.bearing_points[limb]) {
        sole.push_back(Eigen::Rotation2Dd(turn * kSoleTurn) * (p - centre));
        radius_ = std::max(radius_, sole.back().norm());
      }
      soles_.push_back(std::move(sole));
    }
  }
  if (bounds_.isEmpty()) bounds_ = Eigen::AlignedBox2d(Vector2d::Zero(), Vector2d::Zero());
  bounds_ = {bounds_.min() - Vector2d::Constant(reach_),
             bounds_.max() + Vector2d::Constant(reach_)};
  const double area = bounds_.sizes().prod() * static_cast<double>(planes_.size());
  cell_ = std::max(kLeastCell, std::sqrt(area / kMostCells));
  columns_ = static_cast<int>(std::ceil(bounds_.sizes().x() / cell_));
  rows_ = static_cast<int>(std::ceil(bounds_.sizes().y() / cell_));
  state_ =
      std::vector<std::atomic<State>>(static_cast<std::size_t>(columns_) * rows_ * planes_.size());
}

std::vector<FootholdCells::Offset> FootholdCells::Disc(double radius) const {
  std::vector<Offset> disc;
  const int most = static_cast<int>(radius / cell_);
  for (int row = -most; row <= most; ++row) {
    for (int column = -most; column <= most; ++column) {
      const double distance = cell_ * std::hypot(column, row);
      if (distance <= radius) disc.push_back({column, row, distance});
    }
  }
  std::stable_sort(disc.begin(), disc.end(),
                   [](const Offset& a, const Offset& b) { return a.distance < b.distance; });
  return disc;
}

FootholdCells::Place FootholdCells::PlaceOf(std::size_t index) const {
  const std::size_t row = index / columns_;
  return {static_cast<int>(row / rows_), static_cast<int>(index % columns_),
          static_cast<int>(row % rows_)};
}

FootholdCells::Place FootholdCells::PlaceAt(int plane, const Vector2d& p) const {
  const Vector2d at = (p - bounds_.min()) / cell_;
  return {plane, static_cast<int>(std::clamp(std::floor(at.x()), 0.0, columns_ - 1.0)),
          static_cast<int>(std::clamp(std::floor(at.y()), 0.0, rows_ - 1.0))};
}

double FootholdCells::HeightOf(const Place& place) const {
  return world_.ground->planes()[planes_[place.plane]].HeightAt(CentreOf(place));
}

bool FootholdCells::IsHorizontal(int plane) const {
  return world_.ground->planes()[planes_[plane]].normal == Eigen::Vector3d::UnitZ();
}

/// Every place and turn of a sole in the cell is near a turn that is tested at its centre.
bool FootholdCells::MayBear(const Place& place) const {
  const models::GroundMap& ground = *world_.ground;
  const int plane = planes_[place.plane];
  const Vector2d centre = CentreOf(place);
  const double slack = cell_ / std::numbers::sqrt2 + radius_ * kSoleTurn / 2;
  if (!ground.IsNear(plane, centre, slack)) return false;
  if (IsHorizontal(place.plane) && cover_.Covers(centre, cell_ / 2, HeightOf(place))) return false;
  const bool holds_all = ground.OneFaceHolds(plane, centre, centre, radius_) ||
                         ground.Clearance(plane, centre) >= radius_ + margin_ - slack;
  if (holds_all) return true;
  return std::any_of(soles_.begin(), soles_.end(), [&](const std::vector<Vector2d>& sole) {
    return std::all_of(sole.begin(), sole.end(), [&](const Vector2d& p) {
      return ground.Clearance(plane, centre + p) >= margin_ - slack;
    });
  });
}

/// Two threads that ask for a cell at once find the same.
bool FootholdCells::IsGround(const Place& place) const {
  std::atomic<State>& known = state_[IndexOf(place)];
  State state = known.load(std::memory_order_relaxed);
  if (state == kUnknown) {
    state = MayBear(place) ? kGround : kNoGround;
    known.store(state, std::memory_order_relaxed);
  }
  return state == kGround;
}

bool FootholdCells::IsInside(const Place& place) const {
  for (int row = place.row - 1; row <= place.row + 1; ++row) {
    for (int column = place.column - 1; column <= place.column + 1; ++column) {
      if (!IsInGrid(column, row) || !IsGround({place.plane, column, row})) return false;
    }
  }
  return true;
}

}  // namespace possibility::actions
