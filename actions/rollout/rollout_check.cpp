#include "actions/rollout/rollout_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>

#include "dynamics/rollout/robot_rollout.h"

namespace possibility::actions {
namespace {

using Eigen::VectorXd;

/// Within 1 ms. Many points that share little load come and go in bursts of tens of events.
constexpr int kZenoEvents = 1000;

/// m. Feet that lift off jam for milliseconds in a simulation that knows no sliding; held, they
/// would drag the robot down.
constexpr double kJamDepth = 2e-4;

dynamics::RobotRolloutSettings SimulatorSettings(const RolloutCheckSettings& check,
                                                 const dynamics::MultibodyModel& model) {
  dynamics::RobotRolloutSettings settings;
  settings.touching = kTouching;
  settings.jam_depth = kJamDepth;
  settings.utilisation_interval =
      check.measures_torque ? check.sample_time : std::numeric_limits<double>::infinity();
  dynamics::OdeSettings& integration = settings.hybrid.integration;
  integration.relative_tolerance = check.tolerance;
  integration.absolute_tolerances.resize(model.nq() + model.nv());
  integration.absolute_tolerances << VectorXd::Constant(model.nq(), check.tolerance),
      VectorXd::Constant(model.nv(), check.velocity_tolerance);
  integration.cancellation = check.cancellation;
  settings.hybrid.end_at_zeno = true;
  settings.hybrid.zeno_events = kZenoEvents;
  return settings;
}

void Compare(const RolloutReference& reference, const dynamics::RobotRollout& rollout,
             const RolloutCheckSettings& settings, RolloutDrift* drift) {
  const double end = std::min(drift->end, rollout.time);
  const auto samples = static_cast<int>(std::ceil((end - drift->start) / settings.sample_time));
  for (int i = 0; i <= samples; ++i) {
    const double t = std::min(end, drift->start + i * settings.sample_time);
    reference.Compare(t, rollout.Configuration(t), drift);
  }
  reference.CompareEnd(rollout.Configuration(rollout.time), rollout.Velocity(rollout.time), drift);
  if (settings.measures_torque) drift->torque_used = rollout.torque_utilisation.maxCoeff();
  for (const dynamics::RobotContactEvent& event : rollout.events) {
    drift->impacts += event.energy_lost > 0 ? 1 : 0;
  }
}

void Simulate(const RolloutReference& reference, const RolloutCheckSettings& settings,
              RolloutDrift* drift) {
  drift->ends_at_rest = reference.ends_at_rest();
  dynamics::RobotSimulator simulator(reference.model(), reference.Contacts(), reference.Control(),
                                     SimulatorSettings(settings, *reference.model()));
  const double end = drift->end + (drift->ends_at_rest ? settings.settling_time : 0);
  const dynamics::RobotRollout rollout = simulator.Run(
      reference.Configuration(drift->start), reference.Velocity(drift->start), drift->start, end);
  Compare(reference, rollout, settings, drift);
  if (rollout.time < end) {
    drift->failure = fmt::format("ends at {:.3f} s: {}", rollout.time, rollout.reason);
  }
}

}  // namespace

RolloutDrift RollOutSegment(const Segment& segment, const models::RobotModel& robot,
                            const models::GroundMap& ground, const RolloutCheckSettings& settings) {
  RolloutDrift drift;
  drift.start = segment.phases.front().knots.front().t;
  drift.end = segment.phases.back().knots.back().t;
  try {
    Simulate(RolloutReference(segment, robot, ground, {}, settings.gains), settings, &drift);
  } catch (const std::exception& error) {
    drift.failure = error.what();
  }
  return drift;
}

}  // namespace possibility::actions
