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

/// A search for a way in the plane, in the terms of nobody's library. Both checks are asked from
/// several threads at once by some planners.
struct PlanarQuery {
  PeerPose start;
  PeerPose goal;
  std::array<double, 2> low{};  ///< bounds of x and y, m
  std::array<double, 2> high{};
  double rotation_weight = 0.5;  ///< of a radian beside 1 - rotation_weight for a metre
  std::function<bool(const PeerPose&)> pose_is_valid;
  /// Of the straight way, the shorter one in yaw.
  std::function<bool(const PeerPose&, const PeerPose&)> motion_is_valid;
};

struct PeerSearch {
  bool found = false;
  double seconds = 0;          ///< to the first solution, or until the planner gave up
  std::vector<PeerPose> path;  ///< from start to goal; empty if not found
};

/// OMPL's planners that can be asked: RRTConnect, PRM, LazyPRM, ...
const std::vector<std::string>& OmplPlanners();

/// Asks one of them for any solution. `range`: the longest motion it tries, in the metric of the
/// query; 0 leaves it at what the planner takes by itself, and so does a planner that has none.
/// One seed gives the same answer from every planner that looks at no clock (PRM does).
/// @throws std::invalid_argument if there is no such planner.
PeerSearch SolveWithOmpl(const std::string& planner, const PlanarQuery& query, std::uint32_t seed,
                         double time_limit, double range = 0);

}  // namespace possibility::experiments
