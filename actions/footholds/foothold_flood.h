#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

#include "actions/footholds/footstep.h"
#include "actions/footholds/ground_cover.h"
#include "actions/wholebody/nominal_stance.h"
#include "common/cancellation_token.h"

namespace possibility::actions {

/// Which ground the steps of a family can reach at most. It keeps to what every step needs: some
/// turn of a sole that fits the ground, and a place that is near enough and not too high. Where it
/// says no there is no sequence of steps; where it says yes there may be none either. Immutable
/// once built.
///
/// It floods the cells of a grid on every plane of the ground. A cell is ground if a sole may bear
/// with its patch's centre in it, if no solid stands there (GroundCover), and if that centre can
/// get there without passing through obstacles that are too high for every swing (SwingBarriers).
/// Ground that hangs together counts as reached as a whole, so between levels only cells at an edge
/// have to be asked how far a step leads from there.
class FootholdFlood {
 public:
  /// `planes`: of the ground, those that a foot may bear on. `starts`: both limbs bear there.
  /// `limits`: the family. @throws Cancelled.
  FootholdFlood(const NominalStance& stance, const World& world, std::vector<int> planes,
                const FootstepLimits& limits, const std::vector<GroundedStance>& starts,
                const CancellationToken& cancellation = {});

  /// Floods the same ground from other starts. What is known of the ground is kept, which was most
  /// of the work. @throws Cancelled.
  void Restart(const std::vector<GroundedStance>& starts,
               const CancellationToken& cancellation = {});

  /// False only if no steps of the family lead to a place where the limb bears so.
  bool Reaches(int limb, const Foothold& place) const;
  /// Of all limbs.
  bool Reaches(const GroundedStance& goal) const;

  /// No step brings the centre of a patch farther than this from the other one, m.
  static double ReachOf(const NominalStance& stance, const FootstepLimits& limits);

 private:
  enum class Cell : signed char {
    kUnknown,
    kNoGround,
    kGround,  ///< not reached
    kBarred,  ///< not reached: a patch's centre does not get there; whether it is ground is unknown
    kReached
  };

  /// Bearing points from the patch's centre.
  struct Sole {
    std::vector<Eigen::Vector2d> points;
    double radius = 0;
  };
  /// Places of a sole: its centre in a square, its turn in an interval.
  struct SolePlaces {
    Eigen::Vector2d centre;  ///< of the square
    double half_side = 0;    ///< m
    double turn = 0;         ///< middle, rad
    double half_turn = 0;    ///< rad
  };
  struct Place {
    int plane = 0, column = 0, row = 0;  ///< the plane as an index into planes_
  };

  void SizeGrid();
  void FindBarriers();
  /// Where the centres of patches can get to, seen from above.
  void FloodAir(const std::vector<GroundedStance>& starts);
  std::size_t IndexOf(int column, int row) const {
    return static_cast<std::size_t>(row) * columns_ + column;
  }
  void ReachFrom(const GroundedStance& start);
  void Flood(const CancellationToken& cancellation);
  bool IsInGrid(int column, int row) const {
    return column >= 0 && row >= 0 && column < columns_ && row < rows_;
  }
  Cell& At(const Place& place) {
    return cells_[place.plane][static_cast<std::size_t>(place.row) * columns_ + place.column];
  }
  Eigen::Vector2d CentreOf(const Place& place) const {
    return bounds_.min() + cell_ * Eigen::Vector2d(place.column + 0.5, place.row + 0.5);
  }
  Place PlaceAt(int plane, const Eigen::Vector2d& p) const;
  bool IsLevel(int plane) const;
  bool IsCovered(const Place& place) const;
  /// Heights of the cell's ground: the middle, and how far they may be from it.
  double HeightOf(const Place& place) const;
  double SlackOf(int plane) const;
  /// Planes with ground that a step may lead to from a cell, or from height z about p.
  std::vector<int> PlanesAbout(const Eigen::Vector2d& p, double z, double slack) const;
  bool MayBear(const Place& place) const;
  bool MayBear(const Sole& sole, int level, const Eigen::Vector2d& centre) const;
  /// Whether one of the places may bear. Branch and bound, down to kFinestSlack.
  bool MayBear(const Sole& sole, int level, const SolePlaces& places) const;
  /// Whether all points of the sole in the middle of the places are within the margin, give or take
  /// `slack`, m.
  bool Fits(const Sole& sole, int level, const SolePlaces& places, double slack) const;
  static bool IsOpen(Cell cell) { return cell == Cell::kUnknown || cell == Cell::kGround; }
  void Reach(const Place& place);
  /// All cells of a plane that a step of the family leads to from height z about a cell.
  void ReachAround(const Place& centre, double z, double slack, int plane);
  bool ReachNeighbours(const Place& place);
  void Expand(const Place& place);

  const NominalStance& stance_;
  const World& world_;
  std::vector<int> planes_;
  FootstepLimits limits_;
  GroundCover cover_;
  double reach_;  ///< m, of a step
  std::vector<Sole> soles_;
  Eigen::AlignedBox2d bounds_;
  double cell_ = 0;  ///< m
  int columns_ = 0, rows_ = 0;
  std::vector<int> half_widths_;          ///< of the disc of a step: cells, by rows from its centre
  std::vector<std::vector<Cell>> cells_;  ///< by plane
  // By cell, seen from above.
  std::vector<bool> is_solid_;   ///< filled by barriers
  std::vector<bool> is_barred_;  ///< no patch's centre gets there
  std::vector<Place> queue_;
};

}  // namespace possibility::actions
