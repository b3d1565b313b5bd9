#include "models/world/terrain.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "models/input/input_error.h"
#include "models/mesh/flat_regions.h"
#include "models/mesh/height_map.h"
#include "models/world/collision.h"
#include "models/world/ground_map.h"
#include "models/world/scenario.h"
#include "tests/message_of.h"
#include "tests/models/mesh/mesh_files.h"
#include "tests/models/mesh/png_files.h"
#include "tests/models/random_geometry.h"
#include "tests/models/temporary_folder.h"
#include "tests/replaced.h"

namespace possibility::models {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using testing::BoxMesh;
using testing::RandomGeometry;

TriangleMesh BoxMeshAt(const Vector3d& low, const Vector3d& size) {
  return BoxMesh(size).Placed(1, Eigen::Isometry3d(Eigen::Translation3d(low)));
}

Environment WorldOf(const TriangleMesh& mesh, std::optional<double> base = std::nullopt) {
  Environment environment;
  AddTerrain({"terrain", mesh, true, base}, &environment);
  return environment;
}

/// Distance of a point from a triangle: from its inside if the foot of the perpendicular lies in
/// it, otherwise from its sides.
double DistanceToTriangle(const Vector3d& p, const std::array<Vector3d, 3>& corners) {
  const Vector3d n = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
  bool is_inside = true;
  double nearest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    const Vector3d side = corners[(i + 1) % 3] - corners[i];
    if (n.cross(side).dot(p - corners[i]) < 0) is_inside = false;
    const double t = std::clamp(side.dot(p - corners[i]) / side.squaredNorm(), 0.0, 1.0);
    nearest = std::min(nearest, (p - corners[i] - t * side).norm());
  }
  return is_inside ? std::abs(n.dot(p - corners[0])) : nearest;
}

double DistanceToMesh(const Vector3d& p, const TriangleMesh& mesh) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const auto& [a, b, c] : mesh.triangles) {
    nearest = std::min(
        nearest, DistanceToTriangle(p, {mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]}));
  }
  return nearest;
}

TEST(Terrain, ABoxOfTrianglesBlocksLikeABox) {
  RandomGeometry random(1);
  const Vector3d size(1, 0.6, 0.4);
  const Eigen::Isometry3d X_WO = random.Pose(1);
  Environment solid;
  solid.obstacles.push_back({"box", Shape::Box(size), X_WO, false});
  const TriangleMesh mesh = BoxMeshAt(-size / 2, size).Placed(1, X_WO);
  const CollisionChecker box(solid), sheets(WorldOf(mesh));
  int compared = 0;
  for (int i = 0; i < 500; ++i) {
    const Shape shape = random.AnyShape();
    const Eigen::Isometry3d X = random.Pose(1.5);
    const double expected = box.Clearance(PreparedShape(shape), X, 1);
    const double found = sheets.Clearance(PreparedShape(shape), X, 1);
    if (expected > 0) {
      EXPECT_NEAR(found, expected, 1e-4);
      ++compared;
    } else if (expected > -0.02) {
      EXPECT_LT(found, 1e-4);  // it reaches through the surface
    }
  }
  EXPECT_GT(compared, 100);
}

TEST(Terrain, ClearanceAboveUnevenGroundIsThatOfItsTriangles) {
  RandomGeometry random(2);
  for (int round = 0; round < 10; ++round) {
    Eigen::MatrixXd heights(7, 9);
    for (double& height : heights.reshaped()) height = random.Uniform(0, 0.3);
    heights.topLeftCorner(4, 4).setConstant(0.1);
    const TriangleMesh mesh = MeshOfHeights(heights, 0.2);
    const CollisionChecker sheets(WorldOf(mesh)), columns(WorldOf(mesh, -0.5));
    for (int i = 0; i < 200; ++i) {
      const Vector3d p(random.Uniform(0, 1.6), random.Uniform(0, 1.2), random.Uniform(0.3, 0.6));
      const double radius = random.Uniform(0.01, 0.1);
      const PreparedShape ball(Shape::Sphere(radius));
      const Eigen::Isometry3d X(Eigen::Translation3d{p});
      const double expected = DistanceToMesh(p, mesh) - radius;
      EXPECT_NEAR(sheets.Clearance(ball, X, 5), expected, kFlatness);
      EXPECT_NEAR(columns.Clearance(ball, X, 5), expected, kFlatness);
      // A height map is solid.
      const Eigen::Isometry3d X_below(Eigen::Translation3d(p.x(), p.y(), -0.2));
      EXPECT_LT(columns.Clearance(ball, X_below, 5), 0);
    }
  }
}

