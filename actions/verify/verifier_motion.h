#pragma once

#include <optional>
#include <vector>

#include "actions/checks/contacts_check.h"
#include "actions/checks/flight_check.h"
#include "actions/evidence/violation_log.h"
#include "actions/verify/verifier.h"
#include "models/world/ground_map.h"
#include "models/world/local_world.h"

namespace possibility::actions {

/// A plan of valid structure, with its contacts and flights.
struct VerifiedPlan {
  const Plan& plan;
  const models::RobotModel& robot;
  const models::Scenario& scenario;
  const models::GroundMap& ground;
  const models::LocalWorld& local_world;
  std::vector<PhaseContacts> contacts;         ///< by phase, over all segments
  std::vector<std::optional<Flight>> flights;  ///< likewise
};

/// Checks the motion at all knots and between them, on settings.threads threads. Sets the samples,
/// resolutions and `cancelled` of the report.
void VerifyMotion(const VerifiedPlan& subject, const VerifierSettings& settings, ViolationLog* log,
                  VerificationReport* report);

}  // namespace possibility::actions
