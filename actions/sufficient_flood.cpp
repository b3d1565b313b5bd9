#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <set>
#include <utility>

#include "actions/blockers.h"
#include "actions/cell_grid.h"
#include "actions/flood_grid.h"
#include "actions/launch_box.h"
#include "actions/route_flood.h"
#include "models/collision.h"
#include "models/ground_map.h"
#include "models/upright_boxes.h"

namespace possibility::actions {
namespace {

using Cell = CellGrid::Cell;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// The collision checker may err by 0.1 mm towards "not free"; cells must not, m.
constexpr double kCheckerError = 0.0002;
constexpr int kHeadings = 24;
/// How often the launches of a cell are halved, along one dimension each time, before a landing
/// counts as possible: more did not narrow down the gaps that stay in doubt.
constexpr int kLaunchHalvings = 16;

/// The flood over C_S. Cells: layer (a gait at a height), x, y, heading.
class SufficientFlood {
 public:
  SufficientFlood(const LocomotionModel& model, const World& world, double z, double resolution,
                  const std::vector<FloodManoeuvre>& manoeuvres, int halvings)
      : model_(model),
        world_(world),
        heights_(manoeuvres.empty() ? std::vector<double>{z} : world.ground->levels()),
        manoeuvres_(manoeuvres),
        resolution_(resolution),
        origin_(world.environment->bounds.min() - Vector2d::Constant(Margin(model))),
        checker_(*world.environment),
        grid_(GridSize()) {
    for (const auto& gait : model.gaits) {
      // Wherever a way leads, there is room to stand: every swept volume holds that (GaitVolumes).
      const std::vector<Eigen::AlignedBox3d>& standing = gait->volumes.standing;
      whole_.emplace_back(standing);
      shrunk_.emplace_back();
      for (int i = 0; i <= halvings; ++i) shrunk_.back().push_back(Shrink(standing, 1 << i));
    }
  }

  FloodResult Run(const GroundedStance& start, const std::vector<GroundedStance>& goals,
                  const std::function<bool()>& keep_going) {
    std::set<Cell> goal_cells;
    for (const GroundedStance& goal : goals) {
      if (const auto layer = LayerOf(goal)) goal_cells.insert(CellOf(*layer, goal.pose));
    }
    const std::optional<int> first = LayerOf(start);
    if (!first) return {};
    return FloodGrid(
        &grid_, CellOf(*first, start.pose), goal_cells, goals, keep_going,
        [this](const Cell& cell) { return Centre(cell).position(); },
        [this](const Cell& cell) { OfferNeighbours(cell); },
        [&](const Cell& cell) { return ClosedBy(cell, goals); }, [this] { return Reached(); });
  }

 private:
  static double Margin(const LocomotionModel& model) {
    double margin = 0;
    for (const auto& transition : model.transitions) {
      margin = std::max(margin, transition.motion->displacement().position().norm());
    }
    return margin;
  }

  Cell GridSize() const {
    const Vector2d size =
        world_.environment->bounds.max() - origin_ + Vector2d::Constant(Margin(model_));
    return {static_cast<int>(model_.gaits.size() * heights_.size()),
            static_cast<int>(std::ceil(size.x() / resolution_)) + 1,
            static_cast<int>(std::ceil(size.y() / resolution_)) + 1, kHeadings};
  }

  double HalfDiagonal() const { return resolution_ * std::numbers::sqrt2 / 2; }
  static double HalfHeading() { return std::numbers::pi / kHeadings; }

  /// What a box covers wherever in a part of a cell, of so many to an axis, the stance is: every
  /// vertical side moved inward.
  models::UprightBoxes Shrink(const std::vector<Eigen::AlignedBox3d>& boxes, int parts) const {
    std::vector<Eigen::AlignedBox3d> shrunk;
    for (const Eigen::AlignedBox3d& box : boxes) {
      const Vector2d far = box.min().head<2>().cwiseAbs().cwiseMax(box.max().head<2>().cwiseAbs());
      const double inward = (HalfDiagonal() + far.norm() * HalfHeading()) / parts + kCheckerError;
      const Vector3d margin(inward, inward, kCheckerError);
      if ((box.sizes() - 2 * margin).minCoeff() <= 0) continue;
      shrunk.emplace_back(box.min() + margin, box.max() - margin);
    }
    return models::UprightBoxes(std::move(shrunk));
  }

  int GaitOf(const Cell& cell) const { return cell[0] % static_cast<int>(model_.gaits.size()); }
  double HeightOf(const Cell& cell) const { return heights_[cell[0] / model_.gaits.size()]; }
  int Layer(int gait, size_t height) const {
    return static_cast<int>(height * model_.gaits.size()) + gait;
  }
  std::optional<int> LayerOf(const GroundedStance& stance) const {
    for (size_t i = 0; i < heights_.size(); ++i) {
      if (std::abs(heights_[i] - stance.z) < 1e-6) return Layer(stance.gait, i);
    }
    return std::nullopt;
  }
  /// The layer of another gait at the cell's height.
  int SameHeight(const Cell& cell, int gait) const { return cell[0] - GaitOf(cell) + gait; }