TEST(Terrain, GroundIsWhereTheMeshIsLevelEnough) {
  // A ramp of 20 degrees between two floors, cut out of a height map.
  Eigen::MatrixXd heights(5, 21);
  for (int column = 0; column < 21; ++column) {
    heights.col(column).setConstant(std::tan(0.35) * 0.1 * std::clamp(column - 5, 0, 10));
  }
  const Environment environment = WorldOf(MeshOfHeights(heights, 0.1));
  EXPECT_EQ(environment.faces.size(), 3u);
  EXPECT_EQ(environment.obstacles.size(), 3u);
  const GroundMap ground(environment);
  ASSERT_EQ(ground.planes().size(), 3u);
  ASSERT_EQ(ground.levels().size(), 2u);
  EXPECT_NEAR(ground.levels()[1], std::tan(0.35), 1e-12);
  EXPECT_NEAR(std::acos(ground.planes()[2].normal.z()), 0.35, 1e-9);
  EXPECT_NEAR(ground.HeightBelow({1, 0.2}, 9).value(), std::tan(0.35) * 0.5, 1e-9);
  EXPECT_FALSE(ground.HeightBelow({2.01, 0.2}, 9));
  ASSERT_EQ(environment.surfaces.size(), 1u);
  EXPECT_EQ(environment.surfaces[0].mesh.triangles.size(), 160u);
  ASSERT_EQ(environment.surfaces[0].headings.size(), 1u);
  EXPECT_NEAR(environment.surfaces[0].headings[0], 0, 1e-9);
}

TEST(Terrain, FeetMayTouchWhatBearsAndWhatDropsFromIt) {
  TriangleMesh mesh = BoxMeshAt({0, 0, 0}, {1, 1, 0.2});        // a step
  testing::Append(BoxMeshAt({2, 0, 0.2}, {0.1, 1, 2}), &mesh);  // a wall, whose top bears as well
  for (const Vector3d& corner : {Vector3d(5, 0, 0), Vector3d(6, 0, 0), Vector3d(6, 0, 2)}) {
    mesh.vertices.push_back(corner);  // a board on edge
  }
  const auto n = static_cast<int>(mesh.vertices.size());
  mesh.triangles.push_back({n - 3, n - 2, n - 1});
  const Environment environment = WorldOf(mesh);
  int ground = 0;
  for (const Obstacle& obstacle : environment.obstacles) {
    EXPECT_EQ(obstacle.name, "terrain");
    EXPECT_EQ(obstacle.surface, 0);
    const double x = obstacle.X_WO.translation().x();
    const bool is_underside = obstacle.X_WO.linear()(2, 2) < -0.5;
    EXPECT_EQ(obstacle.is_ground, x < 4 && !is_underside) << x;
    ground += obstacle.is_ground;
  }
  EXPECT_EQ(environment.obstacles.size(), 13u);
  EXPECT_EQ(ground, 10);
  EXPECT_EQ(environment.faces.size(), 2u);
  Environment walls;
  AddTerrain({"walls", mesh, false, std::nullopt}, &walls);
  EXPECT_TRUE(walls.faces.empty());
  for (const Obstacle& obstacle : walls.obstacles) EXPECT_FALSE(obstacle.is_ground);
}

TEST(Terrain, HeadingsFollowTheSides) {
  for (const double yaw : {0.0, 0.3, -0.7, 1.2, 0.785}) {
    const Eigen::Isometry3d X(Eigen::AngleAxisd(yaw, Vector3d::UnitZ()));
    const Environment environment = WorldOf(BoxMesh({1, 2, 0.1}).Placed(1, X));
    const std::vector<double>& headings = environment.surfaces[0].headings;
    ASSERT_EQ(headings.size(), 1u) << yaw;
    EXPECT_NEAR(std::sin(4 * (headings[0] - yaw)), 0, 1e-9);
    EXPECT_GT(std::cos(4 * (headings[0] - yaw)), 0);
  }
}

