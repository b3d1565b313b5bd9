#pragma once

#include <filesystem>

#include "actions/plan/plan.h"
#include "actions/planner/planner.h"
#include "experiments/report/plan_summary.h"
#include "models/robot/robot_model.h"
#include "models/world/scenario.h"

namespace possibility::experiments {

/// Where the files of a plan of this version are in a folder.
PlanFiles PlanFilesIn(const std::filesystem::path& folder, int plan_version);

/// Writes the plan in its format, by rename. A plan of the other format beside it is of an older
/// run, would be read in its place, and is removed.
/// @throws InputError if the file cannot be written.
void WriteOnlyPlan(const actions::Plan& plan, const models::RobotModel& robot,
                   const PlanFiles& files);

/// Writes the page. @throws InputError likewise.
void WritePage(const actions::Plan& plan, const models::RobotModel& robot,
               const models::Scenario& scenario, const PlanFiles& files);

}  // namespace possibility::experiments
