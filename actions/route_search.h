#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "actions/locomotion_model.h"
#include "actions/manoeuvre.h"
#include "actions/quasi_static_action.h"
#include "graph/find_path.h"

namespace possibility::actions {

/// What a search for a route may use. All of it outlives the search.
struct RouteSearchSpace {
  const LocomotionModel* model = nullptr;
  const std::vector<std::shared_ptr<QuasiStaticAction>>* gaits = nullptr;  ///< by gait
  const std::vector<std::shared_ptr<Manoeuvre>>* manoeuvres = nullptr;
};

struct RouteSearchSettings {
  double step = 0.3;                  ///< m, from stance to stance
  int headings = 16;                  ///< that the circle is divided into
  double greed = 2;                   ///< weight of the distance that is left; 1: shortest routes
  std::int64_t most_stances = 20000;  ///< examined, after which the search gives up
};

/// A route from `start` to any of `goals` on which every stance meets C_S, every straight way and
/// every transition too, and every edge of a manoeuvre is worth a confirmation job: found by
/// weighted hybrid A* (Dolgov, Thrun, Montemerlo & Diebel 2010) over gait, place and heading, with
/// strides for primitives and ways tested only when their turn comes. Actions are numbered as the
/// planner does: gaits, then manoeuvres. Empty if there is none at this resolution, which proves
/// nothing. `keep_going` (may be empty): asked at every stance; false gives up.
std::vector<graph::PathEdge> SearchRoute(const RouteSearchSpace& space, const GroundedStance& start,
                                         const std::vector<GroundedStance>& goals,
                                         const RouteSearchSettings& settings,
                                         const std::function<bool()>& keep_going);

}  // namespace possibility::actions
