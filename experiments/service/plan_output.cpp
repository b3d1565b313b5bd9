#include "experiments/service/plan_output.h"

#include <system_error>

#include "actions/checks/plan_torques.h"
#include "actions/plan/packed_writer.h"
#include "experiments/support/output_file.h"
#include "experiments/viewer/viewer_page.h"

namespace possibility::experiments {
namespace {

constexpr const char* kPlain = "plan.json";
constexpr const char* kPacked = "plan.zip";

}  // namespace

PlanFiles PlanFilesIn(const std::filesystem::path& folder, int plan_version) {
  return {folder / (plan_version == 2 ? kPacked : kPlain), folder / "plan.html"};
}

void WriteOnlyPlan(const actions::Plan& plan, const models::RobotModel& robot,
                   const PlanFiles& files) {
  actions::WritePlanAs(plan, files.plan, actions::TorquesToPack(robot, plan));
  std::error_code ignored;  // mostly there is none
  const char* other = files.plan.filename() == kPlain ? kPacked : kPlain;
  std::filesystem::remove(files.plan.parent_path() / other, ignored);
}

void WritePage(const actions::Plan& plan, const models::RobotModel& robot,
               const models::Scenario& scenario, const PlanFiles& files) {
  WriteOutput(files.page, ViewerPage(plan, robot, scenario));
}

}  // namespace possibility::experiments
