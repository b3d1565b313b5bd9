#pragma once

#include <optional>
#include <vector>

#include "actions/verify/verifier.h"
#include "actions/verify/verifier_contacts.h"
#include "actions/verify/verifier_flight.h"
#include "actions/verify/verifier_log.h"
#include "models/world/ground_map.h"

namespace possibility::actions {

/// A plan of sound structure, with what was found out about it as a whole.
struct VerifiedPlan {
  const Plan& plan;
  const models::RobotModel& robot;
  const models::Scenario& scenario;
  const models::GroundMap& ground;
  std::vector<PhaseContacts> contacts;         ///< by phase, over all segments
  std::vector<std::optional<Flight>> flights;  ///< likewise
};

/// Looks at the motion at all knots and between them, on settings.threads threads. Sets the
/// samples, resolutions and `abandoned` of the report.
void VerifyMotion(const VerifiedPlan& subject, const VerifierSettings& settings, ViolationLog* log,
                  VerificationReport* report);

/// Runs `work` on as many threads as wanted, this one included.
void RunOnThreads(int threads, const std::function<void()>& work);

}  // namespace possibility::actions
