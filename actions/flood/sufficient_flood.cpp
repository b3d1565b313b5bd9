#include "actions/flood/sufficient_flood.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>

#include "actions/flood/block_flood.h"
#include "actions/flood/blocks_from_above.h"
#include "actions/flood/launch_box.h"
#include "actions/flood/stance_cells.h"

namespace possibility::actions {
namespace {

using Eigen::Vector2d;

/// Halvings of a cell's launches, along one dimension each, before a landing counts as possible.
/// More did not narrow the undecided gaps.
constexpr int kLaunchHalvings = 16;

double FarthestTransition(const LocomotionModel& model) {
  double farthest = 0;
  for (const auto& transition : model.transitions) {
    farthest = std::max(farthest, transition.displacement.position().norm());
  }
  return farthest;
}

/// The flood over C_S: cells of stances, joined by strides, transitions and manoeuvres.
class SufficientFlood {
 public:
  SufficientFlood(const LocomotionModel& model, const World& world, const GroundedStance& start,
                  const std::vector<GroundedStance>& goals, const StanceCellSettings& settings,
                  FloodLimits limits, const std::vector<FloodManoeuvre>& manoeuvres)
      : model_(model),
        world_(world),
        start_(start),
        goals_(goals),
        manoeuvres_(manoeuvres),
        cancellation_(limits.cancellation),
        cells_(model, world,
               manoeuvres.empty() ? std::vector<double>{start.z} : world.ground->levels(),
               FarthestTransition(model), settings),
        flood_(
            cells_.num_planes(), cells_.NumCells().x(), cells_.NumCells().y(),
            [this](const CellBlock& block) { return cells_.Judge(block); }, std::move(limits)) {}

  FloodResult Run() {
    FloodResult result;
    const std::optional<CellBlock> first = cells_.CellOf(start_);
    if (!first) return result;
    std::vector<CellBlock> goal_cells;
    for (const GroundedStance& goal : goals_) {
      if (const auto cell = cells_.CellOf(goal)) goal_cells.push_back(*cell);
    }
    const BlocksFromAbove view(cells_.origin(), Vector2d::Constant(cells_.settings().resolution),
                               goals_);
    const FloodEnd end = flood_.Run(
        *first,
        [&](const CellBlock& block) {
          return std::any_of(goal_cells.begin(), goal_cells.end(),
                             [&](const CellBlock& cell) { return block.Contains(cell); });
        },
        [&](const CellBlock& block) { return view.Distance(block); },
        [this](const CellBlock& block) { OfferNeighbours(block); },
        [this](const CellBlock& block) { OfferLandings(block); });
    result.cells = flood_.judged();
    result.is_cut_short = end == FloodEnd::kCutShort;
    result.route_may_exist = end != FloodEnd::kNothingLeft;
    if (end == FloodEnd::kGoal) result.way = Stances(flood_.WayToGoal());
    if (end == FloodEnd::kNothingLeft) result.barrier = BarrierOf(view);
    return result;
  }

 private:
  void OfferNeighbours(const CellBlock& block) {
    flood_.Offer({block.plane, block.x0 - 1, block.y0, block.x0, block.y1});
    flood_.Offer({block.plane, block.x1, block.y0, block.x1 + 1, block.y1});
    flood_.Offer({block.plane, block.x0, block.y0 - 1, block.x1, block.y0});
    flood_.Offer({block.plane, block.x0, block.y1, block.x1, block.y1 + 1});
    for (const int turn : {-1, 1}) {
      CellBlock turned = block;
      turned.plane = cells_.PlaneTurned(block, turn);
      flood_.Offer(turned);
    }
    const int gait = cells_.GaitOf(block);
    for (const LocomotionModel::TransitionEntry& transition : model_.transitions) {
      const PlanarPose& d = transition.displacement;
      if (transition.from == gait) OfferTransition(block, transition.to, d);
      if (transition.to == gait) OfferTransition(block, transition.from, d.Inverse());
    }
  }

  void OfferTransition(const CellBlock& block, int gait, const PlanarPose& displacement) {
    const int layer = cells_.LayerOf(block) - cells_.GaitOf(block) + gait;
    flood_.Offer(Image(block, layer, displacement, 0));
  }