const std::string kTerrainScenario = R"(name: terrain
robot: robot.yaml
actions: [stand]
start: {action: stand, x: 1, y: 0, yaw_deg: 0}
goal: {action: stand, x: 2, y: 0, yaw_deg: 0}
environment:
  bounds: {x: [0, 4], y: [-2, 2]}
  meshes:
    - {name: slab, file: parts/slab.stl, scale: 0.001, position: [1, 0, 0], rpy_deg: [0, 0, 90]}
    - {name: bar, file: bar.obj, ground: false}
  height_maps:
    - {name: hill, file: hill.png, cell: 0.25, height_scale: 0.01, position: [2, 0, 1], yaw_deg: 90}
    - {name: steps, file: steps.csv, cell: 0.5}
)";

class TerrainYaml : public ::testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(folder_.path() / "parts");
    folder_.Write("parts/slab.stl", testing::BinaryStl(BoxMesh({1000, 2000, 100})));
    folder_.Write("bar.obj", testing::Obj(BoxMesh({0.1, 0.1, 2})));
    Eigen::MatrixXd values(3, 4);
    values << 100, 100, 100, 100, 0, 0, 0, 0, 0, 0, 0, 0;
    folder_.Write("hill.png", testing::PngOf(values, 8, 0));
    folder_.Write("steps.csv", "0,0,0.5,0.5\n0,0,0.5,0.5\n");
  }

  Scenario Load(const std::string& text = kTerrainScenario) {
    return LoadScenario(folder_.Write("scenario.yaml", text));
  }

  std::string Error(const std::string& from, const std::string& to) {
    const std::string message =
        MessageOf<InputError>([&] { Load(Replaced(kTerrainScenario, from, to)); });
    return ReplacedEverywhere(message, folder_.path().string() + "/", "");
  }

  TemporaryFolder folder_;
};

TEST_F(TerrainYaml, SurfacesAreInTheWorld) {
  const Environment environment = Load().environment;
  ASSERT_EQ(environment.surfaces.size(), 4u);
  const Eigen::AlignedBox3d slab = environment.surfaces[0].mesh.Bounds();
  EXPECT_TRUE(slab.isApprox(Eigen::AlignedBox3d(Vector3d(-1, 0, 0), Vector3d(1, 1, 0.1)), 1e-6));
  EXPECT_EQ(environment.surfaces[1].name, "bar");
  EXPECT_FALSE(environment.surfaces[1].is_ground);
  // The map's top row, turned by 90 degrees, is the hill on its left.
  const Eigen::AlignedBox3d hill = environment.surfaces[2].mesh.Bounds();
  EXPECT_TRUE(hill.isApprox(Eigen::AlignedBox3d(Vector3d(1.5, 0, 1), Vector3d(2, 0.75, 2)), 1e-9));
  for (const Vector3d& vertex : environment.surfaces[2].mesh.vertices) {
    EXPECT_NEAR(vertex.z(), vertex.x() < 1.6 ? 2 : 1, 1e-12);
  }
  const GroundMap ground(environment);
  EXPECT_NEAR(ground.HeightBelow({0.5, 0.8}, 0.2).value(), 0.1, 1e-9);
  EXPECT_NEAR(ground.HeightBelow({1.9, 0.4}, 9).value(), 1, 1e-9);
  EXPECT_NEAR(ground.HeightBelow({1.2, 0.2}, 0.6).value(), 0.5, 1e-9);
  EXPECT_FALSE(ground.HeightBelow({0.05, 0.05}, 9).value_or(0) > 1.9);
  for (const GroundFace& face : environment.faces) EXPECT_NE(face.name, "bar");
  const CollisionChecker checker(environment);
  const Shape ball = Shape::Sphere(0.01);
  EXPECT_FALSE(checker.IsFree(ball, Eigen::Isometry3d(Eigen::Translation3d(0.1, 0.05, 1)), 0));
  EXPECT_TRUE(checker.IsFree(ball, Eigen::Isometry3d(Eigen::Translation3d(0.2, 0.05, 1)), 0));
}

