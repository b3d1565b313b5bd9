#include "actions/onboarding/assumed_inertials.h"

#include <fmt/format.h>

#include <set>

#include "actions/onboarding/shape_corners.h"
#include "actions/onboarding/visual_shapes.h"
#include "models/input/input_error.h"
#include "models/robot/mesh_shapes.h"
#include "models/shapes/convex_hull.h"

namespace possibility::actions {
namespace {

/// Why no body has this inertia, beginning with the link; empty if one has.
std::string Fault(const models::UrdfLink& link) {
  try {
    models::CheckMovingBody(*link.inertial, fmt::format("link '{}'", link.name));
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

class InertialRepair {
 public:
  InertialRepair(const std::vector<std::filesystem::path>& packages, RobotDraft* draft)
      : packages_(packages), draft_(*draft) {
    moving_.insert(draft_.tree.root);
    for (const models::UrdfJoint& joint : draft_.tree.joints) {
      if (joint.type != "fixed" && !draft_.plan.lump.contains(joint.name)) {
        moving_.insert(joint.child);
      }
    }
  }

  /// Whether there was something to repair.
  bool Run() {
    bool any = false;
    for (models::UrdfLink& link : draft_.tree.links) {
      if (!link.inertial || !(link.inertial->mass > 0)) continue;
      // A point mass may be part of a body that moves.
      if (link.inertial->I_LC.isZero(0) && !moving_.contains(link.name)) continue;
      const std::string fault = Fault(link);
      if (fault.empty()) continue;
      Repair(fault, &link);
      any = true;
    }
    return any;
  }

 private:
  void Repair(const std::string& fault, models::UrdfLink* link) {
    std::vector<models::PosedShape> shapes = ShapesOf(*link);
    if (shapes.empty()) {
      if (!shown_) shown_ = VisualTree(draft_);
      // Links keep their order.
      shapes = ShapesOf(shown_->links[link - draft_.tree.links.data()]);
    }
    if (shapes.empty()) {
      throw InputError(
          fmt::format("{}: {}; expected an <inertial> that a body can have, or a shape of the link "
                      "to take it from",
                      draft_.urdf_file.string(), fault));
    }
    models::Inertial& inertial = *link->inertial;
    const Eigen::Matrix3d spread = models::HullOfPoints(CornersOf(shapes)).Covariance();
    inertial.I_LC = inertial.mass * (spread.trace() * Eigen::Matrix3d::Identity() - spread);
    draft_.inertials.push_back({link->name, inertial, fault});
    draft_.warnings.push_back(
        fmt::format("{}: assumed that of its shapes' hull, solid, at the link's mass", fault));
  }

  std::vector<models::PosedShape> ShapesOf(const models::UrdfLink& link) const {
    models::RobotModel alone;
    alone.links.push_back({link.name, {}, link.shapes});
    models::PendingMeshes meshes;
    for (const models::UrdfMesh& mesh : link.meshes) meshes.emplace(0, mesh);
    models::AddMeshShapes(meshes, draft_.urdf_file, packages_, &alone);
    return alone.links[0].shapes;
  }

  const std::vector<std::filesystem::path>& packages_;
  RobotDraft& draft_;
  std::set<std::string> moving_;
  std::optional<models::UrdfTree> shown_;
};

}  // namespace

models::UrdfRobot BuildWithAssumedInertials(const std::vector<std::filesystem::path>& packages,
                                            RobotDraft* draft) {
  try {
    return models::BuildUrdfRobot(draft->tree, draft->plan.lump, draft->urdf_file);
  } catch (const InputError&) {
    if (!InertialRepair(packages, draft).Run()) throw;
  }
  return models::BuildUrdfRobot(draft->tree, draft->plan.lump, draft->urdf_file);
}

}  // namespace possibility::actions
