#include "actions/footholds/foothold_flood.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "actions/footholds/swing_barriers.h"

namespace possibility::actions {
namespace {

using Eigen::Vector2d;

constexpr double kLeastFloodCell = 0.03;   // m
constexpr double kMostFloodCells = 2.5e6;  // of all planes
/// Of a sole's places in a cell: turns that are looked at first, and how exactly what is between
/// them is looked at, m.
constexpr int kFloodTurns = 24;
constexpr double kFinestSlack = 0.004;
constexpr double kRounding = 1e-5;  // m
constexpr std::size_t kFloodCellsPerQuestion = 1000;

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
                             std::vector<int> planes, const FootstepLimits& limits,
                             const std::vector<GroundedStance>& starts,
                             const CancellationToken& cancellation)
    : stance_(stance),
      world_(world),
      planes_(std::move(planes)),
      limits_(limits),
      cover_(stance, *world.environment),
      reach_(ReachOf(stance, limits)) {
  for (const int limb : {0, 1}) {
    Sole sole;
    const Vector2d centre = stance.patch_centres[limb].head<2>();
    for (const Vector2d& p : stance.bearing_points[limb]) {
      sole.radius = std::max(sole.radius, (p - centre).norm());
      sole.points.push_back(p - centre);
    }
    soles_.push_back(std::move(sole));
  }
  SizeGrid();
  FindBarriers();
  Restart(starts, cancellation);
}

void FootholdFlood::Restart(const std::vector<GroundedStance>& starts,
                            const CancellationToken& cancellation) {
  for (std::vector<Cell>& cells : cells_) {
    for (Cell& cell : cells) {
      if (cell == Cell::kReached) cell = Cell::kGround;
      if (cell == Cell::kBarred) cell = Cell::kUnknown;
    }
  }
  queue_.clear();
  FloodAir(starts);
  for (const GroundedStance& start : starts) ReachFrom(start);
  Flood(cancellation);
}

/// The trunk stays within the world's bounds, so feet come no farther out than by a step.
void FootholdFlood::SizeGrid() {
  const double around = reach_ + stance_.X_SR.translation().head<2>().norm() +
                        2 * stance_.patch_centres[0].head<2>().norm();
  bounds_ = world_.environment->bounds;
  bounds_ = {bounds_.min() - Vector2d::Constant(around),
             bounds_.max() + Vector2d::Constant(around)};
  const double area = bounds_.sizes().prod() * static_cast<double>(planes_.size());
  cell_ = std::max(kLeastFloodCell, std::sqrt(area / kMostFloodCells));
  columns_ = static_cast<int>(std::ceil(bounds_.sizes().x() / cell_));
  rows_ = static_cast<int>(std::ceil(bounds_.sizes().y() / cell_));
  cells_.assign(planes_.size(),
                std::vector<Cell>(static_cast<std::size_t>(columns_) * rows_, Cell::kUnknown));
  // Both ends may be anywhere in their cells.
  const double radius = reach_ / cell_ + std::numbers::sqrt2;
  for (int row = 0; row <= radius; ++row) {
    half_widths_.push_back(static_cast<int>(std::sqrt(radius * radius - row * row)));
  }
}

/// A swing leads straight from one place to another. The trunk is within the world's bounds at
/// both, half-way between the limbs.
void FootholdFlood::FindBarriers() {
  is_solid_.assign(static_cast<std::size_t>(columns_) * rows_, false);
  const SwingBarriers barriers(stance_, world_, planes_, limits_, reach_);
  if (barriers.empty()) return;
  const double around = reach_ / 2 + stance_.X_SR.translation().head<2>().norm() +
                        stance_.patch_centres[0].head<2>().norm() + cell_;
  const Eigen::AlignedBox2d& bounds = world_.environment->bounds;
  const Eigen::AlignedBox2d used(bounds.min() - Vector2d::Constant(around),
                                 bounds.max() + Vector2d::Constant(around));
  const Eigen::AlignedBox2d about = barriers.Bounds();
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column) {
      const Vector2d centre = CentreOf({0, column, row});
      is_solid_[IndexOf(column, row)] =
          !used.contains(centre) || (about.contains(centre) && barriers.Fill(centre, cell_ / 2));
    }
  }
}

