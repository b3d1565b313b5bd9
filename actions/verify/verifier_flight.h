#pragma once

#include <optional>
#include <vector>

#include "actions/verify/verifier_log.h"
#include "actions/verify/verifier_state.h"

namespace possibility::actions {

/// What a robot that touches nothing cannot change, as it was when it left the ground.
struct Flight {
  double start = 0;                                            ///< s
  Eigen::Vector3d position = Eigen::Vector3d::Zero();          ///< of the centre of mass, m
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();          ///< likewise, m/s
  Eigen::Vector3d angular_momentum = Eigen::Vector3d::Zero();  ///< about it, kg m^2/s
};

/// By phase, over all segments; none where something bears. Phases of flight that follow each
/// other are one flight.
std::vector<std::optional<Flight>> FollowFlights(const Plan& plan, StateEvaluator* evaluator);

/// The centre of mass is on its parabola, and the angular momentum about it what it was.
/// `dynamics` stands at `state`.
void CheckFlight(const VerifierState& state, const Flight& flight, const models::RobotModel& robot,
                 const dynamics::SimbodyDynamics& dynamics, const Instant& at, ViolationLog* log);

}  // namespace possibility::actions
