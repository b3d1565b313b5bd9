#include "actions/flood/passage_gauge.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include "actions/conditions/blockers.h"
#include "actions/flood/flood_volumes.h"
#include "models/world/ground_map.h"

namespace possibility::actions {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kSpacing = 0.1;      // m, between places on the way
constexpr double kFarthest = 1.5;     // m: obstacles farther to a side do not matter
constexpr double kThin = 0.02;        // m, width of a feeler
constexpr double kPrecision = 1e-3;   // m
constexpr double kGroundStep = 0.01;  // m
constexpr int kDirections = 36;       // in half a circle
constexpr double kGroundGap = 0.01;   // m, above the ground

Vector2d Direction(int i) {
  const double angle = std::numbers::pi * i / kDirections;
  return {std::cos(angle), std::sin(angle)};
}

/// The largest `x` in [0, most] for which `holds`, to kPrecision, if it holds up to some x.
template <typename Holds>
double Largest(double most, const Holds& holds) {
  if (holds(most)) return most;
  double low = 0, high = most;
  while (high - low > kPrecision) {
    const double middle = (low + high) / 2;
    (holds(middle) ? low : high) = middle;
  }
  return low;
}

/// An upright box that begins at p, is `length` long towards `direction` and kThin wide.
models::PosedShape Feeler(const Vector2d& p, const Vector2d& direction, double length, double low,
                          double high) {
  Isometry3d X = Isometry3d::Identity();
  X.linear().col(0) << direction.x(), direction.y(), 0;
  X.linear().col(1) << -direction.y(), direction.x(), 0;
  X.translation() << p + direction * length / 2, (low + high) / 2;
  return {models::Shape::Box({std::max(length, kThin), kThin, high - low}), X};
}

/// Extent of a box along `across`, to both sides, in a stance with heading `yaw`.
double Extent(const AlignedBox3d& box, const Vector2d& across, double yaw) {
  const Vector2d local = Eigen::Rotation2Dd(-yaw) * across;
  const Vector2d size = box.sizes().head<2>();
  return std::abs(local.x()) * size.x() + std::abs(local.y()) * size.y();
}

}  // namespace

PassageGauge::PassageGauge(const LocomotionModel& model, const World& world,
                           const std::vector<FloodManoeuvre>& manoeuvres)
    : model_(model), world_(world), manoeuvres_(manoeuvres), checker_(*world.environment) {}

std::vector<PassageGauge::Place> PassageGauge::Along(const std::vector<GroundedStance>& way) const {
  std::vector<Place> places;
  for (size_t i = 0; i + 1 < way.size(); ++i) {
    const Vector2d from = way[i].pose.position(), to = way[i + 1].pose.position();
    const int parts = 1 + static_cast<int>((to - from).norm() / kSpacing);
    for (int part = 0; part < parts; ++part) {
      places.push_back({from + (to - from) * part / parts, std::max(way[i].z, way[i + 1].z)});
    }
  }
  return places;
}

std::optional<NarrowPassage> PassageGauge::Narrowest(const std::vector<GroundedStance>& way,
                                                     const CancellationToken& cancellation) const {
  std::optional<NarrowPassage> narrowest;
  for (const Place& place : Along(way)) {
    if (!cancellation.Proceed()) break;
    std::optional<NarrowPassage> passage;
    if (!HasGround(place.p, place.z)) {
      passage = GapAt(place);
    } else if (!IsWide(place)) {
      passage = PassageAt(place);
    }
    if (passage && (!narrowest || passage->missing > narrowest->missing)) narrowest = passage;
  }
  return narrowest;
}

bool PassageGauge::HasGround(const Vector2d& p, double z) const {
  return world_.ground->LevelAt(p, z, 1e-3).has_value();
}

