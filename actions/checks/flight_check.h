#pragma once

#include <optional>
#include <vector>

#include "actions/evidence/verifier_state.h"
#include "actions/evidence/violation_log.h"

namespace possibility::actions {

/// Flight invariants at take-off.
struct Flight {
  double start = 0;                                            ///< s
  Eigen::Vector3d position = Eigen::Vector3d::Zero();          ///< of the centre of mass, m
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();          ///< likewise, m/s
  Eigen::Vector3d angular_momentum = Eigen::Vector3d::Zero();  ///< about it, kg m^2/s
};

/// By phase, over all segments; none in stance. Consecutive phases of flight are one flight.
std::vector<std::optional<Flight>> FollowFlights(const Plan& plan, StateEvaluator* evaluator);

/// Checks that the centre of mass is on its parabola, and that the angular momentum about it is
/// conserved. `dynamics` must be at `state`.
void CheckFlight(const VerifierState& state, const Flight& flight, const models::RobotModel& robot,
                 const dynamics::SimbodyDynamics& dynamics, const Instant& at, ViolationLog* log);

}  // namespace possibility::actions
