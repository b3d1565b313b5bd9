#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace possibility::actions {

/// What plan files call their format.
inline constexpr const char* kPlanFormat = "possibility-plan/1";

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
  /// What bears on the ground, in the order of the columns of Knot::forces: a patch with all its
  /// points ("left_sole") or some of them ("left_sole[0,3]"). None: the robot flies.
  std::vector<std::string> contacts;
  std::vector<Knot> knots;  ///< at least two, strictly increasing in t
  /// Of the impact that this phase begins with: on the robot at every contact point, world, N s,
  /// in the order of Knot::forces. No columns: no impact.
  Eigen::Matrix3Xd impulses = Eigen::Matrix3Xd(3, 0);
};

/// One executed edge of the route.
struct Segment {
  std::string action;  ///< "walk", "crawl", "walk->crawl", ...
  std::vector<Phase> phases;
  /// Of ExploredGraph, where the edge begins and ends; -1: it is not in the graph, as a pause.
  std::array<int, 2> vertices = {-1, -1};
};

/// The explored graph Gamma_PG, as far as its edges were not refuted; for reports and pictures.
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

/// Where an action may get to from the start, seen from above: no way leads farther than this.
struct ReachedRegion {
  std::string action;  ///< empty: the pelvis alone, whatever the robot does
  double z = 0;        ///< of the ground, m
  /// Polygons, m: around every part counter-clockwise, around every hole in it clockwise.
  std::vector<std::vector<Eigen::Vector2d>> outlines;
};

/// What lies between the start and all goals.
struct Barrier {
  Eigen::Vector2d closest = Eigen::Vector2d::Zero();  ///< reached, to any goal, m
  double distance = 0;                                ///< of `closest` from that goal, m
  /// Names of the shapes that close the way on from there, or "no ground"; none: the bounds.
  std::vector<std::string> closed_by;
  std::vector<ReachedRegion> reached;
};

/// What a passage may be short of.
enum class PassageDimension { kWidth, kHeight, kGap };

/// "width", "height", "gap": the words of plan.json.
std::string ToString(PassageDimension dimension);

/// How much there is of a dimension, and how much an action needs.
struct PassageNeed {
  std::string action;  ///< a gait, or of a gap a manoeuvre; empty if there is none
  PassageDimension dimension = PassageDimension::kWidth;
  double available = 0;  ///< m, between both sides or over the ground; of a gap: without ground
  double needed = 0;     ///< m; of a gap: that the action reaches over
};

/// The narrowest place on the way that a flood over C_S takes, or would take if less were asked.
struct NarrowPassage {
  Eigen::Vector2d place = Eigen::Vector2d::Zero();  ///< m, seen from above
  double missing = 0;  ///< m, for the action that gets on best there; negative: to spare
  std::vector<std::string> between = {};  ///< names of what stands there, or "no ground"
  std::vector<PassageNeed> needs = {};
};

/// The answer "no", with what there is to say for it.
struct NoPlan {
  std::string status;       ///< "proven_infeasible", "exhausted" or "time_limit"
  std::string explanation;  ///< one paragraph
  std::optional<Barrier> barrier;
  std::optional<NarrowPassage> passage = {};
};

struct PlanTimings {
  double preparation_s = 0;   ///< nominal stances, swept volumes, ground map
  double graph_s = 0;         ///< until every edge of the first route was confirmed
  double confirmation_s = 0;  ///< spent in confirmation jobs
  double motion_s = 0;        ///< looking for a quicker route and generating its motion
  double verification_s = 0;
};

/// How the route was found: whose edges it is made of, and what was gained after the first route.
struct SearchReport {
  std::vector<std::string>
      explorers;              ///< that found edges of the route: "straight", "lattice", ...
  double first_duration = 0;  ///< expected, of the first confirmed route, s
  double duration = 0;        ///< expected, of the route, s
  double lower_bound = 0;     ///< nothing searched takes less, s; 0: none is known
};

/// What `possibility plan` finds (format possibility-plan/1, docs/file_formats.md).
struct Plan {
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
  ExploredGraph explored;
  std::optional<SearchReport> search;  ///< absent in plans that say nothing of it
  std::optional<NoPlan> no;            ///< instead of segments

  double duration() const;  ///< s
};

/// q, v, a between two knots of one phase: the quintic Hermite interpolant in time of position
/// and joints, and of the rotation vector phi with R(t) = exp(phi(t)) R(knot0), which matches q,
/// v and a at both knots. `t` within [k0.t, k1.t]. Part of the file format: this is what a plan
/// *means* between its knots. tau and forces are interpolated linearly.
Knot Interpolate(const Knot& k0, const Knot& k1, double t);

/// The same for the contents of `file`, which need not exist.
Plan ParsePlan(const std::string& text, const std::filesystem::path& file);

}  // namespace possibility::actions
