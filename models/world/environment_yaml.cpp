#include "models/world/environment_yaml.h"

#include <cmath>
#include <numbers>
#include <set>

#include "models/shapes/shape_yaml.h"
#include "models/world/ground_map.h"

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

void RequireNear(const YamlNode& node, const Obstacle& obstacle) {
  const Eigen::AlignedBox3d bounds = obstacle.shape.Bounds(obstacle.X_WO);
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
  node.MapOf({"name", "size", "position", "yaw_deg", "rpy_deg"});
  Obstacle ground;
  ground.is_ground = true;
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

Obstacle ReadObstacle(const YamlNode& node) {
  std::vector<std::string> keys = kShapeKeys;
  keys.push_back("name");
  node.MapOf(keys);
  const PosedShape posed = ReadPosedShape(node);
  return {node.At("name").String(), posed.shape, posed.X_PS, false};
}

}  // namespace

Environment ReadEnvironment(const YamlNode& node) {
  node.MapOf({"bounds", "ground", "obstacles"});
  Environment environment;
  environment.bounds = ReadBounds(node.At("bounds"));
  std::set<std::string> names;
  const auto add = [&](const YamlNode& item, Obstacle obstacle) {
    if (!names.insert(obstacle.name).second) item.At("name").Fail("this name is already taken");
    RequireNear(item, obstacle);
    environment.obstacles.push_back(std::move(obstacle));
  };
  for (const YamlNode& item : node.At("ground").Items()) add(item, ReadGround(item));
  if (environment.obstacles.empty()) node.At("ground").FailExpected("at least one ground box");
  if (const auto obstacles = node.Find("obstacles")) {
    for (const YamlNode& item : obstacles->Items()) add(item, ReadObstacle(item));
  }
  return environment;
}

}  // namespace possibility::models
