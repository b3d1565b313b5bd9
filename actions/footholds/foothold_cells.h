#pragma once

#include <Eigen/Geometry>
#include <atomic>
#include <cstddef>
#include <vector>

#include "actions/footholds/footstep.h"
#include "actions/footholds/ground_cover.h"
#include "actions/wholebody/nominal_stance.h"

namespace possibility::actions {

/// Cells of a grid on every plane of the ground, and which of them may bear a sole. A cell is
/// tested when it is first asked for and then kept, so one object serves all searches in a world.
/// Several threads may use it.
class FootholdCells {
 public:
  struct Place {
    int plane = 0, column = 0, row = 0;  ///< the plane as an index into planes()
  };
  /// A cell about another one.
  struct Offset {
    int column = 0, row = 0;
    double distance = 0;  ///< m
  };

  /// `planes`: of the ground, those that a foot may bear on. `stance` and `world` must outlive
  /// this.
  FootholdCells(const NominalStance& stance, const World& world, std::vector<int> planes,
                const FootstepLimits& limits);

  const std::vector<int>& planes() const { return planes_; }
  int NumPlanes() const { return static_cast<int>(planes_.size()); }
  double cell() const { return cell_; }  ///< m
  std::size_t size() const { return state_.size(); }
  double reach() const { return reach_; }  ///< m, of a step
  /// About any cell, the nearest first.
  std::vector<Offset> Disc(double radius) const;

  bool IsInGrid(int column, int row) const {
    return column >= 0 && row >= 0 && column < columns_ && row < rows_;
  }
  std::size_t IndexOf(const Place& place) const {
    return (static_cast<std::size_t>(place.plane) * rows_ + place.row) * columns_ + place.column;
  }
  Place PlaceOf(std::size_t index) const;
  /// The nearest one, if p is outside.
  Place PlaceAt(int plane, const Eigen::Vector2d& p) const;
  Eigen::Vector2d CentreOf(const Place& place) const {
    return bounds_.min() + cell_ * Eigen::Vector2d(place.column + 0.5, place.row + 0.5);
  }
  /// Of the plane at the cell's centre, m.
  double HeightOf(const Place& place) const;
  bool IsHorizontal(int plane) const;
  const GroundCover& cover() const { return cover_; }

  /// Whether a sole may bear with its centre in the cell, in some turn; never false if one does.
  bool IsGround(const Place& place) const;
  /// All around it is ground.
  bool IsInside(const Place& place) const;

 private:
  enum State : signed char { kUnknown, kNoGround, kGround };

  bool MayBear(const Place& place) const;

  const NominalStance& stance_;
  const World& world_;
  std::vector<int> planes_;
  double margin_;                                    ///< FootstepLimits
  std::vector<std::vector<Eigen::Vector2d>> soles_;  ///< from their centres, turned
  double radius_ = 0;                                ///< m, of the soles
  double reach_;
  GroundCover cover_;
  Eigen::AlignedBox2d bounds_;
  double cell_ = 0;
  int columns_ = 0, rows_ = 0;
  mutable std::vector<std::atomic<State>> state_;  ///< by cell
};

}  // namespace possibility::actions