  Cell CellOf(int layer, const PlanarPose& pose) const {
    const Vector2d p = (pose.position() - origin_) / resolution_;
    const double turn = std::floor((pose.yaw + HalfHeading()) / (2 * HalfHeading()));
    const int heading = static_cast<int>(turn - kHeadings * std::floor(turn / kHeadings));
    return {layer, static_cast<int>(std::floor(p.x())), static_cast<int>(std::floor(p.y())),
            heading % kHeadings};
  }

  PlanarPose Centre(const Cell& cell) const {
    return {origin_.x() + (cell[1] + 0.5) * resolution_,
            origin_.y() + (cell[2] + 0.5) * resolution_, cell[3] * 2 * HalfHeading()};
  }

  bool GroundMayHold(const Cell& cell) const {
    return actions::GroundMayHold(model_, *world_.ground, GaitOf(cell), Centre(cell),
                                  HeightOf(cell), HalfDiagonal(), HalfHeading());
  }

  bool CentreStands(int gait, const PlanarPose& centre, double z) const {
    return actions::GroundMayHold(model_, *world_.ground, gait, centre, z, 0, 0) &&
           checker_.AreFree(whole_[gait], centre.At(z));
  }

  /// Whether some stance may be possible in the part of a cell about `centre`, halved so often
  /// along every axis already.
  bool MayStand(int gait, const PlanarPose& centre, double z, int halvings) const {
    const int parts = 1 << halvings;
    if (!actions::GroundMayHold(model_, *world_.ground, gait, centre, z, HalfDiagonal() / parts,
                                HalfHeading() / parts) ||
        !checker_.AreFree(shrunk_[gait][halvings], centre.At(z))) {
      return false;
    }
    if (halvings + 1 == static_cast<int>(shrunk_[gait].size())) return true;
    if (CentreStands(gait, centre, z)) return true;
    const double shift = resolution_ / 4 / parts, turn = HalfHeading() / 2 / parts;
    for (int part = 0; part < 8; ++part) {
      const PlanarPose middle{centre.x + (part & 1 ? shift : -shift),
                              centre.y + (part & 2 ? shift : -shift),
                              centre.yaw + (part & 4 ? turn : -turn)};
      if (MayStand(gait, middle, z, halvings + 1)) return true;
    }
    return false;
  }

  void OfferNeighbours(const Cell& cell) {
    const auto is_open = [this](const Cell& c) {
      return MayStand(GaitOf(c), Centre(c), HeightOf(c), 0);
    };
    const auto offer = [&](Cell c) {
      c[3] = (c[3] + kHeadings) % kHeadings;
      grid_.Offer(c, is_open);
    };
    for (int axis = 1; axis < 4; ++axis) {
      for (int step : {-1, 1}) {
        Cell next = cell;
        next[axis] += step;
        offer(next);
      }
    }
    for (const LocomotionModel::TransitionEntry& transition : model_.transitions) {
      const PlanarPose& d = transition.motion->displacement();
      const int gait = GaitOf(cell);
      if (transition.from == gait) OfferImage(cell, SameHeight(cell, transition.to), d, offer);
      if (transition.to == gait) {
        OfferImage(cell, SameHeight(cell, transition.from), d.Inverse(), offer);
      }
    }
    for (const FloodManoeuvre& manoeuvre : manoeuvres_) {
      if (manoeuvre.from == GaitOf(cell)) OfferLandings(cell, manoeuvre, is_open);
    }
  }

  template <typename Test>
  void OfferLandings(const Cell& cell, const FloodManoeuvre& manoeuvre, const Test& is_open) {
    for (size_t i = 0; i < heights_.size(); ++i) {
      const std::optional<LandingRange> range = manoeuvre.landings(heights_[i] - HeightOf(cell));
      if (!range) continue;
      const Vector2d low = range->offset.min();
      const Vector2d high = range->offset.max();
      const int turns = static_cast<int>(std::ceil(range->turn / (2 * HalfHeading()) - 1e-9));
      LaunchBox launches{.launch = {GaitOf(cell), HeightOf(cell)},
                         .landing = {manoeuvre.to, heights_[i]},
                         .middle = Centre(cell),
                         .half_place = Vector2d::Constant(resolution_ / 2),
                         .half_heading = HalfHeading(),
                         .half_turn = turns > 0 ? HalfHeading() : 0};
      // A landing lies at most half a sample beside one of the samples.
      launches.half_displacement = ((high - low).array() > 0).cast<double>() * resolution_ / 4;
      for (const double x : Samples(low.x(), high.x())) {
        for (const double y : Samples(low.y(), high.y())) {
          for (int turn = -turns; turn <= turns; ++turn) {
            launches.displacement = {x, y, turn * 2 * HalfHeading()};
            OfferLandings(cell, Layer(manoeuvre.to, i), launches, is_open);
          }
        }
      }
    }
  }

