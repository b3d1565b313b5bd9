#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "actions/conditions/locomotion_model.h"
#include "actions/conditions/pelvis_clearance.h"
#include "graph/action.h"
#include "models/shapes/upright_boxes.h"
#include "models/world/collision.h"
#include "models/world/ground_map.h"

namespace possibility::actions {

/// The world that actions are tested in.
struct World {
  const models::Environment* environment = nullptr;
  const models::GroundMap* ground = nullptr;
};

/// Where the conditions of a quasi-static action fail, for messages.
enum class StanceFault { kNone, kOutOfBounds, kOffGround, kCollision };

/// Walking and crawling (paper, section "Walk and Crawl"): holonomic, with sufficient conditions
/// on flat ground in the nominal orientation and on room, for the nominal posture at a vertex and
/// for the strides of an edge along it, and necessary conditions on the pelvis alone. One exploring
/// thread per instance.
class QuasiStaticAction : public graph::HolonomicAction {
 public:
  /// Between samples of an edge, no point of a swept volume moves farther than this, m.
  static constexpr double kEdgeInflation = 0.02;

  /// `model` and `world` must outlive the action. `step`: longest ExtendTowards in the metric of
  /// `space`.
  QuasiStaticAction(const LocomotionModel& model, int gait, const World& world,
                    std::shared_ptr<const graph::ExplorationSpace> space, double step);

  std::string name() const override;
  graph::Point ExtendTowards(const graph::Point& v0, const graph::Point& v1) const override;
  bool CN(const graph::Point& vertex) const override;
  bool CN(const graph::PointPair& edge) const override;
  bool CS(const graph::Point& vertex) const override;
  bool CS(const graph::PointPair& edge) const override;

  /// This action has no job that could decide more than C_S does, so it explores C_S only (the
  /// paper's experiments do the same).
  bool Explorable(const graph::Point& vertex) const override { return CS(vertex); }
  bool Explorable(const graph::PointPair& edge) const override { return CS(edge); }

  std::vector<graph::Point> TransitionFrom(const graph::Point& v) const override;
  bool IsReversible() const override { return true; }
  double ExpectedDuration(const graph::PointPair& edge) const override;
  std::unique_ptr<graph::ConfirmationJob> SpawnConfirmationJob(
      const graph::PointPair& edge) const override;
  graph::Point Project(const graph::Point& v) const override;

  /// Sufficient conditions on a stance of this gait and on the straight way between two.
  StanceFault Examine(const GroundedStance& stance) const;
  /// Name of the first obstacle where the robot would stand at `stance`; empty if none.
  std::string FirstBlocker(const GroundedStance& stance) const;
  bool IsClear(const GroundedStance& from, const GroundedStance& to) const;
  /// C_S of the straight way between two stances of this gait, and of these.
  bool CS(const GroundedStance& from, const GroundedStance& to) const;
  /// Every bearing point of the stance, of whatever gait, is on ground, `clearance` (m) from its
  /// edge.
  bool GroundHolds(const GroundedStance& stance, double clearance) const;

  /// Expected time of the straight way between two stances, s.
  double ExpectedDuration(const PlanarPose& from, const PlanarPose& to) const;

  /// The edge failed as motion although it met C_S: C_S is false for it from now on.
  void Forbid(const graph::PointPair& edge);
  bool IsForbidden(const graph::PointPair& edge) const;

  const LocomotionModel& model() const { return *model_; }
  int gait() const { return gait_; }

 private:
  struct StraightWay;

  /// Of the strides of one class.
  struct Sweep {
    models::UprightBoxes boxes;  ///< inflated by what they move between samples
    double radius = 0;           ///< farthest point of the volume from the stance's axis, m
  };
  static Sweep SweepOf(const GaitVolumes& volumes, StrideClass strides);
  const Sweep& sweep(StrideClass strides) const {
    return sweeps_[static_cast<std::size_t>(strides)];
  }

  bool BoxesFree(const models::UprightBoxes& boxes, const GroundedStance& stance) const {
    return checker_.AreFree(boxes, stance.pose.At(stance.z));
  }
  /// Between stances within the bounds.
  bool StraightWayHolds(const GroundedStance& from, const GroundedStance& to) const;
  StraightWay WayBetween(const GroundedStance& from, const GroundedStance& to) const;
  /// The pelvis, at `root` seen from above; bounds that are empty bound nothing.
  bool IsWithinBounds(const Eigen::Vector2d& root) const;
  bool IsWithinBounds(const GroundedStance& stance) const;
  std::optional<bool> FacesHold(int level, const GroundedStance& stance, double clearance) const;
  bool OneFaceHoldsPart(const StraightWay& way, int level, int first, int last,
                        double half_turn) const;
  bool SampleIsClear(const StraightWay& way, int sample) const;
  bool PartIsCertainlyClear(const StraightWay& way, int first, int last) const;
  bool PartIsOverGround(const StraightWay& way, int level, int first, int last) const;
  bool SamplesAreClear(const StraightWay& way) const;
  /// The level of this height if there is but one.
  std::optional<int> OnlyLevelAt(double z) const;
  /// The transition that leads from one of two root poses to the other in either direction, and
  /// the stance of its first gait; null if none does.
  const LocomotionModel::TransitionEntry* FindTransition(
      const std::array<Eigen::Isometry3d, 2>& ends, GroundedStance* start) const;
  bool TransitionIsClear(const LocomotionModel::TransitionEntry& transition,
                         const GroundedStance& start) const;
  bool SomeLimbReachesGround(const Eigen::Isometry3d& X_WR) const;

  const LocomotionModel* model_;
  int gait_;
  World world_;
  std::shared_ptr<const graph::ExplorationSpace> space_;
  double step_;
  models::CollisionChecker checker_;
  PelvisClearance pelvis_;
  models::UprightBoxes standing_;
  std::array<Sweep, kStrideClasses.size()> sweeps_;
  std::vector<models::UprightBoxes> transition_sweeps_;  ///< by index of the model's transitions
  std::vector<double> bearing_radii_;  ///< by gait: farthest bearing point from the axis, m
  double bearing_reach_ = 0;           ///< no limb bears farther from the root, m
  std::vector<graph::PointPair> forbidden_;
};

}  // namespace possibility::actions
