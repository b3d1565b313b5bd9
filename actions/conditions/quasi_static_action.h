#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "actions/conditions/locomotion_model.h"
#include "actions/conditions/pelvis_clearance.h"
#include "graph/action/action.h"
#include "models/shapes/upright_boxes.h"
#include "models/world/collision.h"
#include "models/world/ground_map.h"

namespace possibility::actions {

/// The world in which actions are tested.
struct World {
  const models::Environment* environment = nullptr;
  const models::GroundMap* ground = nullptr;
};

/// Condition of a quasi-static action that fails, for messages.
enum class StanceFault { kNone, kOutOfBounds, kOffGround, kCollision };

/// Walking and crawling (paper, section "Walk and Crawl"): a holonomic action. C_S requires flat
/// ground, the nominal orientation, and free space for the nominal posture at a vertex and for the
/// strides along an edge. C_N concerns the pelvis alone. Const functions may run in several
/// threads, but not beside Forbid.
class QuasiStaticAction : public graph::HolonomicAction {
 public:
  /// Largest motion of any point of a swept volume between samples of an edge, m.
  static constexpr double kEdgeInflation = 0.02;

  /// `model` and `world` must outlive the action. `step`: longest ExtendTowards in the metric of
  /// `space`.
  QuasiStaticAction(const LocomotionModel& model, int gait, const World& world,
                    std::shared_ptr<const graph::ExplorationSpace> space, double step);

  std::string name() const override;
  graph::Point ExtendTowards(const graph::Point& v0, const graph::Point& v1) const override;
  bool CN(const graph::Point& vertex) const override;
  bool CN(const graph::Edge& edge) const override;
  bool CS(const graph::Point& vertex) const override;
  bool CS(const graph::Edge& edge) const override;

  /// No job of this action could decide more than C_S does, so it explores C_S only, as the paper's
  /// experiments do.
  bool Explorable(const graph::Point& vertex) const override { return CS(vertex); }
  bool Explorable(const graph::Edge& edge) const override { return CS(edge); }

  std::vector<graph::Point> TransitionFrom(const graph::Point& v) const override;
  bool IsReversible() const override { return true; }
  double ExpectedDuration(const graph::Edge& edge) const override;
  std::unique_ptr<graph::ConfirmationJob> SpawnConfirmationJob(
      const graph::Edge& edge) const override;
  graph::Point Project(const graph::Point& v) const override;

  /// First sufficient condition that fails at a stance of this gait; kNone if all hold.
  StanceFault Examine(const GroundedStance& stance) const;
  /// Name of the first obstacle where the robot would stand at `stance`; empty if none.
  std::string FirstBlocker(const GroundedStance& stance) const;
  /// Sufficient conditions on the straight way between two stances of this gait.
  bool IsClear(const GroundedStance& from, const GroundedStance& to) const;
  /// C_S of the straight way between two stances of this gait, and of these.
  bool CS(const GroundedStance& from, const GroundedStance& to) const;
  /// True if every bearing point of the stance (of any gait) is on ground, `clearance` (m) from its
  /// edge.
  bool GroundHolds(const GroundedStance& stance, double clearance) const;

  /// Expected time of the straight way between two stances, s.
  double ExpectedDuration(const PlanarPose& from, const PlanarPose& to) const;
  /// The same from rest to rest, s.
  double DurationAlone(const PlanarPose& from, const PlanarPose& to) const;

  /// Makes C_S false for an edge that met C_S but failed as motion.
  void Forbid(const graph::Edge& edge);
  bool IsForbidden(const graph::Edge& edge) const;

  const LocomotionModel& model() const { return *model_; }
  int gait() const { return gait_; }
  const World& world() const { return world_; }

 private:
  struct StraightWay;

  /// Swept volume of the strides of one class.
  struct Sweep {
    models::UprightBoxes boxes;  ///< inflated by their motion between samples
    double radius = 0;           ///< farthest point of the volume from the stance's axis, m
  };
  static Sweep SweepOf(const GaitVolumes& volumes, StrideClass strides);
  const Sweep& sweep(StrideClass strides) const {
    return sweeps_[static_cast<std::size_t>(strides)];
  }

  bool BoxesFree(const models::UprightBoxes& boxes, const GroundedStance& stance) const {
    return checker_.AreFree(boxes, stance.pose.At(stance.z));
  }
  /// For stances within the bounds.
  bool StraightWayHolds(const GroundedStance& from, const GroundedStance& to) const;
  StraightWay WayBetween(const GroundedStance& from, const GroundedStance& to) const;
  /// Tests the horizontal position `root` of the pelvis. Empty bounds bound nothing.
  bool IsWithinBounds(const Eigen::Vector2d& root) const;
  bool IsWithinBounds(const GroundedStance& stance) const;
  std::optional<bool> FacesHold(int level, const GroundedStance& stance, double clearance) const;
  bool OneFaceHoldsPart(const StraightWay& way, int level, int first, int last,
                        double half_turn) const;
  bool SampleIsClear(const StraightWay& way, int sample) const;
  bool PartIsCertainlyClear(const StraightWay& way, int first, int last) const;
  bool PartIsOverGround(const StraightWay& way, int level, int first, int last) const;
  bool SamplesAreClear(const StraightWay& way) const;
  /// The level of this height; none unless there is exactly one.
  std::optional<int> OnlyLevelAt(double z) const;
  /// The transition between two root poses, in either direction, and the stance of its first gait;
  /// null if there is none.
  const LocomotionModel::TransitionEntry* FindTransition(
      const std::array<Eigen::Isometry3d, 2>& ends, GroundedStance* start) const;
  bool TransitionIsClear(const LocomotionModel::TransitionEntry& transition,
                         const GroundedStance& start) const;
  bool SomeLimbReachesGround(const Eigen::Isometry3d& X_WR) const;
  bool EveryLimbReachesGround(const Eigen::Isometry3d& X_WR) const;

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
  std::vector<double>
      bearing_radii_;  ///< by gait: distance of the farthest bearing point from the axis, m
  std::vector<graph::Edge> forbidden_;
};

}  // namespace possibility::actions