  /// All cells that a stance in the block can be displaced into, extended by `beside` (m).
  CellBlock Image(const CellBlock& block, int layer, const PlanarPose& displacement,
                  double beside) const {
    const double spread = cells_.settings().resolution / 2 +
                          displacement.position().norm() * cells_.half_heading() + beside;
    const PlanarPose low =
        cells_.Centre(CellBlock::Of(block.plane, block.x0, block.y0)) * displacement;
    const PlanarPose high =
        cells_.Centre(CellBlock::Of(block.plane, block.x1 - 1, block.y1 - 1)) * displacement;
    CellBlock image = cells_.CellOf(layer, {low.x - spread, low.y - spread, low.yaw});
    const CellBlock last = cells_.CellOf(layer, {high.x + spread, high.y + spread, high.yaw});
    image.x1 = last.x1;
    image.y1 = last.y1;
    return image;
  }

  void OfferLandings(const CellBlock& block) {
    for (const FloodManoeuvre& manoeuvre : manoeuvres_) {
      if (manoeuvre.from != cells_.GaitOf(block)) continue;
      for (size_t i = 0; i < cells_.heights().size(); ++i) {
        const double rise = cells_.heights()[i] - cells_.HeightOf(block);
        const std::optional<LandingRange> range = manoeuvre.landings(rise);
        if (range) OfferLandings(block, cells_.Layer(manoeuvre.to, i), *range);
      }
    }
  }

  void OfferLandings(const CellBlock& block, int layer, const LandingRange& range) {
    const double lenient = 2 * cells_.settings().leniency;
    const Vector2d low = range.offset.min();
    const Vector2d high = range.offset.max() + Vector2d(lenient, 0);
    const double heading = 2 * cells_.half_heading();
    const int turns = static_cast<int>(std::ceil(range.turn / heading - 1e-9));
    const double resolution = cells_.settings().resolution;
    LaunchBox launches = LaunchesFrom(block, layer);
    launches.half_turn = turns > 0 ? cells_.half_heading() : 0;
    // A landing lies at most half a sample beside one of the samples.
    launches.half_displacement = ((high - low).array() > 0).cast<double>() * resolution / 4;
    const std::vector<double> ahead = Samples(low.x(), high.x());
    for (const double y : Samples(low.y(), high.y())) {
      for (int turn = -turns; turn <= turns; ++turn) {
        launches.displacement = {0, y, turn * heading};
        OfferLandings(block, layer, &launches, ahead);
      }
    }
  }

  /// Offers those of the displacements `ahead` that may lead to new cells.
  void OfferLandings(const CellBlock& block, int layer, LaunchBox* launches,
                     std::span<const double> ahead) {
    const double beside = launches->half_displacement.norm();
    const auto image = [&](double x) {
      launches->displacement.x = x;
      return Image(block, layer, launches->displacement, beside);
    };
    const CellBlock first = image(ahead.front()), last = image(ahead.back());
    if (!flood_.HasLeft({first.plane, std::min(first.x0, last.x0), std::min(first.y0, last.y0),
                         std::max(first.x1, last.x1), std::max(first.y1, last.y1)})) {
      return;
    }
    if (ahead.size() == 1) return OfferLandings(block, layer, *launches);
    OfferLandings(block, layer, launches, ahead.first(ahead.size() / 2));
    OfferLandings(block, layer, launches, ahead.subspan(ahead.size() / 2));
  }

  /// Launches from all cells of the block together, without displacements yet.
  LaunchBox LaunchesFrom(const CellBlock& block, int layer) const {
    const CellBlock landing = CellBlock::Of(cells_.Plane(layer, 0), 0, 0);
    LaunchBox launches{
        .launch = {cells_.GaitOf(block), cells_.HeightOf(block)},
        .landing = {cells_.GaitOf(landing), cells_.HeightOf(landing)},
        .middle = cells_.Centre(block),
        .half_place =
            Vector2d(block.x1 - block.x0, block.y1 - block.y0) * (cells_.settings().resolution / 2),
        .half_heading = cells_.half_heading(),
    };
    return launches;
  }

  void OfferLandings(const CellBlock& block, int layer, const LaunchBox& launches) {
    // If no launch of the block can land, no launch of its cells can.
    if (!block.IsCell() && !MayLand(model_, *world_.ground, launches, 0)) return;
    const double beside = launches.half_displacement.norm();
    std::map<std::pair<int, int>, bool>
        may_land;  // by launch cell, computed once and only if needed
    flood_.Offer(Image(block, layer, launches.displacement, beside), [&](const CellBlock&
                                                                             landings) {
      return SomeCellLeads(block, landings, launches, [&](const CellBlock& cell) {
        const auto known = may_land.find({cell.x0, cell.y0});
        if (known != may_land.end()) return known->second;
        LaunchBox own = launches;
        own.middle = cells_.Centre(cell);
        own.half_place = Vector2d::Constant(cells_.settings().resolution / 2);
        return may_land[{cell.x0, cell.y0}] = MayLand(model_, *world_.ground, own, kLaunchHalvings);
      });
    });
  }

