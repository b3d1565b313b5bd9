#pragma once

#include "experiments/bench/single_gait_search.h"
#include "experiments/peers/ompl_search.h"

namespace possibility::experiments {

/// The query of `search` in the peers' terms. `search` must outlive the result. Useful only if OMPL
/// is installed (POSSIBILITY_WITH_OMPL is defined).
inline PlanarQuery QueryOf(const SingleGaitSearch& search) {
  const auto plain = [](const actions::PlanarPose& p) { return PeerPose{p.x, p.y, p.yaw}; };
  const auto planar = [](const PeerPose& p) { return actions::PlanarPose{p.x, p.y, p.yaw}; };
  const Eigen::AlignedBox2d& bounds = search.scenario().environment.bounds;
  PlanarQuery query;
  query.start = plain(search.start());
  query.goal = plain(search.goal());
  query.low = {bounds.min().x(), bounds.min().y()};
  query.high = {bounds.max().x(), bounds.max().y()};
  query.rotation_weight = search.scenario().planner.rotation_weight;
  query.pose_is_valid = [&search, planar](const PeerPose& pose) {
    return search.IsValid(planar(pose));
  };
  query.motion_is_valid = [&search, planar](const PeerPose& from, const PeerPose& to) {
    return search.IsValid(planar(from), planar(to));
  };
  return query;
}

inline FoundPath PathOf(const PeerSearch& search) {
  FoundPath path{search.found, search.seconds, {}, {}};
  for (const PeerPose& pose : search.path) path.poses.push_back({pose.x, pose.y, pose.yaw});
  return path;
}

}  // namespace possibility::experiments
