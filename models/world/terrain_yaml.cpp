#include "models/world/terrain_yaml.h"

#include <fmt/format.h>

#include <numbers>

#include "models/input/file_contents.h"
#include "models/mesh/height_map.h"
#include "models/mesh/mesh_reader.h"
#include "models/shapes/shape_yaml.h"

namespace possibility::models {
namespace {

using Eigen::Vector3d;

constexpr double kShortest = 1e-3;  // m
constexpr double kLongest = 1e3;    // m

/// Coordinates are read in single precision: beyond this distance (m) from the file's origin they
/// are more than 0.1 mm apart.
constexpr double kFarthestInFile = 1500;

/// A height map is solid down to this much below its lowest height, m.
constexpr double kSolidBelow = 0.5;

std::filesystem::path FileOf(const YamlNode& node, const std::filesystem::path& folder) {
  return (folder / node.At("file").String()).lexically_normal();
}

bool IsGround(const YamlNode& node) {
  const auto ground = node.Find("ground");
  return !ground || ground->Boolean();
}

void RequireSize(const YamlNode& node, const Eigen::AlignedBox3d& bounds, const char* hint) {
  const double size = bounds.sizes().maxCoeff();
  if (size >= kShortest && size <= kLongest) return;
  node.Fail(
      fmt::format("is {:.4g} m long, expected {} to {} m: {}", size, kShortest, kLongest, hint));
}

}  // namespace

double ReadGroundFriction(const YamlNode& node) {
  const auto friction = node.Find("friction");
  return friction ? friction->Positive() : kRobotsFriction;
}

TerrainFile ReadMeshTerrain(const YamlNode& node, const std::filesystem::path& folder) {
  node.MapOf({"name", "file", "scale", "position", "rpy_deg", "ground", "friction"});
  TerrainFile result;
  Terrain& terrain = result.terrain;
  terrain.name = node.At("name").String();
  terrain.is_ground = IsGround(node);
  terrain.friction = ReadGroundFriction(node);
  const auto scale_node = node.Find("scale");
  const double scale = scale_node ? scale_node->Positive() : 1;
  Eigen::Isometry3d X_WM = Eigen::Isometry3d::Identity();
  if (const auto position = node.Find("position")) X_WM.translation() = position->Vector3();
  if (const auto rpy_deg = node.Find("rpy_deg")) {
    X_WM.linear() =
        FromRollPitchYaw(rpy_deg->Vector3() * std::numbers::pi / 180).toRotationMatrix();
  }
  const std::filesystem::path file = FileOf(node, folder);
  const std::string bytes = ReadFileContents(file);
  result.content_hash = ContentHash(bytes);
  const TriangleMesh mesh = ParseMesh(bytes, file);
  Eigen::AlignedBox3d bounds = mesh.Bounds();
  bounds.min() *= scale;
  bounds.max() *= scale;
  RequireSize(node, bounds, "'scale' is the length in metres of a unit of the file");
  const double farthest = bounds.min().cwiseAbs().cwiseMax(bounds.max().cwiseAbs()).maxCoeff();
  if (farthest > kFarthestInFile) {
    node.Fail(
        fmt::format("lies {:.4g} m from the origin of its file, expected at most {} m, where "
                    "single precision ends: move it there, and back by 'position'",
                    farthest, kFarthestInFile));
  }
  terrain.mesh = mesh.Placed(scale, X_WM);
  return result;
}

TerrainFile ReadHeightMapTerrain(const YamlNode& node, const std::filesystem::path& folder) {
  node.MapOf({"name", "file", "cell", "height_scale", "position", "yaw_deg", "ground", "friction"});
  TerrainFile result;
  Terrain& terrain = result.terrain;
  terrain.name = node.At("name").String();
  terrain.is_ground = IsGround(node);
  terrain.friction = ReadGroundFriction(node);
  const double cell = node.At("cell").Number(kShortest, kLongest);
  Eigen::Isometry3d X_WM = Eigen::Isometry3d::Identity();
  if (const auto position = node.Find("position")) X_WM.translation() = position->Vector3();
  if (const auto yaw = node.Find("yaw_deg")) {
    X_WM.rotate(Eigen::AngleAxisd(yaw->Degrees(), Vector3d::UnitZ()));
  }
  const std::filesystem::path file = FileOf(node, folder);
  const std::string bytes = ReadFileContents(file);
  result.content_hash = ContentHash(bytes);
  const Eigen::MatrixXd heights = ParseHeights(bytes, file);
  const auto scale = node.Find("height_scale");
  if (!scale && EndsInPng(file)) {
    node.Fail("the key 'height_scale' is missing: the metres that a step of grey stands for");
  }
  const TriangleMesh mesh = MeshOfHeights((scale ? scale->Positive() : 1) * heights, cell);
  RequireSize(node, mesh.Bounds(), "'cell' and 'height_scale' are in metres");
  terrain.mesh = mesh.Placed(1, X_WM);
  terrain.base = terrain.mesh.Bounds().min().z() - kSolidBelow;
  return result;
}

}  // namespace possibility::models
