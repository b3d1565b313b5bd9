#pragma once

#include <Eigen/Core>
#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

#include "actions/footholds/foothold_cells.h"
#include "actions/wholebody/planar_pose.h"

namespace possibility::actions {

/// Where both limbs find ground about the middle of a stance, so that one can pass the other: their
/// patches are beside each other. It knows places and headings of a lattice, and ground as finely
/// as FootholdCells. Found out as it is asked, and kept. Several threads may use it.
class StandingRoom {
 public:
  static constexpr int kHeadings = 8;  ///< of half a turn

  /// `first_heading`: rad, one of the lattice's. `gap`: m, between the patches. References must
  /// outlive this.
  StandingRoom(const FootholdCells& cells, const NominalStance& stance, const World& world,
               const FootstepLimits& limits, double first_heading, double gap);

  double cell() const { return cell_; }  ///< m, of the lattice over the environment's bounds
  double first_heading() const { return first_heading_; }
  /// Whether there is room on a layer (index into FootholdCells::planes()) about the lattice's pose
  /// nearest to `middle`.
  bool IsAt(int layer, const PlanarPose& middle) const;

 private:
  /// By heading.
  using Sides = Eigen::Array<float, kHeadings, 1>;
  /// One bit for each heading.
  using Headings = std::uint16_t;
  static constexpr Headings kAll = (1U << kHeadings) - 1;
  static constexpr Headings kKnown = 1U << 15;

  struct Offset {
    int column = 0, row = 0;
    Sides beside = Sides::Zero();  ///< m, to the left
  };

  Headings At(int layer, int column, int row) const;
  Headings Find(int layer, const Eigen::Vector2d& middle) const;
  /// Headings in which a sole fits the ground with its centre at the cell's.
  Headings Fits(const FootholdCells::Place& place) const;
  Headings FindFits(const FootholdCells::Place& place) const;
  std::vector<int> LayersNear(const Eigen::Vector2d& middle, double z) const;

  const FootholdCells& cells_;
  const World& world_;
  double margin_, rise_;  ///< FootstepLimits
  double first_heading_;
  double needed_ = 0;  ///< m, from the left sole's centre to the right one's
  double around_;      ///< m: soles are that near
  std::array<std::vector<Eigen::Vector2d>, kHeadings> soles_;  ///< from their centres
  std::vector<Offset> disc_;
  std::vector<Sides> refused_;       ///< by Headings: 0 where the bit is set, else a large number
  std::vector<int> layer_of_plane_;  ///< -1: none
  double cell_;
  int columns_ = 1, rows_ = 1;
  mutable std::vector<std::atomic<Headings>> fits_;   ///< by FootholdCells::IndexOf
  mutable std::vector<std::atomic<Headings>> known_;  ///< by layer and cell of the lattice
};

}  // namespace possibility::actions
