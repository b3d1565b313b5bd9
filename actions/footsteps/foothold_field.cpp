#include "actions/footsteps/foothold_field.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "actions/footsteps/foothold_flood.h"

namespace possibility::actions {
namespace {

using Eigen::Vector2d;

constexpr double kLeastCell = 0.05;  // m
constexpr int kTurns = 16;           // by half a turn
constexpr double kTurn = std::numbers::pi / kTurns;
constexpr double kMostCells = 400e3;  // of all planes
constexpr std::size_t kCellsPerQuestion = 1000;
}  // namespace

const std::vector<double>* FootholdField::StepTimes::Over(double rise) const {
  const auto row = static_cast<std::size_t>(std::lround(std::abs(rise) / spacing));
  return row < times.size() ? &times[row] : nullptr;
}

FootholdField::FootholdField(const NominalStance& stance, const World& world,
                             const std::vector<int>& planes, const FootstepLimits& limits,
                             const std::vector<GroundedStance>& goals,
                             const std::vector<double>& goal_times, StepTimes steps)
    : stance_(stance),
      world_(world),
      planes_(planes),
      limits_(limits),
      steps_(std::move(steps)),
      reach_(FootholdFlood::ReachOf(stance, limits)),
      cover_(stance, *world.environment) {
  for (const int limb : {0, 1}) {
    const Vector2d centre = stance.patch_centres[limb].head<2>();
    for (int turn = 0; turn < kTurns; ++turn) {
      std::vector<Vector2d> sole;
      for (const Vector2d& p : stance.bearing_points[limb]) {
        sole.push_back(Eigen::Rotation2Dd(turn * kTurn) * (p - centre));
        radius_ = std::max(radius_, sole.back().norm());
        if (turn == 0) width_ = std::max(width_, 2 * std::abs(sole.back().y()));
      }
      soles_.push_back(std::move(sole));
    }
  }
  SizeGrid();
  Begin(goals, goal_times);
}

void FootholdField::SizeGrid() {
  bounds_ = world_.environment->bounds;
  if (bounds_.isEmpty()) bounds_ = Eigen::AlignedBox2d(Vector2d::Zero(), Vector2d::Zero());
  bounds_ = {bounds_.min() - Vector2d::Constant(reach_),
             bounds_.max() + Vector2d::Constant(reach_)};
  const double area = bounds_.sizes().prod() * static_cast<double>(planes_.size());
  cell_ = std::max(kLeastCell, std::sqrt(area / kMostCells));
  columns_ = static_cast<int>(std::ceil(bounds_.sizes().x() / cell_));
  rows_ = static_cast<int>(std::ceil(bounds_.sizes().y() / cell_));
  const std::size_t cells = static_cast<std::size_t>(columns_) * rows_ * planes_.size();
  cells_.assign(cells, Cell::kUnknown);
  fits_.assign(cells, 0);
  layers_about_.resize(static_cast<std::size_t>(columns_) * rows_);
  times_.assign(cells, std::numeric_limits<double>::infinity());
  const int most = static_cast<int>(reach_ / cell_);
  for (int row = -most; row <= most; ++row) {
    for (int column = -most; column <= most; ++column) {
      const double distance = cell_ * std::hypot(column, row);
      if (distance > reach_) continue;
      const double least = std::max(0.0, distance - cell_ / std::numbers::sqrt2);
      disc_.push_back(
          {column, row, distance, static_cast<std::size_t>(std::lround(least / steps_.spacing))});
    }
  }
  std::stable_sort(disc_.begin(), disc_.end(),
                   [](const Offset& a, const Offset& b) { return a.distance < b.distance; });
}

void FootholdField::Begin(const std::vector<GroundedStance>& goals,
                          const std::vector<double>& goal_times) {
  for (std::size_t i = 0; i < goals.size(); ++i) {
    for (const int limb : {0, 1}) {
      const Vector2d centre = goals[i].pose * Vector2d(stance_.patch_centres[limb].head<2>());
      for (int plane = 0; plane < static_cast<int>(planes_.size()); ++plane) {
        const double height = world_.ground->planes()[planes_[plane]].HeightAt(centre);
        if (std::abs(height - goals[i].z) > limits_.rise) continue;
        Offer(PlaceAt(plane, centre), goal_times.empty() ? 0 : goal_times[i]);
      }
    }
  }
}

FootholdField::Place FootholdField::PlaceOf(std::size_t index) const {
  const std::size_t row = index / columns_;
  return {static_cast<int>(row / rows_), static_cast<int>(index % columns_),
          static_cast<int>(row % rows_)};
}

FootholdField::Place FootholdField::PlaceAt(int plane, const Vector2d& p) const {
  const Vector2d at = (p - bounds_.min()) / cell_;
  return {plane, static_cast<int>(std::clamp(std::floor(at.x()), 0.0, columns_ - 1.0)),
          static_cast<int>(std::clamp(std::floor(at.y()), 0.0, rows_ - 1.0))};
}

double FootholdField::HeightOf(const Place& place) const {
  return world_.ground->planes()[planes_[place.plane]].HeightAt(CentreOf(place));
}

bool FootholdField::IsHorizontal(int plane) const {
  return world_.ground->planes()[planes_[plane]].normal == Eigen::Vector3d::UnitZ();
}

/// Every place and turn of a sole in the cell is near a turn that is tested at its centre.
bool FootholdField::MayBear(const Place& place) const {
  const models::GroundMap& ground = *world_.ground;
  const int plane = planes_[place.plane];
  const Vector2d centre = CentreOf(place);
  if (IsHorizontal(place.plane) && cover_.Covers(centre, cell_ / 2, HeightOf(place))) return false;
  if (ground.OneFaceHolds(plane, centre, centre, radius_)) return true;
  const double slack = cell_ / std::numbers::sqrt2 + radius_ * kTurn / 2;
  if (!ground.IsNear(plane, centre, slack)) return false;
  return std::any_of(soles_.begin(), soles_.end(), [&](const std::vector<Vector2d>& sole) {
    return std::all_of(sole.begin(), sole.end(), [&](const Vector2d& p) {
      return ground.Clearance(plane, centre + p) >= limits_.margin - slack;
    });
  });
}

bool FootholdField::IsGround(const Place& place) {
  Cell& cell = cells_[IndexOf(place)];
  if (cell == Cell::kUnknown) cell = MayBear(place) ? Cell::kGround : Cell::kNoGround;
  return cell != Cell::kNoGround;
}

/// All around it is ground.
bool FootholdField::IsInside(const Place& place) {
  for (int row = place.row - 1; row <= place.row + 1; ++row) {
    for (int column = place.column - 1; column <= place.column + 1; ++column) {
      if (!IsInGrid(column, row) || !IsGround({place.plane, column, row})) return false;
    }
  }
  return true;
}

void FootholdField::Offer(const Place& place, double time) {
  const std::size_t index = IndexOf(place);
  if (!(time < times_[index]) || !IsGround(place)) return;
  times_[index] = time;
  queue_.push({time, index});
}

void FootholdField::VisitPlane(const Place& from, double time, int plane) {
  const double z = HeightOf(from);
  const std::vector<double>& level = steps_.times.front();
  const bool is_same = plane == from.plane;
  for (const Offset& offset : disc_) {
    if (!std::isfinite(level[offset.bin])) break;
    const Place to{plane, from.column + offset.column, from.row + offset.row};
    if (!IsInGrid(to.column, to.row) || time + level[offset.bin] >= times_[IndexOf(to)]) continue;
    const std::vector<double>* step = is_same ? &level : steps_.Over(HeightOf(to) - z);
    if (step) Offer(to, time + (*step)[offset.bin]);
  }
}

/// From inside a plane's ground, a step to another plane leads over the edge or to what lies above.
void FootholdField::Visit(const Entry& at) {
  const Place place = PlaceOf(at.index);
  const bool is_inside = IsInside(place);
  for (int row = -1; row <= 1; ++row) {
    for (int column = -1; column <= 1; ++column) {
      const Place to{place.plane, place.column + column, place.row + row};
      if (!IsInGrid(to.column, to.row)) continue;
      Offer(to, at.time + steps_.pace * cell_ * std::hypot(column, row));
    }
  }
  const Vector2d centre = CentreOf(place);
  const double z = HeightOf(place);
  for (int plane = 0; plane < static_cast<int>(planes_.size()); ++plane) {
    if (is_inside) {
      const Place above{plane, place.column, place.row};
      const std::vector<double>* step =
          plane == place.plane ? nullptr : steps_.Over(HeightOf(above) - z);
      if (step) Offer(above, at.time + step->front());
    } else if (world_.ground->IsNear(planes_[plane], centre, reach_)) {
      VisitPlane(place, at.time, plane);
    }
  }
}

double FootholdField::TimeOf(const Place& place, const CancellationToken& cancellation) {
  const std::size_t index = IndexOf(place);
  while (!queue_.empty() && queue_.top().time < times_[index]) {
    const Entry at = queue_.top();
    queue_.pop();
    if (at.time > times_[at.index]) continue;
    if (++visited_ % kCellsPerQuestion == 0) cancellation.ThrowIfCancelled();
    Visit(at);
  }
  return times_[index];
}

bool FootholdField::Fits(const Place& place, int turn) {
  std::uint32_t& bits = fits_[IndexOf(place)];
  const std::uint32_t fits = 1U << turn, known = fits << kTurns;
  if (!(bits & known)) {
    bits |= known;
    const Vector2d centre = CentreOf(place);
    const int plane = planes_[place.plane];
    // Either limb's: they are alike but for their side.
    const std::vector<Vector2d>& sole = soles_[turn];
    const bool holds = std::all_of(sole.begin(), sole.end(), [&](const Vector2d& p) {
      return world_.ground->Clearance(plane, centre + p) >= limits_.margin;
    });
    if (holds) bits |= fits;
  }
  return bits & fits;
}

const std::vector<int>& FootholdField::LayersAbout(const Place& place) {
  std::vector<int>& about =
      layers_about_[static_cast<std::size_t>(place.row) * columns_ + place.column];
  if (about.empty()) {
    about.push_back(-1);  // asked
    for (int layer = 0; layer < static_cast<int>(planes_.size()); ++layer) {
      if (world_.ground->IsNear(planes_[layer], CentreOf(place), reach_ / 2 + cell_)) {
        about.push_back(layer);
      }
    }
  }
  return about;
}

bool FootholdField::Stands(int layer, const PlanarPose& middle, double gap) {
  const Vector2d p = middle.position();
  const double around = reach_ / 2 + cell_;
  const double needed = width_ + gap;
  const double z = world_.ground->planes()[planes_[layer]].HeightAt(p);
  const bool is_bare = !IsHorizontal(layer) || cover_.IsBare(p, needed / 2, z);
  if (is_bare && world_.ground->OneFaceHolds(planes_[layer], p, p, needed)) return true;
  const int turn = static_cast<int>(std::lround(middle.yaw / kTurn)) & (kTurns - 1);
  const Place centre = PlaceAt(layer, p);
  const double sine = std::sin(middle.yaw), cosine = std::cos(middle.yaw);
  double left = -around, right = around;
  for (const int other : LayersAbout(centre)) {
    if (other < 0) continue;
    for (const Offset& offset : disc_) {
      if (offset.distance > around) break;
      const double beside = cell_ * (cosine * offset.row - sine * offset.column);
      if (beside <= left && beside >= right) continue;
      const Place at{other, centre.column + offset.column, centre.row + offset.row};
      if (!IsInGrid(at.column, at.row) || !IsGround(at) || !Fits(at, turn)) continue;
      if (std::abs(HeightOf(at) - z) > limits_.rise) continue;
      left = std::max(left, beside);
      right = std::min(right, beside);
      if (left - right >= needed) return true;
    }
  }
  return false;
}

double FootholdField::LongestStep() const {
  double longest = 0;
  for (const std::vector<double>& row : steps_.times) {
    for (const double time : row) {
      if (std::isfinite(time)) longest = std::max(longest, time);
    }
  }
  return longest;
}

double FootholdField::Nearest(int layer, const Vector2d& p, double most,
                              const CancellationToken& cancellation) {
  const Place centre = PlaceAt(layer, p);
  double nearest = most;
  double least = std::numeric_limits<double>::infinity();
  for (const Offset& offset : disc_) {
    if (offset.distance > nearest) break;
    const Place at{layer, centre.column + offset.column, centre.row + offset.row};
    if (!IsInGrid(at.column, at.row) || !IsGround(at)) continue;
    nearest = offset.distance;
    least = std::min(least, TimeOf(at, cancellation));
  }
  return least;
}

double FootholdField::At(int limb, const PlanarPose& stance, int layer,
                         const CancellationToken& cancellation) {
  return Nearest(layer, stance * Vector2d(stance_.patch_centres[limb].head<2>()),
                 FootholdGround::kMostShift + cell_, cancellation);
}

double FootholdField::Near(int layer, const Vector2d& p, const CancellationToken& cancellation) {
  if (!world_.ground->IsNear(planes_[layer], p, reach_ / 2 + cell_)) {
    return std::numeric_limits<double>::infinity();
  }
  return Nearest(layer, p, reach_ / 2 + cell_, cancellation);
}

}  // namespace possibility::actions
