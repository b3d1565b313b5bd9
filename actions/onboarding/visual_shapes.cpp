#include "actions/onboarding/visual_shapes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <vector>

namespace possibility::actions {
namespace {

bool HasShape(const models::UrdfRobot& built, int link) {
  return !built.robot.links[link].shapes.empty() || built.meshes.contains(link);
}

}  // namespace

models::UrdfTree VisualTree(const RobotDraft& draft) {
  models::UrdfTree tree = draft.tree;
  // Both trees' links are sorted by name.
  const models::UrdfTree shown =
      models::ParseUrdf(draft.urdf, draft.urdf_file, models::UrdfGeometry::kVisual);
  for (std::size_t i = 0; i < tree.links.size(); ++i) {
    tree.links[i].shapes = shown.links[i].shapes;
    tree.links[i].meshes = shown.links[i].meshes;
  }
  return tree;
}

void AddVisualShapes(RobotDraft* draft, models::UrdfRobot* built) {
  const auto is_covered = [&](const models::LimbChain& leg) {
    return HasShape(*built, built->robot.LinkIndex(leg.tip));
  };
  if (is_covered(draft->plan.left_leg) && is_covered(draft->plan.right_leg)) return;
  const models::UrdfRobot shown =
      models::BuildUrdfRobot(VisualTree(*draft), draft->plan.lump, draft->urdf_file);
  std::vector<std::string> names;
  for (int link = 0; link < built->robot.num_links(); ++link) {
    if (HasShape(*built, link) || !HasShape(shown, link)) continue;
    names.push_back(built->robot.links[link].name);
    built->robot.links[link].shapes = shown.robot.links[link].shapes;
    const auto [begin, end] = shown.meshes.equal_range(link);
    built->meshes.insert(begin, end);
  }
  if (names.empty()) return;
  draft->warnings.push_back(
      fmt::format("a foot has no collision shape: what is seen stands for what collides, of {}",
                  fmt::join(names, ", ")));
}

}  // namespace possibility::actions
