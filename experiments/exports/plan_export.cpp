#include "experiments/exports/plan_export.h"

#include <fmt/format.h>

#include <stdexcept>

#include "actions/checks/plan_torques.h"
#include "actions/plan/packed_writer.h"
#include "actions/plan/plan_writer.h"
#include "actions/refinement/plan_refinement.h"
#include "models/input/input_error.h"

namespace possibility::experiments {

void WritePlanFile(const ExportSubject& subject, const ExportSampling& sampling,
                   const std::filesystem::path& file) {
  if (!actions::IsPackedPlanName(file)) return actions::WritePlan(subject.plan, file);
  try {
    const actions::Plan refined = actions::RefinedPlan(subject.plan, subject.robot);
    actions::WritePackedPlan(refined, file,
                             sampling.torques ? actions::PackedTorques::kStored
                                              : actions::TorquesToPack(subject.robot, refined));
  } catch (const std::invalid_argument& error) {
    throw InputError(fmt::format("{}: {}, expected a plan of finite numbers up to 1e6",
                                 file.string(), error.what()));
  }
}

}  // namespace possibility::experiments
