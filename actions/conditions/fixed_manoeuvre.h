#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "actions/conditions/manoeuvre.h"
#include "actions/wholebody/planar_pose.h"
#include "graph/action/shared_work.h"

namespace possibility::actions {

/// Obstacles that a manoeuvre leads over, in the frame of its launch stance: between two planes
/// square to the heading, across the line ahead.
struct CrossedSpace {
  double begin = 0;   ///< m ahead
  double end = 0;     ///< m ahead
  double height = 0;  ///< m above the launch ground, of the highest
};

/// What a FixedManoeuvre does, wherever it does it.
struct FixedManoeuvreShape {
  std::string name;
  int from = 0;             ///< index of the first gait
  int to = 0;               ///< index of the last gait
  PlanarPose displacement;  ///< landing stance in the launch stance
  double lowest = 0;        ///< m, least rise: height of the landing ground above the launch ground
  double highest = 0;       ///< m, largest rise
  bool is_reversible = false;  ///< the motion, reversed in time, leads back
  double duration = 0;         ///< s, expected
  /// How far the pelvis gets from the ground (ManoeuvreBounds); none: not known.
  std::optional<FlightBounds> flight;
  /// If set, it is a manoeuvre only where an obstacle lies in this space.
  std::optional<CrossedSpace> over;
};

/// A manoeuvre that is the same everywhere: it leads to the stance at a fixed displacement, and
/// its motion depends on nothing but the rise. The conditions, the search for launches and
/// landings, and the bounds follow from the shape. Launches are sought square to the edges of the
/// ground, or, if it leads over obstacles, square to those and with each in the middle of the
/// space.
class FixedManoeuvre final : public Manoeuvre {
 public:
  /// The motion from the nominal stance at the origin on ground at z = 0, at rest, to the displaced
  /// one on ground at z = `rise` (m), at rest; times from 0. Called from any thread; by jobs once
  /// per rise. Throws MotionError if there is no motion, and Cancelled.
  using MotionAtOrigin =
      std::function<std::vector<Phase>(double rise, const CancellationToken& cancellation)>;

  /// @throws std::invalid_argument if it is reversible and ends in another gait.
  FixedManoeuvre(const PlanningContext& context, FixedManoeuvreShape shape, MotionAtOrigin motion);

  /// As expected.
  double GreatestSpeed() const override;

  using Manoeuvre::CN;
  bool CN(const graph::Edge& edge) const override;
  graph::Point ExtendTowards(const graph::Point& v0, const graph::Point& v1) const override;
  graph::Point ReverseExtend(const graph::Point& v0, const graph::Point& v1) const override;
  std::optional<graph::Point> FindLaunchPoint(const graph::Point& v,
                                              const graph::Point& v1) const override;
  std::optional<graph::Point> FindLandingPoint(const graph::Point& v,
                                               const graph::Point& v1) const override;
  double ExpectedDuration(const graph::Edge&) const override { return shape_.duration; }
  /// The motion at the origin, for all jobs of its rise.
  bool Prepare(const graph::Edge& edge, graph::JobControl* job) const override;
  std::vector<Phase> Motion(const graph::Edge& edge,
                            const CancellationToken& cancellation) const override;
  ManoeuvreBounds Bounds() const override;
  /// Excludes the rise of the edge.
  void RefuteEverywhere(const graph::Edge& edge) override;

  const FixedManoeuvreShape& shape() const { return shape_; }

 private:
  /// An edge as an execution of the motion.
  struct Execution {
    GroundedStance launch;     ///< where the motion begins, forwards in time
    double rise = 0;           ///< m
    bool is_reversed = false;  ///< in time
  };
  /// What is known of a rise.
  struct Outcome {
    std::vector<Phase> motion;  ///< at the origin
    std::string fault;          ///< why there is none; empty if there is one
  };
  /// An obstacle that is low and thin enough to be led over, seen along one of its sides' headings.
  struct Crossable {
    double heading = 0;          ///< rad
    Eigen::AlignedBox3d bounds;  ///< in the world turned to that heading
  };
  enum class End { kLaunch, kLanding };

  std::optional<Execution> AsExecution(const graph::Edge& edge) const;
  std::optional<Execution> Forwards(const GroundedStance& launch,
                                    const GroundedStance& landing) const;
  std::vector<Crossable> FindCrossables() const;
  /// Whether a motion from `launch` leads over an obstacle, if it has to.
  bool Crosses(const GroundedStance& launch) const;
  bool Holds(const GroundedStance& stance) const;
  /// Displacements from a stance at `end` of an edge to the other end. True: forwards.
  std::vector<bool> Directions(End end) const;
  std::optional<GroundedStance> StanceAt(End end, const graph::Point& v) const;
  /// The stance displaced from `stance`, or the one that it is displaced from. None if the ground
  /// does not hold at both, or if there is nothing to lead over.
  std::optional<GroundedStance> Displaced(const GroundedStance& stance, bool forwards) const;
  /// The other end of an edge of which `stance` is `end`, where it leads closer to `towards`.
  std::optional<GroundedStance> OtherEnd(const GroundedStance& stance, End end,
                                         const Eigen::Vector2d& towards) const;
  graph::Point Extended(End end, const graph::Point& v0, const graph::Point& v1) const;
  /// A stance that can be `end`, on the way from v towards v1: v itself if it can, or else AtAnEdge
  /// or AtAnObstacle.
  std::optional<graph::Point> StanceNear(End end, const graph::Point& v,
                                         const graph::Point& v1) const;
  /// The first one square to an edge of the ground.
  std::optional<GroundedStance> AtAnEdge(End end, const GroundedStance& stance,
                                         const Eigen::Vector2d& towards) const;
  /// The closest one square to an obstacle to be led over, beside which the stance is.
  std::optional<GroundedStance> AtAnObstacle(End end, const GroundedStance& stance,
                                             const Eigen::Vector2d& towards) const;
  std::optional<Outcome> KnownOutcome(std::int64_t rise) const;
  Outcome OutcomeOf(std::int64_t rise, const CancellationToken& cancellation) const;
  graph::SharedWork& WorkOf(std::int64_t rise) const;

  FixedManoeuvreShape shape_;
  MotionAtOrigin motion_;
  std::vector<double> headings_;                      ///< rad, square to the edges of the ground
  std::vector<Crossable> crossables_;                 ///< empty unless it leads over obstacles
  mutable std::mutex mutex_;                          ///< of what follows
  mutable std::map<std::int64_t, Outcome> outcomes_;  ///< by rise in nm
  std::set<std::int64_t> refuted_;                    ///< rises in nm
  /// Finds the outcomes that jobs wait for. Last, because it uses the rest until it ends.
  mutable std::map<std::int64_t, std::unique_ptr<graph::SharedWork>> works_;
};

}  // namespace possibility::actions
