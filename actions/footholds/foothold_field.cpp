#include "actions/footholds/foothold_field.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "actions/footholds/foothold_flood.h"

namespace possibility::actions {
namespace {

using Eigen::Vector2d;

constexpr std::size_t kCellsPerQuestion = 1000;

}  // namespace

const std::vector<double>* FootholdField::StepTimes::Over(double rise) const {
  const auto row = static_cast<std::size_t>(std::lround(std::abs(rise) / spacing));
  return row < times.size() ? &times[row] : nullptr;
}

FootholdField::FootholdField(const FootholdCells& cells, const NominalStance& stance,
                             const World& world, const FootstepLimits& limits,
                             const std::vector<GroundedStance>& goals,
                             const std::vector<double>& goal_times, StepTimes steps)
    : cells_(cells),
      stance_(stance),
      world_(world),
      limits_(limits),
      steps_(std::move(steps)),
      times_(cells.size(), std::numeric_limits<double>::infinity()) {
  for (const FootholdCells::Offset& offset : cells.Disc(cells.reach())) {
    const double least = std::max(0.0, offset.distance - cells.cell() / std::numbers::sqrt2);
    disc_.push_back({offset.column, offset.row, offset.distance,
                     static_cast<std::size_t>(std::lround(least / steps_.spacing))});
  }
  Begin(goals, goal_times);
}

void FootholdField::Begin(const std::vector<GroundedStance>& goals,
                          const std::vector<double>& goal_times) {
  for (std::size_t i = 0; i < goals.size(); ++i) {
    for (const int limb : {0, 1}) {
      const Vector2d centre = goals[i].pose * Vector2d(stance_.patch_centres[limb].head<2>());
      for (int plane = 0; plane < cells_.NumPlanes(); ++plane) {
        const double height = world_.ground->planes()[cells_.planes()[plane]].HeightAt(centre);
        if (std::abs(height - goals[i].z) > limits_.rise) continue;
        Offer(cells_.PlaceAt(plane, centre), goal_times.empty() ? 0 : goal_times[i]);
      }
    }
  }
}

void FootholdField::Offer(const Place& place, double time) {
  const std::size_t index = cells_.IndexOf(place);
  if (!(time < times_[index]) || !cells_.IsGround(place)) return;
  times_[index] = time;
  queue_.push({time, index});
}

void FootholdField::VisitPlane(const Place& from, double time, int plane) {
  const double z = cells_.HeightOf(from);
  const std::vector<double>& level = steps_.times.front();
  const bool is_one_rise = plane == from.plane || cells_.IsHorizontal(plane);
  const std::vector<double>* step = &level;
  if (plane != from.plane) step = steps_.Over(cells_.HeightOf({plane, from.column, from.row}) - z);
  if (is_one_rise && !step) return;
  for (const Offset& offset : disc_) {
    if (!std::isfinite(level[offset.bin])) break;
    const Place to{plane, from.column + offset.column, from.row + offset.row};
    if (!cells_.IsInGrid(to.column, to.row)) continue;
    if (time + level[offset.bin] >= times_[cells_.IndexOf(to)]) continue;
    if (!is_one_rise) step = steps_.Over(cells_.HeightOf(to) - z);
    if (step) Offer(to, time + (*step)[offset.bin]);
  }
}

/// From inside a plane's ground, a step to another plane leads over the edge or to what lies above.
void FootholdField::Visit(const Entry& at) {
  const Place place = cells_.PlaceOf(at.index);
  const bool is_inside = cells_.IsInside(place);
  for (int row = -1; row <= 1; ++row) {
    for (int column = -1; column <= 1; ++column) {
      const Place to{place.plane, place.column + column, place.row + row};
      if (!cells_.IsInGrid(to.column, to.row)) continue;
      Offer(to, at.time + steps_.pace * cells_.cell() * std::hypot(column, row));
    }
  }
  const Vector2d centre = cells_.CentreOf(place);
  const double z = cells_.HeightOf(place);
  for (int plane = 0; plane < cells_.NumPlanes(); ++plane) {
    if (is_inside) {
      const Place above{plane, place.column, place.row};
      const std::vector<double>* step =
          plane == place.plane ? nullptr : steps_.Over(cells_.HeightOf(above) - z);
      if (step) Offer(above, at.time + step->front());
    } else if (world_.ground->IsNear(cells_.planes()[plane], centre, cells_.reach())) {
      VisitPlane(place, at.time, plane);
    }
  }
}

double FootholdField::TimeOf(const Place& place, const CancellationToken& cancellation) {
  const std::size_t index = cells_.IndexOf(place);
  while (!queue_.empty() && queue_.top().time < times_[index]) {
    const Entry at = queue_.top();
    queue_.pop();
    if (at.time > times_[at.index]) continue;
    if (++visited_ % kCellsPerQuestion == 0) cancellation.ThrowIfCancelled();
    Visit(at);
  }
  return times_[index];
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
  const Place centre = cells_.PlaceAt(layer, p);
  double nearest = most;
  double least = std::numeric_limits<double>::infinity();
  for (const Offset& offset : disc_) {
    if (offset.distance > nearest) break;
    const Place at{layer, centre.column + offset.column, centre.row + offset.row};
    if (!cells_.IsInGrid(at.column, at.row) || !cells_.IsGround(at)) continue;
    nearest = offset.distance;
    least = std::min(least, TimeOf(at, cancellation));
  }
  return least;
}

double FootholdField::At(int limb, const PlanarPose& stance, int layer,
                         const CancellationToken& cancellation) {
  return Nearest(layer, stance * Vector2d(stance_.patch_centres[limb].head<2>()),
                 FootholdGround::kMostShift + cells_.cell(), cancellation);
}

double FootholdField::Near(int layer, const Vector2d& p, const CancellationToken& cancellation) {
  if (!world_.ground->IsNear(cells_.planes()[layer], p, cells_.reach() / 2 + cells_.cell())) {
    return std::numeric_limits<double>::infinity();
  }
  return Nearest(layer, p, cells_.reach() / 2 + cells_.cell(), cancellation);
}

}  // namespace possibility::actions