void FootholdFlood::FloodAir(const std::vector<GroundedStance>& starts) {
  std::vector<bool> is_open(is_solid_.size(), false);
  std::vector<Place> queue;
  const auto open = [&](int column, int row) {
    const std::size_t index = IndexOf(column, row);
    if (is_open[index] || is_solid_[index]) return;
    is_open[index] = true;
    queue.push_back({0, column, row});
  };
  for (const GroundedStance& start : starts) {
    for (const int limb : {0, 1}) {
      const Vector2d centre = start.pose * Vector2d(stance_.patch_centres[limb].head<2>());
      const Place at = PlaceAt(0, centre);
      open(at.column, at.row);
    }
  }
  while (!queue.empty()) {
    const Place at = queue.back();
    queue.pop_back();
    for (int row = std::max(0, at.row - 1); row <= std::min(rows_ - 1, at.row + 1); ++row) {
      for (int column = std::max(0, at.column - 1); column <= std::min(columns_ - 1, at.column + 1);
           ++column) {
        open(column, row);
      }
    }
  }
  is_open.flip();
  is_barred_ = std::move(is_open);
}

FootholdFlood::Place FootholdFlood::PlaceAt(int plane, const Vector2d& p) const {
  const Vector2d at = (p - bounds_.min()) / cell_;
  return {plane, static_cast<int>(std::clamp(std::floor(at.x()), 0.0, columns_ - 1.0)),
          static_cast<int>(std::clamp(std::floor(at.y()), 0.0, rows_ - 1.0))};
}

/// Levels are the ground's first planes.
bool FootholdFlood::IsLevel(int plane) const {
  return planes_[plane] < static_cast<int>(world_.ground->levels().size());
}

double FootholdFlood::HeightOf(const Place& place) const {
  return world_.ground->planes()[planes_[place.plane]].HeightAt(CentreOf(place));
}

double FootholdFlood::SlackOf(int plane) const {
  if (IsLevel(plane)) return 0;
  const Eigen::Vector3d& normal = world_.ground->planes()[planes_[plane]].normal;
  return cell_ / std::numbers::sqrt2 * normal.head<2>().norm() / normal.z();
}

std::vector<int> FootholdFlood::PlanesAbout(const Vector2d& p, double z, double slack) const {
  // A sole may straddle what its centre is over.
  const double away = reach_ + 2 * cell_ + std::max(soles_[0].radius, soles_[1].radius);
  std::vector<int> about;
  for (int plane = 0; plane < static_cast<int>(planes_.size()); ++plane) {
    const models::GroundPlane& ground = world_.ground->planes()[planes_[plane]];
    const double steepness = ground.normal.head<2>().norm() / ground.normal.z();
    const double most = limits_.rise + kRounding + slack + SlackOf(plane) + steepness * away;
    if (std::abs(ground.HeightAt(p) - z) > most) continue;
    // A way in a slope is longer than it is from above.
    if (world_.ground->IsNear(planes_[plane], p, away / ground.normal.z())) about.push_back(plane);
  }
  return about;
}

bool FootholdFlood::IsCovered(const Place& place) const {
  if (world_.ground->planes()[planes_[place.plane]].normal != Eigen::Vector3d::UnitZ())
    return false;
  return cover_.Covers(CentreOf(place), cell_ / 2, HeightOf(place));
}

/// On slopes it is enough that there is ground.
bool FootholdFlood::MayBear(const Place& place) const {
  if (IsCovered(place)) return false;
  const Vector2d centre = CentreOf(place);
  const int plane = planes_[place.plane];
  if (!IsLevel(place.plane)) {
    const double slack = cell_ / std::numbers::sqrt2 + kRounding;
    return world_.ground->IsNear(plane, centre, slack / world_.ground->planes()[plane].normal.z());
  }
  return std::any_of(soles_.begin(), soles_.end(),
                     [&](const Sole& sole) { return MayBear(sole, plane, centre); });
}

bool FootholdFlood::MayBear(const Sole& sole, int level, const Vector2d& centre) const {
  if (world_.ground->OneFaceHolds(level, centre, centre, sole.radius)) return true;
  if (!world_.ground->IsNear(level, centre, sole.radius + cell_)) return false;
  for (int i = 0; i < kFloodTurns; ++i) {
    const double turn = 2 * std::numbers::pi / kFloodTurns * i;
    if (MayBear(sole, level, {centre, cell_ / 2, turn, std::numbers::pi / kFloodTurns}))
      return true;
  }
  return false;
}

/// In all places, points are no farther than the slack from where they are in the middle, and their
/// clearances differ by no more than that.
bool FootholdFlood::MayBear(const Sole& sole, int level, const SolePlaces& places) const {
  const double by_place = std::numbers::sqrt2 * places.half_side;
  const double by_turn = sole.radius * places.half_turn;
  const double slack = by_place + by_turn + kRounding;
  if (!Fits(sole, level, places, slack)) return false;
  if (slack <= kFinestSlack || Fits(sole, level, places, 0)) return true;
  SolePlaces part = places;
  if (by_turn > by_place) {
    part.half_turn /= 2;
    for (const double side : {-1, 1}) {
      part.turn = places.turn + side * part.half_turn;
      if (MayBear(sole, level, part)) return true;
    }
    return false;
  }
  part.half_side /= 2;
  for (const double x : {-1, 1}) {
    for (const double y : {-1, 1}) {
      part.centre = places.centre + part.half_side * Vector2d(x, y);
      if (MayBear(sole, level, part)) return true;
    }
  }
  return false;
}

