#pragma once

#include <unistd.h>

#include <filesystem>
#include <string>

#include "actions/checks/plan_torques.h"
#include "actions/plan/packed_writer.h"
#include "actions/plan/plan_reader.h"
#include "actions/refinement/plan_refinement.h"
#include "tests/actions/plan_mutations.h"

namespace possibility::actions::testing {

/// The plan as one of version 2.
inline VerifierSubject Refined(VerifierSubject subject) {
  subject.plan = RefinedPlan(subject.plan, subject.robot);
  return subject;
}

/// The plan as it reads back from a file of version 2, which has no torques that follow from the
/// rest. @throws as WritePackedPlan and ReadPlan do.
inline Plan Repacked(const models::RobotModel& robot, const Plan& plan) {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("repacked_" + std::to_string(::getpid()) + ".zip");
  WritePackedPlan(plan, file, TorquesToPack(robot, plan));
  Plan read = ReadPlan(file);
  CompleteTorques(robot, &read);
  std::filesystem::remove(file);
  return read;
}

}  // namespace possibility::actions::testing
