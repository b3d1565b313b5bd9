#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace possibility::experiments {

struct PeerPose {
  double x = 0;    ///< m
  double y = 0;    ///< m
  double yaw = 0;  ///< rad
};

/// A planar path query, independent of any library. Some planners call both checks from several
/// threads at once.
struct PlanarQuery {
  PeerPose start;
  PeerPose goal;
  std::array<double, 2> low{};  ///< bounds of x and y, m
  std::array<double, 2> high{};
  double rotation_weight = 0.5;  ///< weight of a radian; a metre has 1 - rotation_weight
  std::function<bool(const PeerPose&)> pose_is_valid;
  /// Checks the straight way, the shorter one in yaw.
  std::function<bool(const PeerPose&, const PeerPose&)> motion_is_valid;
};

struct PeerSearch {
  bool found = false;
  double seconds = 0;          ///< to the first solution, or until the planner gave up
  std::vector<PeerPose> path;  ///< from start to goal; empty if not found
};

/// OMPL's available planners: RRTConnect, PRM, LazyPRM, ...
const std::vector<std::string>& OmplPlanners();

/// Runs a planner until its first solution. `range`: the longest motion it tries, in the metric of
/// the query; 0: the planner's default. Ignored by planners without a range. Deterministic for a
/// given seed, except for planners that depend on time (PRM does).
/// @throws std::invalid_argument if there is no such planner.
PeerSearch SolveWithOmpl(const std::string& planner, const PlanarQuery& query, std::uint32_t seed,
                         double time_limit, double range = 0);

}  // namespace possibility::experiments