bool FootholdFlood::Fits(const Sole& sole, int level, const SolePlaces& places,
                         double slack) const {
  const models::GroundMap& ground = *world_.ground;
  const double needed = limits_.margin - slack;
  const Eigen::Rotation2Dd turned(places.turn);
  return std::all_of(sole.points.begin(), sole.points.end(), [&](const Vector2d& p) {
    const Vector2d at = places.centre + turned * p;
    return needed > 0 ? ground.Clearance(level, at) >= needed : ground.IsNear(level, at, -needed);
  });
}

void FootholdFlood::Reach(const Place& place) {
  Cell& cell = At(place);
  if (!IsOpen(cell)) return;
  if (is_barred_[IndexOf(place.column, place.row)]) {
    cell = Cell::kBarred;
    return;
  }
  cell = cell == Cell::kGround || MayBear(place) ? Cell::kReached : Cell::kNoGround;
  if (cell == Cell::kReached) queue_.push_back(place);
}

bool FootholdFlood::ReachNeighbours(const Place& place) {
  bool is_inside = true;
  for (int row = place.row - 1; row <= place.row + 1; ++row) {
    for (int column = place.column - 1; column <= place.column + 1; ++column) {
      const bool is_in_grid = IsInGrid(column, row);
      if (is_in_grid) Reach({place.plane, column, row});
      is_inside &= is_in_grid && At({place.plane, column, row}) == Cell::kReached;
    }
  }
  return is_inside;
}

void FootholdFlood::ReachAround(const Place& centre, double z, double slack, int plane) {
  const int most = static_cast<int>(half_widths_.size()) - 1;
  const double most_height = limits_.rise + kRounding + slack + SlackOf(plane);
  const int last = std::min(rows_ - 1, centre.row + most);
  for (int row = std::max(0, centre.row - most); row <= last; ++row) {
    const int half_width = half_widths_[std::abs(row - centre.row)];
    const int end = std::min(columns_ - 1, centre.column + half_width);
    for (int column = std::max(0, centre.column - half_width); column <= end; ++column) {
      const Place place{plane, column, row};
      if (IsOpen(At(place)) && std::abs(HeightOf(place) - z) <= most_height) Reach(place);
    }
  }
}

/// From inside a level, a step to another level leads over the edge or to what lies above.
void FootholdFlood::Expand(const Place& place) {
  const bool is_inside = ReachNeighbours(place);
  const double z = HeightOf(place);
  const double slack = SlackOf(place.plane);
  for (const int plane : PlanesAbout(CentreOf(place), z, slack)) {
    if (is_inside && plane == place.plane) continue;
    if (is_inside && IsLevel(place.plane) && IsLevel(plane)) {
      Reach({plane, place.column, place.row});
    } else {
      ReachAround(place, z, slack, plane);
    }
  }
}

void FootholdFlood::ReachFrom(const GroundedStance& start) {
  for (const int limb : {0, 1}) {
    const Vector2d centre = start.pose * Vector2d(stance_.patch_centres[limb].head<2>());
    for (const int plane : PlanesAbout(centre, start.z, 0)) {
      ReachAround(PlaceAt(0, centre), start.z, 0, plane);
    }
  }
}

void FootholdFlood::Flood(const CancellationToken& cancellation) {
  for (std::size_t i = 0; i < queue_.size(); ++i) {
    if (i % kFloodCellsPerQuestion == 0) cancellation.ThrowIfCancelled();
    Expand(Place(queue_[i]));  // a copy: reaching moves the queue
  }
  queue_ = {};
}

bool FootholdFlood::Reaches(int limb, const Foothold& place) const {
  const Vector2d centre = place.stance * Vector2d(stance_.patch_centres[limb].head<2>());
  for (int plane = 0; plane < static_cast<int>(planes_.size()); ++plane) {
    const models::GroundPlane& ground = world_.ground->planes()[planes_[plane]];
    if (std::abs(ground.HeightAt(centre) - place.z) > kRounding) continue;
    const Place at = PlaceAt(plane, centre);
    if (cells_[plane][static_cast<std::size_t>(at.row) * columns_ + at.column] == Cell::kReached) {
      return true;
    }
  }
  return false;
}

bool FootholdFlood::Reaches(const GroundedStance& goal) const {
  return Reaches(0, {goal.pose, goal.z}) && Reaches(1, {goal.pose, goal.z});
}

}  // namespace possibility::actions