TEST_F(TerrainYaml, TheHashCoversEveryFile) {
  const std::string hash = Load().content_hash;
  EXPECT_EQ(Load().content_hash, hash);
  folder_.Write("bar.obj", testing::Obj(BoxMesh({0.1, 0.1, 2.5})));
  const std::string other_bar = Load().content_hash;
  EXPECT_NE(other_bar, hash);
  folder_.Write("steps.csv", "0,0,0.5,0.5\n0,0,0.5,0.51\n");
  EXPECT_NE(Load().content_hash, other_bar);
}

TEST_F(TerrainYaml, EachFaultIsNamedInOneLine) {
  EXPECT_EQ(Error("file: bar.obj", "file: rod.obj"), "rod.obj: no such file");
  EXPECT_EQ(Error("file: bar.obj", "file: steps.csv"),
            "steps.csv: expected a mesh whose name ends in .stl, .obj, .ply or .dae");
  EXPECT_EQ(Error("file: steps.csv", "file: bar.obj"),
            "bar.obj: expected a height map whose name ends in .png or .csv");
  EXPECT_EQ(Error("name: bar", "name: slab"),
            "scenario.yaml:10: environment.meshes[1].name: this name is already taken");
  EXPECT_EQ(Error("name: bar, ", ""),
            "scenario.yaml:10: environment.meshes[1]: the key 'name' is missing");
  EXPECT_EQ(Error("ground: false", "ground: no"),
            "scenario.yaml:10: environment.meshes[1].ground: expected true or false, got no");
  EXPECT_EQ(
      Error("ground: false", "grund: false"),
      "scenario.yaml:10: environment.meshes[1]: unknown key 'grund' (did you mean 'ground'?)");
  EXPECT_EQ(Error("scale: 0.001", "scale: 1"),
            "scenario.yaml:9: environment.meshes[0]: is 2000 m long, expected 0.001 to 1000 m: "
            "'scale' is the length in metres of a unit of the file");
  EXPECT_EQ(Error("scale: 0.001", "scale: 1e-7"),
            "scenario.yaml:9: environment.meshes[0]: is 0.0002 m long, expected 0.001 to 1000 m: "
            "'scale' is the length in metres of a unit of the file");
  EXPECT_EQ(Error("scale: 0.001", "scale: 0"),
            "scenario.yaml:9: environment.meshes[0].scale: expected a positive number, got 0");
  EXPECT_EQ(Error("position: [1, 0, 0]", "position: [1e6, 0, 0]"),
            "scenario.yaml:9: environment.meshes[0]: lies more than 100 km from the origin, "
            "expected coordinates between -100000 and 100000 m");
  EXPECT_EQ(Error(", cell: 0.5", ""),
            "scenario.yaml:13: environment.height_maps[1]: the key 'cell' is missing");
  EXPECT_EQ(Error("height_scale: 0.01, ", ""),
            "scenario.yaml:12: environment.height_maps[0]: the key 'height_scale' is missing: the "
            "metres that a step of grey stands for");
  EXPECT_EQ(Error("height_scale: 0.01", "height_scale: 20"),
            "scenario.yaml:12: environment.height_maps[0]: is 2000 m long, expected 0.001 to 1000 "
            "m: 'cell' and 'height_scale' are in metres");
  folder_.Write("bar.obj", testing::Obj(BoxMeshAt({5000, 0, 0}, {1, 1, 1})));
  EXPECT_EQ(Error("ground: false", "ground: true"),
            "scenario.yaml:10: environment.meshes[1]: lies 5001 m from the origin of its file, "
            "expected at most 1500 m, where single precision ends: move it there, and back by "
            "'position'");
  folder_.Write("bar.obj", testing::Obj(BoxMesh({0.1, 0.1, 2})));
  EXPECT_EQ(Error(kTerrainScenario.substr(kTerrainScenario.find("    - {name: slab")),
                  "    - {name: bar, file: bar.obj, ground: false}\n"),
            "scenario.yaml:7: environment: expected ground: a box, or a mesh or height map with a "
            "part that is level enough");
}

}  // namespace
}  // namespace possibility::models