/// Whether nothing is near enough to matter to any gait.
bool PassageGauge::IsWide(const Place& place) const {
  double top = 0;
  for (const auto& gait : model_.gaits) {
    for (const AlignedBox3d& box : gait->volumes.sweep(StrideClass::kStraight))
      top = std::max(top, box.max().z());
  }
  Isometry3d X = Isometry3d::Identity();
  X.translation() << place.p, place.z + (top + kGroundGap) / 2;
  return checker_.IsFree(models::Shape::Box({2 * kFarthest, 2 * kFarthest, top - kGroundGap}), X,
                         0);
}

/// The gap at a place: from one edge of the ground to the other, in the shortest direction.
std::optional<NarrowPassage> PassageGauge::GapAt(const Place& place) const {
  double shortest = kInfinity;
  for (int i = 0; i < kDirections; ++i) {
    double length = 0;
    for (const double side : {-1.0, 1.0}) {
      double distance = 0;
      while (distance < kFarthest && length < shortest &&
             !HasGround(place.p + side * distance * Direction(i), place.z)) {
        distance += kGroundStep;
      }
      length += distance < kFarthest ? distance : kInfinity;
    }
    shortest = std::min(shortest, length);
  }
  if (!std::isfinite(shortest)) return std::nullopt;
  NarrowPassage passage{.place = place.p, .missing = shortest};
  for (const FloodManoeuvre& manoeuvre : manoeuvres_) {
    const double reach = Reach(manoeuvre);
    passage.missing = std::min(passage.missing, shortest - reach);
    passage.needs.push_back({manoeuvre.name, PassageDimension::kGap, shortest, reach});
  }
  if (passage.needs.empty()) {
    passage.needs.push_back({"", PassageDimension::kGap, shortest, 0});
  }
  passage.between = {"no ground"};
  return passage;
}

/// The widest gap in level ground that a manoeuvre's farthest landing leaves behind.
double PassageGauge::Reach(const FloodManoeuvre& manoeuvre) const {
  const std::optional<LandingRange> range = manoeuvre.landings(0);
  if (!range) return 0;
  double toes = -kInfinity, heels = kInfinity;
  for (const auto& points : model_.gaits[manoeuvre.from]->stance.bearing_points) {
    for (const Vector2d& p : points) toes = std::max(toes, p.x());
  }
  for (const auto& points : model_.gaits[manoeuvre.to]->stance.bearing_points) {
    for (const Vector2d& p : points) heels = std::min(heels, p.x());
  }
  return std::max(0.0, range->offset.max().x() - toes + heels);
}

std::optional<NarrowPassage> PassageGauge::PassageAt(const Place& place) const {
  NarrowPassage passage{.place = place.p, .missing = kInfinity};
  std::optional<Fit> best;
  for (int gait = 0; gait < static_cast<int>(model_.gaits.size()); ++gait) {
    const std::optional<Fit> fit = FitOf(gait, place);
    if (!fit) continue;
    passage.needs.push_back(fit->need);
    if (!best || fit->missing < best->missing) best = fit;
  }
  if (!best) return std::nullopt;
  passage.missing = best->missing;
  NameSides(*best, place, &passage);
  return passage;
}

/// None if the gait has room, or stands in an obstacle.
std::optional<PassageGauge::Fit> PassageGauge::FitOf(int gait, const Place& place) const {
  double top = 0;
  for (const AlignedBox3d& box : model_.gaits[gait]->volumes.sweep(StrideClass::kStraight)) {
    top = std::max(top, box.max().z());
  }
  const double clear = ClearHeight(place, top);
  if (clear <= kThin) return std::nullopt;
  const std::string& name = model_.gaits[gait]->stance.gait->name;
  std::optional<Fit> fit = WidthFor(gait, place, clear);
  if (clear < top && (!fit || top - clear > fit->missing)) {
    fit.emplace();
    fit->need = {name, PassageDimension::kHeight, clear, top};
    fit->missing = top - clear;
  }
  return fit;
}

