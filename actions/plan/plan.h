#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "models/robot/contact_schedule.h"

namespace possibility::actions {

/// Format names in plan files (docs/file_formats.md).
inline constexpr const char* kPlanFormat = "possibility-plan/1";
inline constexpr const char* kPackedPlanFormat = "possibility-plan/2";

/// State of the whole robot at one instant. Conventions of q, v, a: models::RobotModel.
struct Knot {
  double t = 0;             ///< s since the start of the plan
  Eigen::VectorXd q;        ///< nq
  Eigen::VectorXd v;        ///< nv
  Eigen::VectorXd a;        ///< nv
  Eigen::VectorXd tau;      ///< num_joints, N m or N
  Eigen::Matrix3Xd forces;  ///< on the robot at every contact point of the phase, world, N
};

/// A stretch of time with one set of contacts. Consecutive phases share an instant: the last knot
/// of one and the first of the next have the same t, q and, unless an impact lies between them, v;
/// a, tau and forces may jump.
struct Phase {
  /// Bearing contact patches, in the order of the columns of Knot::forces: a patch with all its
  /// points ("left_sole") or some of them ("left_sole[0,3]"). Empty: flight.
  std::vector<std::string> contacts;
  std::vector<Knot> knots;  ///< at least two, strictly increasing in t
  /// Impulses of the impact at the start of the phase, on the robot at every contact point, world,
  /// N s, in the order of Knot::forces. No columns: no impact.
  Eigen::Matrix3Xd impulses = Eigen::Matrix3Xd(3, 0);
  /// In a file of version 2, accelerations are multiples of 2^-this (m/s^2, rad/s^2), and rates and
  /// positions correspondingly fine.
  int acceleration_bits = 12;
};

/// One executed edge of the route.
struct Segment {
  std::string action;  ///< "walk", "crawl", "walk->crawl", ...
  std::vector<Phase> phases;
  /// Start and end vertex of the edge in ExploredGraph; -1: not in the graph, such as a pause.
  std::array<int, 2> vertices = {-1, -1};
};

/// Whether the robot flies or hits the ground.
bool HasFlightOrImpact(const Phase& phase);
bool HasFlightOrImpact(const Segment& segment);

/// The explored graph Gamma_PG without its refuted edges; for reports and pictures.
struct ExploredGraph {
  struct Vertex {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< pelvis, m
    double yaw = 0;
  };
  struct Edge {
    int from = 0;
    int to = 0;
    std::string action;
  };
  std::vector<Vertex> vertices;
  std::vector<Edge> edges;
};

/// Upper bound of the region that an action can reach from the start, seen from above.
struct ReachedRegion {
  std::string action;  ///< empty: the pelvis alone, by any motion
  double z = 0;        ///< height of the ground, m
  /// Polygons, m: counter-clockwise around parts, clockwise around holes.
  std::vector<std::vector<Eigen::Vector2d>> outlines;
};

/// The barrier between the start and all goals.
struct Barrier {
  Eigen::Vector2d closest = Eigen::Vector2d::Zero();  ///< reached point closest to any goal, m
  double distance = 0;                                ///< of `closest` from that goal, m
  /// Names of the shapes that block the way beyond `closest`, or "no ground"; empty: the bounds.
  std::vector<std::string> closed_by;
  std::vector<ReachedRegion> reached;
};

/// Dimension in which a passage may be too small.
enum class PassageDimension { kWidth, kHeight, kGap };

/// "width", "height", "gap": the words of plan.json.
std::string ToString(PassageDimension dimension);

/// Available and needed size of one dimension of a passage, for one action.
struct PassageNeed {
  std::string action;  ///< a gait, or for a gap a manoeuvre; empty if none
  PassageDimension dimension = PassageDimension::kWidth;
  double available = 0;  ///< m: width, height above the ground, or length without ground
  double needed = 0;     ///< m; for a gap: the length that the action can cross
};

/// The narrowest place on the way of a flood over C_S, or of one with relaxed needs.
struct NarrowPassage {
  Eigen::Vector2d place = Eigen::Vector2d::Zero();  ///< m, seen from above
  double missing = 0;                     ///< m, for the action that fits best; negative: margin
  std::vector<std::string> between = {};  ///< names of the shapes there, or "no ground"
  std::vector<PassageNeed> needs = {};
};

/// The answer "no" and its explanation.
struct NoPlan {
  std::string status;       ///< "proven_infeasible", "exhausted" or "time_limit"
  std::string explanation;  ///< one paragraph
  std::optional<Barrier> barrier;
  std::optional<NarrowPassage> passage = {};
};

struct PlanTimings {
  double preparation_s = 0;   ///< nominal stances, swept volumes, ground map
  double graph_s = 0;         ///< until every edge of the first route was confirmed
  double confirmation_s = 0;  ///< in confirmation jobs
  double motion_s = 0;        ///< search for a quicker route and motion generation
  double verification_s = 0;
};

/// How the route was found: the explorers of its edges, and the gain over the first route.
struct SearchReport {
  std::vector<std::string>
      explorers;              ///< that found edges of the route: "straight", "lattice", ...
  double first_duration = 0;  ///< expected, of the first confirmed route, s
  double duration = 0;        ///< expected, of the route, s
  double lower_bound = 0;     ///< of the duration within the searched space, s; 0: unknown
};

/// Result of `possibility plan` (docs/file_formats.md).
struct Plan {
  /// Of the file format, 1 or 2. The motion of version 2 obeys the dynamics between knots to 1e-6
  /// of the weight, which the verifier requires of it.
  int version = 1;
  int force_bits = 14;  ///< in a file of version 2, forces are multiples of 2^-this, N
  std::filesystem::path robot_file;
  std::string robot_hash;
  std::filesystem::path scenario_file;
  std::string scenario_hash;
  std::uint64_t seed = 0;
  int goal = 0;  ///< index of the goal reached
  PlanTimings timings;
  std::map<std::string, std::int64_t> statistics;
  std::vector<std::string> joints;  ///< names, in the order of q[7...], v[6...] and tau
  std::vector<Segment> segments;
  std::optional<models::ContactSchedule>
      schedule;  ///< of all segments; absent if the plan file has none
  ExploredGraph explored;
  std::optional<SearchReport> search;  ///< absent if the plan file has none
  std::optional<NoPlan> no;            ///< instead of segments

  double duration() const;  ///< s
};

/// q, v, a between two knots of one phase: the quintic Hermite interpolant in time of position,
/// joints and the rotation vector phi with R(t) = exp(phi(t)) R(knot0); it matches q, v and a at
/// both knots. tau and forces are interpolated linearly. `t` within [k0.t, k1.t]. Part of the file
/// format: it defines the motion between knots.
Knot Interpolate(const Knot& k0, const Knot& k1, double t);

/// ReadPlan (plan_reader.h) for the bytes of a plan. `file` need not exist: it appears in messages,
/// and paths in the text are resolved against its folder.
Plan ParsePlan(const std::string& text, const std::filesystem::path& file);

}  // namespace possibility::actions
