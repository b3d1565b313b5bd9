#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "actions/plan/contact_name.h"
#include "actions/plan/plan.h"
#include "dynamics/tree/tree_kinematics.h"
#include "models/robot/robot_model.h"

namespace possibility::actions::testing {

/// Share of the weight on a contact of a phase at a knot.
inline double LoadOf(const models::RobotModel& robot, const Phase& phase, const Knot& knot,
                     const std::string& contact) {
  const std::vector<BearingPatch> patches = BearingPatches(robot, phase);
  Eigen::Index first = 0;
  for (std::size_t i = 0; i < patches.size(); ++i) {
    const auto count = static_cast<Eigen::Index>(patches[i].points.size());
    if (phase.contacts[i] == contact) {
      return knot.forces.row(2).segment(first, count).sum() /
             (robot.TotalMass() * dynamics::kGravity);
    }
    first += count;
  }
  return 0;
}

inline bool Bears(const Phase& phase, const std::string& name) {
  return std::find(phase.contacts.begin(), phase.contacts.end(), name) != phase.contacts.end();
}

/// Greatest share of the weight on a contact right before it lifts or right after it has come down.
inline double GreatestLoadAtContactChanges(const models::RobotModel& robot,
                                           const std::vector<Phase>& motion) {
  double greatest = 0;
  for (std::size_t i = 0; i + 1 < motion.size(); ++i) {
    const Phase& before = motion[i];
    const Phase& after = motion[i + 1];
    for (const std::string& name : before.contacts) {
      if (Bears(after, name)) continue;
      greatest = std::max(greatest, LoadOf(robot, before, before.knots.back(), name));
    }
    for (const std::string& name : after.contacts) {
      if (Bears(before, name)) continue;
      greatest = std::max(greatest, LoadOf(robot, after, after.knots.front(), name));
    }
  }
  return greatest;
}

/// Greatest change of a joint's torque between the end of one phase and the start of the next, N m.
inline double GreatestTorqueStep(const std::vector<Phase>& motion) {
  double greatest = 0;
  for (std::size_t i = 0; i + 1 < motion.size(); ++i) {
    const auto step = motion[i + 1].knots.front().tau - motion[i].knots.back().tau;
    greatest = std::max(greatest, step.cwiseAbs().maxCoeff());
  }
  return greatest;
}

}  // namespace possibility::actions::testing
