#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/ode/ode_integrator.h"

namespace possibility::dynamics {

struct HybridMode;

/// The event that ends a mode.
struct HybridEvent {
  double time = 0;          ///< s
  int segment = 0;          ///< index of the segment that the event ends
  std::vector<int> guards;  ///< ascending: the guards of the segment's mode that fired
  Eigen::VectorXd before;
  Eigen::VectorXd after;  ///< the state after the reset; empty while the reset is called
};

/// Result of a reset map: how the rollout continues.
struct HybridTransition {
  std::shared_ptr<const HybridMode> mode;  ///< null: the rollout ends here
  Eigen::VectorXd state;                   ///< after the event; its size must suit `mode`
  std::string reason;                      ///< why the rollout ends, in words
};

/// One mode of a hybrid system: a flow, the guards that end it, and its reset map. Modes are made
/// on demand; there may be any number of them.
struct HybridMode {
  std::string name;
  OdeRate rate;
  std::vector<OdeGuard> guards;
  std::vector<std::string> guard_names;  ///< for messages; one per guard
  OdeGuardFunction guard_values;
  std::function<HybridTransition(const HybridEvent&)> reset;  ///< needed if there are guards
  OdeJacobian jacobian = {};                                  ///< as in OdeProblem
  int positions = 0;                                          ///< likewise
  OdeGuardValue guard_value = {};                             ///< likewise
};

struct HybridSettings {
  OdeSettings integration;
  /// Zeno behaviour: this many events within this many seconds.
  int zeno_events = 40;
  double zeno_time = 1e-3;  ///< s
  /// True: a Zeno rollout ends (HybridEnd::kZeno). False: it throws OdeError.
  bool end_at_zeno = false;
};

enum class HybridEnd { kTime, kReset, kZeno, kCancelled };

struct HybridSegment {
  std::shared_ptr<const HybridMode> mode;
  OdeTrajectory trajectory;
};

struct HybridRollout {
  HybridEnd end = HybridEnd::kTime;
  std::string reason;  ///< one line: why it ended
  double time = 0;     ///< s
  Eigen::VectorXd state;
  std::vector<HybridSegment> segments;
  std::vector<HybridEvent> events;
  OdeStatistics statistics;

  /// State at a time of the rollout. At an event: the state after it, or before it if it was the
  /// last event.
  /// @throws std::invalid_argument outside the rollout.
  Eigen::VectorXd State(double t) const;
  const HybridSegment& SegmentAt(double t) const;
};

/// Runs a hybrid system from a mode and state until a time, a reset that ends it or the stop
/// callback. A reset that changes neither mode nor state has only observed its guard, which then
/// fires again only after it has come back.
/// @throws what Integrate throws; std::invalid_argument for an inconsistent mode or transition.
HybridRollout RollOut(std::shared_ptr<const HybridMode> mode,
                      const Eigen::Ref<const Eigen::VectorXd>& state, double start_time,
                      double end_time, const HybridSettings& settings = {});

}  // namespace possibility::dynamics
