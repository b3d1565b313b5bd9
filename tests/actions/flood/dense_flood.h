#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <numbers>
#include <optional>
#include <vector>

#include "actions/flood/launch_box.h"
#include "actions/flood/route_flood.h"
#include "models/shapes/upright_boxes.h"
#include "models/world/collision.h"
#include "models/world/ground_map.h"

namespace possibility::actions {

/// The flood over C_S in its plainest form: every cell by itself, whole cells only. FloodSufficient
/// must agree with it.
class DenseFlood {
 public:
  using Cell = std::array<int, 4>;  ///< layer, x, y, heading

  DenseFlood(const LocomotionModel& model, const World& world, double resolution,
             const std::vector<FloodManoeuvre>& manoeuvres)
      : model_(model),
        world_(world),
        manoeuvres_(manoeuvres),
        resolution_(resolution),
        checker_(*world.environment) {
    double margin = 0;
    for (const auto& transition : model.transitions) {
      margin = std::max(margin, transition.displacement.position().norm());
    }
    const Eigen::AlignedBox2d& bounds = world.environment->bounds;
    origin_ = bounds.min() - Eigen::Vector2d::Constant(margin);
    const Eigen::Vector2d size = bounds.max() - origin_ + Eigen::Vector2d::Constant(margin);
    size_ = {static_cast<int>(model.gaits.size() * Heights().size()),
             static_cast<int>(std::ceil(size.x() / resolution)) + 1,
             static_cast<int>(std::ceil(size.y() / resolution)) + 1, kHeadings};
    states_.resize(static_cast<size_t>(size_[0]) * size_[1] * size_[2] * size_[3], kUntested);
    for (const auto& gait : model.gaits) shrunk_.emplace_back(Shrunk(gait->volumes.standing));
  }

  const Cell& size() const { return size_; }
  bool IsReached(const Cell& cell) const { return states_[Index(cell)] == kReached; }

  void Run(const GroundedStance& start) {
    const Cell first = CellOf(LayerAt(start.gait, start.z), start.pose);
    states_[Index(first)] = kReached;
    queue_.push_back(first);
    while (!queue_.empty()) {
      const Cell cell = queue_.front();
      queue_.pop_front();
      OfferNeighbours(cell);
    }
  }

 private:
  enum State : std::uint8_t { kUntested, kOpen, kReached, kClosed };
  static constexpr int kHeadings = 24;
  static constexpr double kHalfHeading = std::numbers::pi / kHeadings;

  const std::vector<double>& Heights() const { return world_.ground->levels(); }
  int NumGaits() const { return static_cast<int>(model_.gaits.size()); }
  int GaitOf(const Cell& cell) const { return cell[0] % NumGaits(); }
  double HeightOf(const Cell& cell) const { return Heights()[cell[0] / NumGaits()]; }
  int LayerAt(int gait, double z) const {
    for (size_t i = 0; i < Heights().size(); ++i) {
      if (std::abs(Heights()[i] - z) < 1e-6) return static_cast<int>(i) * NumGaits() + gait;
    }
    return -1;
  }
  double HalfDiagonal() const { return resolution_ * std::numbers::sqrt2 / 2; }

  size_t Index(const Cell& c) const {
    return ((static_cast<size_t>(c[0]) * size_[1] + c[1]) * size_[2] + c[2]) * size_[3] + c[3];
  }

  Cell CellOf(int layer, const PlanarPose& pose) const {
    const Eigen::Vector2d p = (pose.position() - origin_) / resolution_;
    const int turn = static_cast<int>(std::floor((pose.yaw + kHalfHeading) / (2 * kHalfHeading)));
    return {layer, static_cast<int>(std::floor(p.x())), static_cast<int>(std::floor(p.y())),
            ((turn % kHeadings) + kHeadings) % kHeadings};
  }
  PlanarPose Centre(const Cell& cell) const {
    return {origin_.x() + (cell[1] + 0.5) * resolution_,
            origin_.y() + (cell[2] + 0.5) * resolution_, cell[3] * 2 * kHalfHeading};
  }

  models::UprightBoxes Shrunk(const std::vector<Eigen::AlignedBox3d>& boxes) const {
    constexpr double kCheckerError = 0.0002;
    std::vector<Eigen::AlignedBox3d> shrunk;
    for (const Eigen::AlignedBox3d& box : boxes) {
      const Eigen::Vector2d far =
          box.min().head<2>().cwiseAbs().cwiseMax(box.max().head<2>().cwiseAbs());
      const double inward = HalfDiagonal() + far.norm() * kHalfHeading + kCheckerError;
      const Eigen::Vector3d margin(inward, inward, kCheckerError);
      if ((box.sizes() - 2 * margin).minCoeff() <= 0) continue;
      shrunk.emplace_back(box.min() + margin, box.max() - margin);
    }
    return models::UprightBoxes(std::move(shrunk));
  }

