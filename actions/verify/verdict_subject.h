#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "actions/checks/contacts_check.h"
#include "actions/checks/flight_check.h"
#include "actions/plan/plan.h"
#include "actions/rollout/dynamic_stretch.h"
#include "models/robot/robot_model.h"

namespace possibility::actions {

/// A run of knot intervals of one phase, with what the verifier knows of the phase.
struct KnotRun {
  const Phase& phase;
  std::size_t begin = 0;  ///< first knot
  std::size_t end = 0;    ///< last knot
  const PhaseContacts& contacts;
  const std::optional<Flight>& flight;
};

/// Everything but the world that the checks of a run depend on, byte for byte. `resolution`: s.
std::string SubjectOf(const KnotRun& run, const models::RobotModel& robot, double resolution,
                      int plan_version);

/// Likewise for the simulation of a stretch.
std::string SubjectOf(const DynamicStretch& stretch, const models::RobotModel& robot);

/// Likewise for the margins of a phase.
std::string SubjectOf(const Phase& phase, const models::RobotModel& robot);

}  // namespace possibility::actions