  template <typename Test>
  void OfferLandings(const Cell& cell, int layer, const LaunchBox& launches, const Test& is_open) {
    std::optional<bool> may_land;  // once, and only where it matters
    const auto leads_there = [&] {
      if (!may_land) may_land = MayLand(model_, *world_.ground, launches, kLaunchHalvings);
      return *may_land;
    };
    OfferImage(
        cell, layer, launches.displacement,
        [&](const Cell& c) { grid_.Offer(c, is_open, leads_there); },
        launches.half_displacement.norm());
  }

  /// `low`, `high` and what lies between, at half the size of cells.
  std::vector<double> Samples(double low, double high) const {
    std::vector<double> samples = {low};
    for (double s = low + resolution_ / 2; s < high; s += resolution_ / 2) samples.push_back(s);
    if (high > low) samples.push_back(high);
    return samples;
  }

  /// All cells that a stance in `cell` can be displaced into, or so far (m) beside them.
  template <typename Offer>
  void OfferImage(const Cell& cell, int layer, const PlanarPose& displacement, const Offer& offer,
                  double beside = 0) {
    const PlanarPose image = Centre(cell) * displacement;
    const double spread = resolution_ / 2 + displacement.position().norm() * HalfHeading() + beside;
    const Cell low = CellOf(layer, {image.x - spread, image.y - spread, image.yaw});
    const Cell high = CellOf(layer, {image.x + spread, image.y + spread, image.yaw});
    for (int x = low[1]; x <= high[1]; ++x) {
      for (int y = low[2]; y <= high[2]; ++y) offer({layer, x, y, low[3]});
    }
  }

  /// What closes the cells next to `cell` in the direction of the goals.
  std::vector<std::string> ClosedBy(const Cell& cell, const std::vector<GroundedStance>& goals) {
    std::set<std::string> names;
    const PlanarPose centre = Centre(cell);
    for (const GroundedStance& goal : goals) {
      const Vector2d towards = goal.pose.position() - centre.position();
      if (towards.norm() < 1e-9) continue;
      Cell beyond = CellOf(
          cell[0], {centre.x + 1.5 * resolution_ * towards.x() / towards.norm(),
                    centre.y + 1.5 * resolution_ * towards.y() / towards.norm(), centre.yaw});
      if (!grid_.Contains(beyond)) continue;
      if (!GroundMayHold(beyond)) names.insert("no ground");
      std::vector<models::PosedShape> posed;
      const models::UprightBoxes& boxes = shrunk_[GaitOf(cell)].back();
      for (size_t i = 0; i < boxes.boxes().size(); ++i) {
        posed.push_back({models::Shape::Box(boxes.boxes()[i].sizes()),
                         Centre(beyond).At(HeightOf(beyond)) * boxes.X_SB()[i]});
      }
      for (std::string& name : Blockers(*world_.environment, posed)) names.insert(std::move(name));
    }
    return {names.begin(), names.end()};
  }

  std::vector<ReachedRegion> Reached() const {
    std::vector<ReachedRegion> regions;
    for (int layer = 0; layer < grid_.size()[0]; ++layer) {
      CellMask mask(grid_.size()[1], grid_.size()[2]);
      for (int x = 0; x < grid_.size()[1]; ++x) {
        for (int y = 0; y < grid_.size()[2]; ++y) {
          for (int heading = 0; heading < kHeadings; ++heading) {
            if (grid_.IsReached({layer, x, y, heading})) mask.Add(x, y);
          }
        }
      }
      ReachedRegion region;
      region.action = model_.gaits[GaitOf({layer})]->stance.gait->name;
      region.z = HeightOf({layer});
      region.outlines = OutlinesOf(mask, origin_, Vector2d::Constant(resolution_));
      if (!region.outlines.empty()) regions.push_back(std::move(region));
    }
    return regions;
  }

  const LocomotionModel& model_;
  const World& world_;
  std::vector<double> heights_;  ///< of the ground, that the flood may reach
  const std::vector<FloodManoeuvre>& manoeuvres_;
  double resolution_;
  Vector2d origin_;
  models::CollisionChecker checker_;
  CellGrid grid_;
  std::vector<models::UprightBoxes> whole_;                ///< by gait
  std::vector<std::vector<models::UprightBoxes>> shrunk_;  ///< by gait and halvings
};

}  // namespace

FloodResult FloodSufficient(const LocomotionModel& model, const World& world,
                            const GroundedStance& start, const std::vector<GroundedStance>& goals,
                            double resolution, const std::function<bool()>& keep_going,
                            const std::vector<FloodManoeuvre>& manoeuvres, int halvings) {
  return SufficientFlood(model, world, start.z, resolution, manoeuvres, halvings)
      .Run(start, goals, keep_going);
}

}  // namespace possibility::actions
