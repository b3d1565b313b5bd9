#include "experiments/viewer/robot_look.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "experiments/viewer/simpler_mesh.h"
#include "models/input/input_error.h"
#include "models/mesh/mesh_reader.h"
#include "models/robot/mesh_path.h"
#include "models/robot/robot_yaml.h"

namespace possibility::experiments {
namespace {

models::TriangleMesh Scaled(models::TriangleMesh mesh, const Eigen::Vector3d& scale) {
  for (Eigen::Vector3d& vertex : mesh.vertices) vertex = vertex.cwiseProduct(scale);
  if (scale.prod() < 0) {  // mirrored: outside is on the other side
    for (auto& [a, b, c] : mesh.triangles) std::swap(b, c);
  }
  return mesh;
}

/// Meshes by file and scale, each once.
class MeshShelf {
 public:
  explicit MeshShelf(const models::RobotVisuals& visuals) : visuals_(visuals) {}

  /// Index of the mesh. @throws InputError.
  int IndexOf(const models::UrdfMesh& mesh, const std::string& owner) {
    const std::filesystem::path file =
        models::ResolveMeshPath(mesh.name, visuals_.urdf_file, visuals_.packages, owner);
    const std::array<double, 3> scale = {mesh.scale.x(), mesh.scale.y(), mesh.scale.z()};
    const auto key = std::pair(file, scale);
    const auto known = index_.find(key);
    if (known != index_.end()) return known->second;
    meshes_.push_back(Scaled(models::ReadMesh(file), mesh.scale));
    return index_[key] = static_cast<int>(meshes_.size()) - 1;
  }

  std::vector<models::TriangleMesh> Taken() { return std::move(meshes_); }

 private:
  const models::RobotVisuals& visuals_;
  std::vector<models::TriangleMesh> meshes_;
  std::map<std::pair<std::filesystem::path, std::array<double, 3>>, int> index_;
};

bool HasLinksOf(const models::RobotModel& robot, const models::RobotVisuals& visuals) {
  return std::equal(robot.links.begin(), robot.links.end(), visuals.links.begin(),
                    visuals.links.end(),
                    [](const models::Link& a, const models::Link& b) { return a.name == b.name; });
}

void AddMeshes(const models::RobotVisuals& visuals, RobotLook* look) {
  MeshShelf shelf(visuals);
  std::set<int> spoilt;
  for (const auto& [link, mesh] : visuals.meshes) {
    const std::string owner = fmt::format("link '{}'", visuals.links[link].name);
    try {
      look->links[link].meshes.push_back({shelf.IndexOf(mesh, owner), mesh.X_LM});
    } catch (const InputError& error) {
      spoilt.insert(link);
      look->faults.emplace_back(error.what());
    }
  }
  for (const int link : spoilt) look->links[link] = {};
  look->meshes = shelf.Taken();
  SimplifyTogether(kMostSeenTriangles, &look->meshes);
}

}  // namespace

RobotLook LookOf(const models::RobotModel& robot) {
  RobotLook look;
  if (robot.file.empty()) return look;
  try {
    const models::RobotVisuals visuals = models::LoadRobotVisuals(robot.file);
    if (!HasLinksOf(robot, visuals)) return look;  // it was changed since, or has no visuals
    for (const models::Link& link : visuals.links) look.links.push_back({link.shapes, {}});
    AddMeshes(visuals, &look);
  } catch (const InputError& error) {
    look = {};
    look.faults.emplace_back(error.what());
  }
  return look;
}

}  // namespace possibility::experiments
