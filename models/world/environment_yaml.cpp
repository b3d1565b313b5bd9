#include "models/world/environment_yaml.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <set>
#include <utility>

#include "models/shapes/shape_yaml.h"
#include "models/world/ground_map.h"
#include "models/world/terrain_yaml.h"

namespace possibility::models {
namespace {

/// m. Doubles are 1.5e-11 m apart there, and jumps that far out verify as they do at the origin.
/// Larger distances were not tried.
constexpr double kFarthest = 1e5;

void RequireNear(const YamlNode& node, double coordinate) {
  if (std::abs(coordinate) <= kFarthest) return;
  node.Fail(
      "lies more than 100 km from the origin, expected coordinates between -100000 and "
      "100000 m");
}

void RequireNear(const YamlNode& node, const Eigen::AlignedBox3d& bounds) {
  RequireNear(node, bounds.min().cwiseAbs().cwiseMax(bounds.max().cwiseAbs()).maxCoeff());
}

Eigen::AlignedBox2d ReadBounds(const YamlNode& node) {
  node.MapOf({"x", "y"});
  const Eigen::Vector2d x = node.At("x").Interval();
  const Eigen::Vector2d y = node.At("y").Interval();
  RequireNear(node.At("x"), x.cwiseAbs().maxCoeff());
  RequireNear(node.At("y"), y.cwiseAbs().maxCoeff());
  return {Eigen::Vector2d(x[0], y[0]), Eigen::Vector2d(x[1], y[1])};
}

/// Some side must bear.
void RequireSideUp(const YamlNode& node, const Obstacle& box) {
  const double up = box.X_WO.linear().row(2).cwiseAbs().maxCoeff();
  if (up >= std::cos(GroundMap::kSteepest) - 1e-9) return;
  node.Fail("no side of the box faces up, expected one that is tilted by at most 45 degrees");
}

/// A ground box stands upright (`yaw_deg`) or is tilted (`rpy_deg`).
Obstacle ReadGround(const YamlNode& node) {
  node.MapOf({"name", "size", "position", "yaw_deg", "rpy_deg", "friction"});
  Obstacle ground;
  ground.is_ground = true;
  ground.friction = ReadGroundFriction(node);
  ground.name = node.At("name").String();
  ground.shape = Shape::Box(node.At("size").PositiveVector3());
  ground.X_WO.translation() = node.At("position").Vector3();
  if (const auto turn = node.Find("rpy_deg")) {
    if (node.Find("yaw_deg")) turn->Fail("expected either rpy_deg or yaw_deg, got both");
    ground.X_WO.rotate(FromRollPitchYaw(std::numbers::pi / 180 * turn->Vector3()));
    RequireSideUp(*turn, ground);
  } else if (const auto yaw = node.Find("yaw_deg")) {
    ground.X_WO.rotate(Eigen::AngleAxisd(yaw->Degrees(), Eigen::Vector3d::UnitZ()));
  }
  return ground;
}

/// Steps may bear on a box that says so: `bears: true`.
Obstacle ReadObstacle(const YamlNode& node) {
  std::vector<std::string> keys = kShapeKeys;
  keys.insert(keys.end(), {"name", "bears", "friction"});
  node.MapOf(keys);
  const PosedShape posed = ReadPosedShape(node);
  Obstacle obstacle;
  obstacle.name = node.At("name").String();
  obstacle.shape = posed.shape;
  obstacle.X_WO = posed.X_PS;
  const auto bears = node.Find("bears");
  obstacle.is_ground = bears && bears->Boolean();
  obstacle.is_for_steps = obstacle.is_ground;
  if (!obstacle.is_ground) {
    if (const auto friction = node.Find("friction")) {
      friction->Fail("is of an obstacle that does not bear, expected 'bears: true' beside it");
    }
    return obstacle;
  }
  if (obstacle.shape.type != ShapeType::kBox) bears->Fail("expected a box, as only boxes bear");
  RequireSideUp(*bears, obstacle);
  obstacle.friction = ReadGroundFriction(node);
  return obstacle;
}

}  // namespace

Environment ReadEnvironment(const YamlNode& node, const std::filesystem::path& folder,
                            std::vector<std::string>* hashes) {
  node.MapOf({"bounds", "ground", "obstacles", "meshes", "height_maps"});
  Environment environment;
  environment.bounds = ReadBounds(node.At("bounds"));
  std::set<std::string> names;
  const auto take_name = [&names](const YamlNode& item, const std::string& name) {
    if (!names.insert(name).second) item.At("name").Fail("this name is already taken");
  };
  const auto add = [&](const YamlNode& item, Obstacle obstacle) {
    take_name(item, obstacle.name);
    RequireNear(item, obstacle.shape.Bounds(obstacle.X_WO));
    environment.obstacles.push_back(std::move(obstacle));
  };
  const auto ground = node.Find("ground");
  if (ground) {
    for (const YamlNode& item : ground->Items()) add(item, ReadGround(item));
  }
  const bool has_box = !environment.obstacles.empty();
  if (const auto obstacles = node.Find("obstacles")) {
    for (const YamlNode& item : obstacles->Items()) add(item, ReadObstacle(item));
  }
  std::size_t triangles = 0;
  const auto add_terrain = [&](const YamlNode& item, const TerrainFile& file) {
    take_name(item, file.terrain.name);
    RequireNear(item, file.terrain.mesh.Bounds());
    triangles += file.terrain.mesh.triangles.size();
    if (triangles > kMostTriangles) {
      item.Fail(fmt::format("with it there are {} triangles, expected at most {} together",
                            triangles, kMostTriangles));
    }
    hashes->push_back(file.content_hash);
    AddTerrain(file.terrain, &environment);
  };
  if (const auto meshes = node.Find("meshes")) {
    for (const YamlNode& item : meshes->Items()) add_terrain(item, ReadMeshTerrain(item, folder));
  }
  if (const auto maps = node.Find("height_maps")) {
    for (const YamlNode& item : maps->Items()) {
      add_terrain(item, ReadHeightMapTerrain(item, folder));
    }
  }
  if (!has_box && environment.faces.empty()) {
    if (environment.surfaces.empty()) node.At("ground").FailExpected("at least one ground box");
    node.Fail("expected ground: a box, or a mesh or height map with a part that is level enough");
  }
  return environment;
}

}  // namespace possibility::models
