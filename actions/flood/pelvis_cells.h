#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "actions/conditions/locomotion_model.h"
#include "actions/conditions/manoeuvre_bounds.h"
#include "actions/conditions/quasi_static_action.h"
#include "actions/flood/cell_quadtrees.h"
#include "actions/flood/solid_boxes.h"
#include "models/world/collision.h"

namespace possibility::actions {

/// Cells of positions of the largest ball inside the pelvis; planes are heights of its centre. A
/// cell is closed only if the ball is nowhere in it both free and within reach of ground, in any
/// orientation. The cells cover all positions of the ball for which the root is within the bounds,
/// and no more. A wall or a floor as long as the bounds is still a barrier, because the cells at
/// its ends are halved: a whole cell might hold a free ball where none of its parts does.
/// Immutable.
class PelvisCells {
 public:
  /// `resolution` (m) is refined until the ball is larger than a cell. `leg_reach`: upper bound of
  /// a bearing contact's distance from the root, m. `flight`: maximum over all manoeuvres.
  PelvisCells(const LocomotionModel& model, const World& world, double resolution, double leg_reach,
              const FlightBounds& flight);

  /// Along x, y and z; whole numbers of any size.
  const Eigen::Vector3d& num_cells() const { return num_cells_; }
  const Eigen::Vector3d& size() const { return size_; }   ///< of a cell, m
  const Eigen::Vector3d& origin() const { return low_; }  ///< of the first cell

  /// The centre of the ball in a stance, world, m.
  Eigen::Vector3d BallAt(const GroundedStance& stance) const;
  /// The cell of the ball in a stance.
  CellBlock CellOf(const GroundedStance& stance) const { return CellOf(BallAt(stance)); }
  Eigen::Vector3d Centre(const CellBlock& block) const;

  /// Open if the ball may be free in each cell of the block, closed if in none of them, kMixed if
  /// undecided for the block as a whole. Never kMixed for a cell.
  BlockState Judge(const CellBlock& block) const;

  /// What blocks the way from a cell towards a goal: "no ground", or names of obstacles.
  std::vector<std::string> Blockers(const CellBlock& cell, const GroundedStance& goal) const;

 private:
  struct Ball {
    Eigen::Vector3d centre_R = Eigen::Vector3d::Zero();  ///< in the root frame
    double radius = 0;                                   ///< m
  };
  static Ball LargestBall(const models::PosedShape& posed);
  static Ball LargestBall(const models::Link& link);

  CellBlock CellOf(const Eigen::Vector3d& p) const;
  Eigen::Vector3d Corner(int side) const;
  double ShrunkRadius(double to_corner) const;
  bool IsAllOpen(const CellBlock& block, const Eigen::Vector3d& p,
                 const Eigen::Vector2d& half) const;
  bool IsAllClosed(const Eigen::Vector3d& p, const Eigen::Vector2d& half) const;
  double Reach(const Eigen::Vector3d& p, double level) const;
  bool GroundIsNear(const Eigen::Vector3d& p, double displaced = 0) const;
  bool GroundIsNearAllAround(const Eigen::Vector3d& p, double displaced) const;
  bool IsWithinBounds(const Eigen::Vector2d& p, const Eigen::Vector2d& half) const;
  bool MayBeFree(const Eigen::Vector3d& p, int halvings) const;

  const LocomotionModel& model_;
  const World& world_;
  Ball ball_;
  double resolution_;
  double reach_;
  FlightBounds flight_;
  models::CollisionChecker checker_;
  SolidBoxes solids_;
  models::Shape whole_;
  models::PreparedShape prepared_whole_;
  Eigen::Vector3d low_;  ///< corners of all cells together, m
  Eigen::Vector3d high_;
  Eigen::Vector3d num_cells_;
  Eigen::Vector3d size_;
  std::vector<models::PreparedShape> shrunk_;  ///< by halvings: covered from all of a part
  double solid_radius_ = 0;                    ///< m, a ball surely inside each cell's shrunk one
};

}  // namespace possibility::actions
