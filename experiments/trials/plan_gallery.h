#pragma once

#include <filesystem>
#include <vector>

#include "experiments/report/experiment_page.h"
#include "experiments/trials/trial_groups.h"

namespace possibility::experiments {

/// The pictures that an experiment's folder has of its groups' first plans (PictureFile).
/// @throws InputError if one cannot be read.
PageSection PlanGallery(const std::vector<TrialGroup>& groups, const std::filesystem::path& folder);

}  // namespace possibility::experiments
