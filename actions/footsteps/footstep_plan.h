#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "actions/conditions/locomotion_model.h"
#include "actions/conditions/quasi_static_action.h"
#include "actions/footholds/footstep.h"
#include "actions/footholds/step_ground.h"
#include "common/cancellation_token.h"

namespace possibility::actions {

/// Where a search for steps begins and may end: stances of its gait.
struct FootstepEnds {
  std::vector<GroundedStance> starts;
  std::vector<GroundedStance> goals;
  /// By start, s: how long it takes to get there. Empty: all 0.
  std::vector<double> start_times;
  /// By goal, s: how long it takes from there on. A goal from which steps to another one would be
  /// quicker is only an answer if that one is not reached. Empty: all 0.
  std::vector<double> goal_times;
};

/// Searches sequences of steps of a gait over ground of any heights, from one nominal stance to
/// another: weighted A* (Pohl 1970) over the places of all limbs, which move in turn; of more than
/// two one may be passed over. What it finds is no motion yet; it knows the ground, the free space
/// about feet and trunk, and the limbs' reach. One search per thread.
class FootstepSearch {
 public:
  static constexpr int kMostLimbs = 4;
  /// Whether steps of the gait can be searched: two soles, or three or four limbs of any kind.
  static bool Knows(const models::Gait& gait);

  /// `known`: of this gait and world, and of such limits; shared by many searches. References must
  /// outlive the search.
  FootstepSearch(const LocomotionModel& model, int gait, const World& world, FootstepEnds ends,
                 const FootstepLimits& limits, std::shared_ptr<const StepGround> known,
                 const CancellationToken& cancellation = {});
  /// From one start, by itself.
  FootstepSearch(const LocomotionModel& model, int gait, const World& world,
                 const GroundedStance& start, const std::vector<GroundedStance>& goals,
                 const FootstepLimits& limits, const CancellationToken& cancellation = {});
  ~FootstepSearch();

  enum class Status { kSearching, kFound, kExhausted };
  /// Expands up to `states` states. Exhausted when no state is left, or `most_states` have been
  /// expanded in all. @throws Cancelled.
  Status Advance(std::int64_t states, const CancellationToken& cancellation = {});

  const std::vector<Footstep>& steps() const { return steps_; }  ///< once found
  int goal() const { return goal_; }                             ///< index; once found
  const GroundedStance& start() const { return start_; }         ///< of the steps; once found
  std::int64_t states() const;                                   ///< expanded so far
  bool ProvesNone() const;  ///< once exhausted: there is a proof that no steps exist

  /// A step from a limb's place to another one, with its lift, while the others bear. `feet`: where
  /// all limbs are before it. None if the limb does not reach, or hits another one or an obstacle.
  std::optional<Footstep> StepBetween(const std::vector<Foothold>& feet, int limb,
                                      const Foothold& to) const;

  std::int64_t most_states = 8000;
  /// Steps that must not be taken. `rest`: where the other limbs bear meanwhile (RestOf).
  std::function<bool(const Footstep& step, const Foothold& rest)> is_refused;

 private:
  struct Search;

  Status Answer(int node, int goal);
  /// Of all goals that were reached the best one, if there is any.
  Status Exhausted();

  std::unique_ptr<Search> search_;
  std::vector<Footstep> steps_;
  GroundedStance start_;
  int goal_ = -1;
};

}  // namespace possibility::actions
