#include "actions/footholds/standing_room.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace possibility::actions {
namespace {

using Eigen::Vector2d;

constexpr double kHeading = std::numbers::pi / StandingRoom::kHeadings;
constexpr double kLeastRoomCell = 0.06;   // m
constexpr double kMostRoomCells = 100e3;  // seen from above; in larger places cells are larger

}  // namespace

StandingRoom::StandingRoom(const FootholdCells& cells, const NominalStance& stance,
                           const World& world, const FootstepLimits& limits, double first_heading,
                           double gap)
    : cells_(cells),
      world_(world),
      margin_(limits.margin),
      rise_(limits.rise),
      first_heading_(first_heading),
      around_(cells.reach() / 2 + cells.cell()),
      layer_of_plane_(world.ground->planes().size(), -1),
      cell_(kLeastRoomCell),
      fits_(cells.size()) {
  // Both limbs' soles are alike but for their side.
  const Vector2d centre = stance.patch_centres[0].head<2>();
  for (const Vector2d& p : stance.bearing_points[0]) {
    needed_ = std::max(needed_, 2 * std::abs((p - centre).y()) + gap);
    for (int i = 0; i < kHeadings; ++i) {
      soles_[i].push_back(Eigen::Rotation2Dd(first_heading + i * kHeading) * (p - centre));
    }
  }
  for (const FootholdCells::Offset& offset : cells.Disc(around_)) {
    Sides beside;
    for (int i = 0; i < kHeadings; ++i) {
      const double yaw = first_heading + i * kHeading;
      beside[i] = static_cast<float>(cells.cell() *
                                     (std::cos(yaw) * offset.row - std::sin(yaw) * offset.column));
    }
    disc_.push_back({offset.column, offset.row, beside});
  }
  for (unsigned headings = 0; headings <= kAll; ++headings) {
    Sides refused;
    for (int i = 0; i < kHeadings; ++i) refused[i] = headings >> i & 1 ? 0.0F : 1e3F;
    refused_.push_back(refused);
  }
  for (int layer = 0; layer < cells.NumPlanes(); ++layer) {
    layer_of_plane_[cells.planes()[layer]] = layer;
  }
  const Eigen::AlignedBox2d& bounds = world.environment->bounds;
  if (!bounds.isEmpty()) {
    cell_ = std::max(kLeastRoomCell, std::sqrt(bounds.sizes().prod() / kMostRoomCells));
    columns_ = std::max(1, static_cast<int>(std::ceil(bounds.sizes().x() / cell_)));
    rows_ = std::max(1, static_cast<int>(std::ceil(bounds.sizes().y() / cell_)));
  }
  known_ = std::vector<std::atomic<Headings>>(static_cast<std::size_t>(columns_) * rows_ *
                                              cells.NumPlanes());
}

bool StandingRoom::IsAt(int layer, const PlanarPose& middle) const {
  Vector2d at = Vector2d::Zero();
  const Eigen::AlignedBox2d& bounds = world_.environment->bounds;
  if (!bounds.isEmpty()) at = (middle.position() - bounds.min()) / cell_;
  const int column = static_cast<int>(std::clamp(std::floor(at.x()), 0.0, columns_ - 1.0));
  const int row = static_cast<int>(std::clamp(std::floor(at.y()), 0.0, rows_ - 1.0));
  const auto turns = std::lround((middle.yaw - first_heading_) / kHeading);
  return At(layer, column, row) >> (turns & (kHeadings - 1)) & 1;
}

StandingRoom::Headings StandingRoom::At(int layer, int column, int row) const {
  std::atomic<Headings>& known =
      known_[(static_cast<std::size_t>(layer) * rows_ + row) * columns_ + column];
  Headings headings = known.load(std::memory_order_relaxed);
  if (!(headings & kKnown)) {
    const Eigen::AlignedBox2d& bounds = world_.environment->bounds;
    Vector2d middle = Vector2d::Zero();
    if (!bounds.isEmpty()) middle = bounds.min() + cell_ * Vector2d(column + 0.5, row + 0.5);
    headings = Find(layer, middle) | kKnown;
    known.store(headings, std::memory_order_relaxed);
  }
  return headings;
}

/// All headings at once: the soles farthest to the left and to the right.
StandingRoom::Headings StandingRoom::Find(int layer, const Vector2d& middle) const {
  const int plane = cells_.planes()[layer];
  const double z = world_.ground->planes()[plane].HeightAt(middle);
  const bool is_bare = !cells_.IsHorizontal(layer) || cells_.cover().IsBare(middle, needed_ / 2, z);
  if (is_bare && world_.ground->OneFaceHolds(plane, middle, middle, needed_)) return kAll;
  Sides left = Sides::Constant(-1e3F), right = Sides::Constant(1e3F);
  for (const int other : LayersNear(middle, z)) {
    const FootholdCells::Place centre = cells_.PlaceAt(other, middle);
    const bool is_horizontal = cells_.IsHorizontal(other);
    if (is_horizontal && std::abs(cells_.HeightOf(centre) - z) > rise_) continue;
    for (const Offset& offset : disc_) {
      const FootholdCells::Place at{other, centre.column + offset.column, centre.row + offset.row};
      if (!cells_.IsInGrid(at.column, at.row)) continue;
      const Headings fits = Fits(at) & kAll;
      if (fits == 0) continue;
      if (!is_horizontal && std::abs(cells_.HeightOf(at) - z) > rise_) continue;
      left = left.max(offset.beside - refused_[fits]);
      right = right.min(offset.beside + refused_[fits]);
    }
  }
  Headings headings = 0;
  for (int i = 0; i < kHeadings; ++i) {
    if (left[i] - right[i] >= static_cast<float>(needed_)) headings |= 1U << i;
  }
  return headings;
}

std::vector<int> StandingRoom::LayersNear(const Vector2d& middle, double z) const {
  std::vector<int> near;
  const double away = std::hypot(around_, rise_);
  for (const int plane : world_.ground->PlanesNear({middle.x(), middle.y(), z}, away)) {
    const int layer = layer_of_plane_[plane];
    if (layer >= 0 && world_.ground->IsNear(plane, middle, around_)) near.push_back(layer);
  }
  return near;
}

StandingRoom::Headings StandingRoom::Fits(const FootholdCells::Place& place) const {
  std::atomic<Headings>& known = fits_[cells_.IndexOf(place)];
  Headings headings = known.load(std::memory_order_relaxed);
  if (!(headings & kKnown)) {
    headings = FindFits(place) | kKnown;
    known.store(headings, std::memory_order_relaxed);
  }
  return headings;
}

StandingRoom::Headings StandingRoom::FindFits(const FootholdCells::Place& place) const {
  if (!cells_.IsGround(place)) return 0;
  const Vector2d centre = cells_.CentreOf(place);
  const int plane = cells_.planes()[place.plane];
  Headings headings = 0;
  for (int i = 0; i < kHeadings; ++i) {
    const bool holds = std::all_of(soles_[i].begin(), soles_[i].end(), [&](const Vector2d& p) {
      return world_.ground->Clearance(plane, centre + p) >= margin_;
    });
    if (holds) headings |= 1U << i;
  }
  return headings;
}

}  // namespace possibility::actions
