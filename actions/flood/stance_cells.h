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

/// Resolution of the flood over C_S.
struct StanceCellSettings {
  double resolution = 0.1;  ///< cell size, m
  int headings = 24;        ///< number of headings on the circle
  int halvings = 0;         ///< of a cell along every axis before it counts as open if undecided
  /// Relaxation (m): treats every gait as narrower on each side and lower, and ground as wider on
  /// each side, by this much.
  double leniency = 0;
};

/// Cells of stances. A plane is a layer (a gait at a height) and a heading; x and y are positions.
/// A cell is closed only if no stance in it meets C_S with any alternative of the gait's volumes
/// (FloodVolumes). For one thread.
class StanceCells {
 public:
  /// All references must outlive this object. `heights`: ground heights of stances. `margin`:
  /// extent of the cells beyond the bounds, m.
  StanceCells(const LocomotionModel& model, const World& world, std::vector<double> heights,
              double margin, const StanceCellSettings& settings);

  const StanceCellSettings& settings() const { return settings_; }
  const std::vector<double>& heights() const { return heights_; }
  const Eigen::Vector2d& origin() const { return origin_; }
  int num_layers() const { return static_cast<int>(model_.gaits.size() * heights_.size()); }
  int num_planes() const { return num_layers() * settings_.headings; }
  /// Cells along x and y; whole numbers of any size.
  Eigen::Vector2d NumCells() const;

  int Layer(int gait, size_t height) const;
  int LayerOf(const CellBlock& block) const { return block.plane / settings_.headings; }
  int HeadingOf(const CellBlock& block) const { return block.plane % settings_.headings; }
  int GaitOf(const CellBlock& block) const;
  double HeightOf(const CellBlock& block) const;
  /// The plane of a layer for a heading, which may be any integer (wraps around).
  int Plane(int layer, int heading) const;
  /// The block's plane with another gait or another heading.
  int PlaneOfGait(const CellBlock& block, int gait) const;
  int PlaneTurned(const CellBlock& block, int turn) const;

  /// None at a height without cells.
  std::optional<CellBlock> CellOf(const GroundedStance& stance) const;
  CellBlock CellOf(int layer, const PlanarPose& pose) const;
  /// Whether the grid contains all of the block's cells.
  bool Contains(const CellBlock& block) const;
  PlanarPose Centre(const CellBlock& block) const;
  double half_heading() const;

  /// Open if a stance may be possible in each cell of the block, closed if in none of them, kMixed
  /// if undecided for the block as a whole. Never kMixed for a cell.
  BlockState Judge(const CellBlock& block) const;

  /// Whether the stance in the middle of a cell meets C_S with one alternative of its volumes.
  bool CentreStands(const CellBlock& cell) const;

  /// What closes a cell: "no ground", or names of obstacles.
  std::vector<std::string> Blockers(const CellBlock& cell) const;

 private:
  /// One alternative of a gait's boxes, prepared for cells. Core: the space that all of them cover.
  struct Volume {
    std::vector<Eigen::AlignedBox3d> boxes;           ///< reduced by the leniency
    models::UprightBoxes whole;                       ///< the same
    std::vector<models::UprightBoxes> shrunk;         ///< by halvings: core of a part's stances
    std::vector<Eigen::AlignedBox3d> certainly_free;  ///< free all over a block: all open
    std::vector<models::UprightBoxes> shared;         ///< core of the stances in 2, 4, 8 cells
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
  /// By plane and halvings: the part of an undecided cell that was open last, tested first.
  mutable std::vector<int> free_parts_;
};

}  // namespace possibility::actions