  bool IsOpen(const Cell& cell) const {
    const PlanarPose centre = Centre(cell);
    return GroundMayHold(model_, *world_.ground, GaitOf(cell), centre, HeightOf(cell),
                         HalfDiagonal(), kHalfHeading) &&
           checker_.AreFree(shrunk_[GaitOf(cell)], centre.At(HeightOf(cell)));
  }

  template <typename Lead>
  void Offer(Cell cell, const Lead& leads_there) {
    cell[3] = (cell[3] + kHeadings) % kHeadings;
    for (int i = 0; i < 4; ++i) {
      if (cell[i] < 0 || cell[i] >= size_[i]) return;
    }
    State& state = states_[Index(cell)];
    if (state == kUntested) state = IsOpen(cell) ? kOpen : kClosed;
    if (state != kOpen || !leads_there()) return;
    state = kReached;
    queue_.push_back(cell);
  }

  void OfferNeighbours(const Cell& cell) {
    const auto always = [] { return true; };
    for (int axis = 1; axis < 4; ++axis) {
      for (const int step : {-1, 1}) {
        Cell next = cell;
        next[axis] += step;
        Offer(next, always);
      }
    }
    for (const auto& transition : model_.transitions) {
      const PlanarPose& d = transition.displacement;
      const int base = cell[0] - GaitOf(cell);
      if (transition.from == GaitOf(cell)) OfferImage(cell, base + transition.to, d, 0, always);
      if (transition.to == GaitOf(cell)) {
        OfferImage(cell, base + transition.from, d.Inverse(), 0, always);
      }
    }
    for (const FloodManoeuvre& manoeuvre : manoeuvres_) {
      if (manoeuvre.from != GaitOf(cell)) continue;
      for (const double height : Heights()) OfferLandings(cell, manoeuvre, height);
    }
  }

  void OfferLandings(const Cell& cell, const FloodManoeuvre& manoeuvre, double height) {
    const auto range = manoeuvre.landings(height - HeightOf(cell));
    if (!range) return;
    const Eigen::Vector2d low = range->offset.min(), high = range->offset.max();
    const int turns = static_cast<int>(std::ceil(range->turn / (2 * kHalfHeading) - 1e-9));
    LaunchBox launches{.launch = {GaitOf(cell), HeightOf(cell)},
                       .landing = {manoeuvre.to, height},
                       .middle = Centre(cell),
                       .half_place = Eigen::Vector2d::Constant(resolution_ / 2),
                       .half_heading = kHalfHeading};
    launches.half_turn = turns > 0 ? kHalfHeading : 0;
    launches.half_displacement = ((high - low).array() > 0).cast<double>() * resolution_ / 4;
    for (const double x : Samples(low.x(), high.x())) {
      for (const double y : Samples(low.y(), high.y())) {
        for (int turn = -turns; turn <= turns; ++turn) {
          launches.displacement = {x, y, turn * 2 * kHalfHeading};
          OfferImage(cell, LayerAt(manoeuvre.to, height), launches.displacement,
                     launches.half_displacement.norm(),
                     [&] { return MayLand(model_, *world_.ground, launches, 16); });
        }
      }
    }
  }

  std::vector<double> Samples(double low, double high) const {
    std::vector<double> samples = {low};
    for (double s = low + resolution_ / 2; s < high; s += resolution_ / 2) samples.push_back(s);
    if (high > low) samples.push_back(high);
    return samples;
  }

  template <typename Lead>
  void OfferImage(const Cell& cell, int layer, const PlanarPose& displacement, double beside,
                  const Lead& leads_there) {
    const PlanarPose image = Centre(cell) * displacement;
    const double spread = resolution_ / 2 + displacement.position().norm() * kHalfHeading + beside;
    const Cell low = CellOf(layer, {image.x - spread, image.y - spread, image.yaw});
    const Cell high = CellOf(layer, {image.x + spread, image.y + spread, image.yaw});
    for (int x = low[1]; x <= high[1]; ++x) {
      for (int y = low[2]; y <= high[2]; ++y) Offer({layer, x, y, low[3]}, leads_there);
    }
  }

  const LocomotionModel& model_;
  const World& world_;
  const std::vector<FloodManoeuvre>& manoeuvres_;
  double resolution_;
  models::CollisionChecker checker_;
  Eigen::Vector2d origin_;
  Cell size_{};
  std::vector<State> states_;
  std::deque<Cell> queue_;
  std::vector<models::UprightBoxes> shrunk_;  ///< by gait
};

}  // namespace possibility::actions
