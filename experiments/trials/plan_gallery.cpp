#include "experiments/trials/plan_gallery.h"

#include "experiments/trials/experiment_run.h"
#include "models/input/file_contents.h"

namespace possibility::experiments {

PageSection PlanGallery(const std::vector<TrialGroup>& groups,
                        const std::filesystem::path& folder) {
  PageSection gallery{"Plans of the first seed", {}, "", {}, true};
  for (const TrialGroup& group : groups) {
    const std::filesystem::path file = PictureFile(folder, group.row, group.preset);
    if (!std::filesystem::is_regular_file(file)) continue;
    gallery.figures.push_back({group.row + ", " + group.preset, models::ReadFileContents(file)});
  }
  return gallery;
}

}  // namespace possibility::experiments