/// Clear height above the ground, at most `at_most`, m.
double PassageGauge::ClearHeight(const Place& place, double at_most) const {
  return Largest(at_most, [&](double height) {
    const models::PosedShape column = Feeler(place.p, Vector2d::UnitX(), 0, place.z + kGroundGap,
                                             place.z + std::max(height, 2 * kGroundGap));
    return checker_.IsFree(column.shape, column.X_PS, 0);
  });
}

/// Fit across the direction with the least remaining width, with the best heading for it.
std::optional<PassageGauge::Fit> PassageGauge::WidthFor(int gait, const Place& place,
                                                        double clear_height) const {
  std::optional<Fit> worst;
  for (const std::vector<AlignedBox3d>& boxes : PassageVolumes(model_, gait)) {
    std::optional<Fit> worst_here;
    for (int i = 0; i < kDirections; ++i) {
      const Vector2d across = Direction(i);
      std::vector<Slab> slabs;
      for (const AlignedBox3d& box : boxes) {
        const double low = std::max(box.min().z(), kGroundGap);
        const double high = std::min(box.max().z(), clear_height);
        if (high - low < kThin) continue;
        const double left = RoomTowards(place, across, low, high);
        const double right = RoomTowards(place, -across, low, high);
        if (left < kFarthest && right < kFarthest) slabs.push_back({box, left + right});
      }
      if (slabs.empty()) continue;
      Fit best{.missing = kInfinity};
      for (int k = 0; k < kDirections; ++k) {
        const double yaw = std::numbers::pi * k / kDirections;
        const auto missing = [&](const Slab& slab) {
          return Extent(slab.box, across, yaw) - slab.room;
        };
        const Slab& tightest = *std::max_element(
            slabs.begin(), slabs.end(),
            [&](const Slab& a, const Slab& b) { return missing(a) < missing(b); });
        if (missing(tightest) >= best.missing) continue;
        best.missing = missing(tightest);
        best.need = {model_.gaits[gait]->stance.gait->name, PassageDimension::kWidth, tightest.room,
                     tightest.room + best.missing};
        best.across = across;
        best.gauged = tightest.box;
      }
      if (!worst_here || best.missing > worst_here->missing) worst_here = best;
    }
    if (!worst_here) return std::nullopt;  // one alternative has room on all sides
    if (!worst || worst_here->missing < worst->missing) worst = worst_here;
  }
  return worst;
}

/// Free length towards `direction`, up to kFarthest, for a slab between two heights above the
/// ground, m.
double PassageGauge::RoomTowards(const Place& place, const Vector2d& direction, double low,
                                 double high) const {
  return Largest(kFarthest, [&](double length) {
    const models::PosedShape feeler =
        Feeler(place.p, direction, length, place.z + low, place.z + high);
    return checker_.IsFree(feeler.shape, feeler.X_PS, 0);
  });
}

/// Names what a feeler slightly longer than the room touches.
void PassageGauge::NameSides(const Fit& fit, const Place& place, NarrowPassage* passage) const {
  constexpr double kLonger = 0.02;  // m
  std::vector<models::PosedShape> feelers;
  if (fit.need.dimension == PassageDimension::kHeight) {
    feelers.push_back(Feeler(place.p, Vector2d::UnitX(), 0, place.z + kGroundGap,
                             place.z + fit.need.available + kLonger));
  } else {
    const double low = std::max(fit.gauged.min().z(), kGroundGap);
    const double high = fit.gauged.max().z();
    for (const double side : {-1.0, 1.0}) {
      const double room = RoomTowards(place, side * fit.across, low, high);
      feelers.push_back(
          Feeler(place.p, side * fit.across, room + kLonger, place.z + low, place.z + high));
    }
  }
  std::set<std::string> names;
  for (std::string& name : Blockers(*world_.environment, feelers)) names.insert(std::move(name));
  passage->between.assign(names.begin(), names.end());
}

}  // namespace possibility::actions
