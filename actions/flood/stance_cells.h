#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "actions/conditions/locomotion_model.h"
#include "actions/conditions/quasi_static_action.h"
#include "actions/flood/cell_quadtrees.h"
#include "models/shapes/upright_boxes.h"
#include "models/world/collision.h"
#include "models/world/ground_map.h"

namespace possibility::actions {

/// How closely the flood over C_S looks.
struct StanceCellSettings {
  double resolution = 0.1;  ///< of a cell, m
  int headings = 24;        ///< that the circle is divided into
  int halvings = 0;         ///< of a cell along every axis before it counts as open in doubt
  /// By so much (m) every gait is taken for narrower on each side and for lower than it is, and
  /// ground for wider on each side.
  double leniency = 0;
};

/// Cells of stances: planes are a layer (a gait at a height) and a heading, x and y are places. A
/// cell is closed only if no stance in it meets C_S, whatever alternative of the gait's volumes
/// (FloodVolumes) is taken. For one thread.
class StanceCells {
 public:
  /// All must outlive it. `heights`: of the ground that stances may be on; `margin`: how far beyond
  /// the bounds there are cells, m.
  StanceCells(const LocomotionModel& model, const World& world, std::vector<double> heights,
              double margin, const StanceCellSettings& settings);

  const StanceCellSettings& settings() const { return settings_; }
  const std::vector<double>& heights() const { return heights_; }
  const Eigen::Vector2d& origin() const { return origin_; }
  int num_layers() const { return static_cast<int>(model_.gaits.size() * heights_.size()); }
  int num_planes() const { return num_layers() * settings_.headings; }
  /// Cells along x and y; whole numbers, however large.
  Eigen::Vector2d NumCells() const;

  int Layer(int gait, size_t height) const;
  int LayerOf(const CellBlock& block) const { return block.plane / settings_.headings; }
  int HeadingOf(const CellBlock& block) const { return block.plane % settings_.headings; }
  int GaitOf(const CellBlock& block) const;
  double HeightOf(const CellBlock& block) const;
  /// The plane of a layer for a heading, which may have gone round.
  int Plane(int layer, int heading) const;
  /// The same, of another gait or another heading.
  int PlaneOfGait(const CellBlock& block, int gait) const;
  int PlaneTurned(const CellBlock& block, int turn) const;

  /// Nothing at a height that is none of the cells'.
  std::optional<CellBlock> CellOf(const GroundedStance& stance) const;
  CellBlock CellOf(int layer, const PlanarPose& pose) const;
  /// Whether all of the block's cells are cells here.
  bool Contains(const CellBlock& block) const;
  PlanarPose Centre(const CellBlock& block) const;
  double half_heading() const;

  /// Whether a stance in each cell of the block may be possible, in none of them, or whether that
  /// is not known of the block as a whole. Never kMixed of a cell.
  BlockState Judge(const CellBlock& block) const;

  /// Whether the stance in the middle of a cell meets what C_S asks of it (of its volumes, those of
  /// one alternative).
  bool CentreStands(const CellBlock& cell) const;

  /// What closes a cell: "no ground", or obstacles by name.
  std::vector<std::string> Blockers(const CellBlock& cell) const;

 private:
  /// One alternative of the boxes that a gait may need, as cells see it.
  struct Volume {
    std::vector<Eigen::AlignedBox3d> boxes;           ///< whole, but for the leniency
    models::UprightBoxes whole;                       ///< the same
    std::vector<models::UprightBoxes> shrunk;         ///< by halvings: covered from a whole part
    std::vector<Eigen::AlignedBox3d> certainly_free;  ///< free where free in a block: all open
    std::vector<models::UprightBoxes> shared;         ///< covered from all of 2, 4, 8 cells
  };

  std::vector<Eigen::AlignedBox3d> Lenient(std::vector<Eigen::AlignedBox3d> boxes) const;
  std::vector<Eigen::AlignedBox3d> Shrunk(const std::vector<Eigen::AlignedBox3d>& boxes,
                                          double inward, double inward_per_metre) const;
  Volume MakeVolume(const std::vector<Eigen::AlignedBox3d>& boxes) const;
  double HalfDiagonal() const;
  bool OneFaceHolds(const CellBlock& cell) const;
  bool MayStand(const CellBlock& cell, const PlanarPose& centre, int halvings,
                bool is_over_ground) const;
  bool CentreStands(int gait, const PlanarPose& centre, double z, bool is_over_ground) const;
  bool IsAllClosed(const CellBlock& block) const;
  bool IsAllOpen(const CellBlock& block) const;

  const LocomotionModel& model_;
  const World& world_;
  std::vector<double> heights_;
  StanceCellSettings settings_;
  Eigen::Vector2d origin_;
  double margin_;
  models::CollisionChecker checker_;
  std::vector<std::vector<Volume>> volumes_;  ///< by gait and alternative
  /// By plane and halvings: the part of a cell in doubt that was open last, to be asked first.
  mutable std::vector<int> free_parts_;
};

}  // namespace possibility::actions
