#include "models/robot/mesh_shapes.h"

#include <fmt/format.h>

#include <map>
#include <utility>

#include "models/input/file_contents.h"
#include "models/input/input_error.h"
#include "models/mesh/mesh_reader.h"
#include "models/robot/mesh_path.h"
#include "models/shapes/convex_hull.h"

namespace possibility::models {
namespace {

/// Reads each file once, whatever the number of links that use it.
class MeshStore {
 public:
  const std::vector<Eigen::Vector3d>& Corners(const std::filesystem::path& file) {
    const auto [known, is_new] = corners_.try_emplace(file.string());
    if (is_new) {
      read_.files.push_back(file);
      read_.contents.push_back(ReadFileContents(file));
      const TriangleMesh mesh = ParseMesh(read_.contents.back(), file);
      try {
        known->second = HullOfPoints(mesh.vertices).vertices;
      } catch (const InputError& error) {
        throw InputError(fmt::format("{}: {}", file.string(), error.what()));
      }
    }
    return known->second;
  }

  MeshFiles Taken() { return std::move(read_); }

 private:
  MeshFiles read_;
  std::map<std::string, std::vector<Eigen::Vector3d>> corners_;  ///< of the hulls, by file
};

Shape HullShape(std::vector<Eigen::Vector3d> corners, const Eigen::Vector3d& scale) {
  for (Eigen::Vector3d& corner : corners) corner = corner.cwiseProduct(scale);
  return Shape::ConvexMesh(SimpleHullOfPoints(corners, kMostHullCorners).vertices);
}

}  // namespace

MeshFiles AddMeshShapes(const PendingMeshes& meshes, const std::filesystem::path& urdf_file,
                        const std::vector<std::filesystem::path>& packages, RobotModel* robot) {
  MeshStore store;
  for (const auto& [link, mesh] : meshes) {
    const std::string owner =
        fmt::format("{}: link '{}': mesh", urdf_file.string(), robot->links[link].name);
    const std::filesystem::path file = ResolveMeshPath(mesh.name, urdf_file, packages, owner);
    try {
      robot->links[link].shapes.push_back({HullShape(store.Corners(file), mesh.scale), mesh.X_LM});
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: {}", owner, error.what()));
    }
  }
  return store.Taken();
}

}  // namespace possibility::models
