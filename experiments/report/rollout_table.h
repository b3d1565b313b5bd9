#pragma once

#include <string>
#include <vector>

#include "actions/plan/plan.h"
#include "actions/rollout/perturbed_rollouts.h"
#include "experiments/report/text_table.h"

namespace possibility::experiments {

/// One row a perturbation: who falls or slips, when, and the worst deviations of all stretches.
/// `names`: of the perturbations, empty for none.
TextTable RolloutTable(const actions::Plan& plan, const std::vector<std::string>& names,
                       const std::vector<actions::PerturbedRollout>& rollouts);

}  // namespace possibility::experiments
