#pragma once

#include <filesystem>
#include <vector>

#include "experiments/report/experiment_page.h"
#include "experiments/trials/trial_groups.h"

namespace possibility::experiments {

/// The pictures of the groups' first plans in an experiment's folder (PictureFile).
/// @throws InputError if a picture cannot be read.
PageSection PlanGallery(const std::vector<TrialGroup>& groups, const std::filesystem::path& folder);

}  // namespace possibility::experiments