  /// Whether some cell of `block` whose image overlaps `landings` leads there.
  template <typename Leads>
  bool SomeCellLeads(const CellBlock& block, const CellBlock& landings, const LaunchBox& launches,
                     const Leads& leads) const {
    const double beside = launches.half_displacement.norm();
    const auto image = [&](int x, int y) {
      return Image(CellBlock::Of(block.plane, x, y), cells_.LayerOf(landings),
                   launches.displacement, beside);
    };
    // Images move with their cells, up to rounding.
    const CellBlock first = image(block.x0, block.y0);
    const auto low = [](int begin, int landing, int image_end) {
      return std::max(begin, begin + landing - image_end);
    };
    const int x0 = low(block.x0, landings.x0, first.x1), y0 = low(block.y0, landings.y0, first.y1);
    const int x1 = std::min(block.x1, block.x0 + landings.x1 - first.x0 + 2);
    const int y1 = std::min(block.y1, block.y0 + landings.y1 - first.y0 + 2);
    for (int x = x0; x < x1; ++x) {
      for (int y = y0; y < y1; ++y) {
        const CellBlock own = image(x, y);
        if (own.plane != landings.plane || own.x0 >= landings.x1 || own.x1 <= landings.x0 ||
            own.y0 >= landings.y1 || own.y1 <= landings.y0) {
          continue;
        }
        if (leads(CellBlock::Of(block.plane, x, y))) return true;
      }
    }
    return false;
  }

  /// Samples from `low` to `high`, half a cell apart.
  std::vector<double> Samples(double low, double high) const {
    const double spacing = cells_.settings().resolution / 2;
    std::vector<double> samples = {low};
    for (double s = low + spacing; s < high; s += spacing) samples.push_back(s);
    if (high > low) samples.push_back(high);
    return samples;
  }

  std::vector<GroundedStance> Stances(const std::vector<CellBlock>& way) const {
    std::vector<GroundedStance> stances;
    for (const CellBlock& block : way) {
      stances.push_back({cells_.GaitOf(block), cells_.Centre(block), cells_.HeightOf(block)});
    }
    return stances;
  }

  Barrier BarrierOf(const BlocksFromAbove& view) const {
    Barrier barrier;
    const ClosestApproach closest = view.ClosestOf(flood_.reached());
    barrier.closest = closest.point;
    barrier.distance = closest.distance;
    barrier.closed_by = ClosedBy(closest.cell);
    std::map<int, std::vector<CellBlock>> by_layer;
    for (const BlockFlood::Reached& reached : flood_.reached()) {
      by_layer[cells_.LayerOf(reached.block)].push_back(reached.block);
    }
    for (const auto& [layer, blocks] : by_layer) {
      const CellBlock cell = CellBlock::Of(cells_.Plane(layer, 0), 0, 0);
      barrier.reached.push_back(
          {model_.gaits[cells_.GaitOf(cell)]->stance.gait->name, cells_.HeightOf(cell),
           view.OutlinesOf(blocks, cells_.NumCells().cast<int>(), cancellation_)});
    }
    return barrier;
  }

  /// Names what closes the cells next to `cell` towards the goals.
  std::vector<std::string> ClosedBy(const CellBlock& cell) const {
    std::set<std::string> names;
    const PlanarPose centre = cells_.Centre(cell);
    for (const GroundedStance& goal : goals_) {
      const Vector2d towards = goal.pose.position() - centre.position();
      if (towards.norm() < 1e-9) continue;
      const Vector2d beyond =
          centre.position() + 1.5 * cells_.settings().resolution * towards.normalized();
      const CellBlock next =
          cells_.CellOf(cells_.LayerOf(cell), {beyond.x(), beyond.y(), centre.yaw});
      if (!cells_.Contains(next)) continue;
      for (std::string& name : cells_.Blockers(next)) names.insert(std::move(name));
    }
    return {names.begin(), names.end()};
  }

  const LocomotionModel& model_;
  const World& world_;
  const GroundedStance& start_;
  const std::vector<GroundedStance>& goals_;
  const std::vector<FloodManoeuvre>& manoeuvres_;
  CancellationToken cancellation_;
  StanceCells cells_;
  BlockFlood flood_;
};

}  // namespace

FloodResult FloodSufficient(const LocomotionModel& model, const World& world,
                            const GroundedStance& start, const std::vector<GroundedStance>& goals,
                            const StanceCellSettings& settings, const FloodLimits& limits,
                            const std::vector<FloodManoeuvre>& manoeuvres) {
  return SufficientFlood(model, world, start, goals, settings, limits, manoeuvres).Run();
}

}  // namespace possibility::actions
