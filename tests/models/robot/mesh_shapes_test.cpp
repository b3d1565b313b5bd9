// Robots whose collision geometry is meshes: where the files may lie, and what becomes of them.

#include "models/robot/mesh_shapes.h"

#include <gtest/gtest.h>

#include <fstream>
#include <random>

#include "models/input/input_error.h"
#include "models/robot/mesh_path.h"
#include "models/robot/robot_yaml.h"
#include "models/shapes/convex_hull.h"
#include "tests/message_of.h"
#include "tests/models/mesh/mesh_files.h"
#include "tests/models/temporary_folder.h"
#include "tests/models/two_legged_robot.h"
#include "tests/replaced.h"

namespace possibility::models {
namespace {

namespace fs = std::filesystem;

const std::string kBox = "<box size=\"0.2 0.3 0.1\"/>";
const TriangleMesh kBody = testing::BoxMesh({0.2, 0.3, 0.1});

std::string UrdfWithMesh(const std::string& mesh) {
  return Replaced(TwoLeggedUrdf(), kBox, "<mesh " + mesh + "/>");
}

void WriteInto(const fs::path& file, const std::string& contents) {
  fs::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << contents;
}

RobotModel Load(const TemporaryFolder& folder, const std::string& mesh,
                const std::string& yaml = TwoLeggedYaml()) {
  folder.Write("robot.urdf", UrdfWithMesh(mesh));
  return LoadRobotModel(folder.Write("robot.yaml", yaml));
}

std::string ErrorOf(const TemporaryFolder& folder, const std::string& mesh) {
  return MessageOf<InputError>([&] { Load(folder, mesh); });
}

TEST(MeshShapes, AMeshBecomesItsScaledHullInTheLink) {
  const TemporaryFolder folder;
  folder.Write("body.stl", testing::BinaryStl(kBody));
  folder.Write("body.obj", testing::Obj(kBody));
  folder.Write("body.dae", testing::Collada(kBody, 1, "Y_UP"));
  for (const std::string ending : {"stl", "obj", "dae"}) {
    const RobotModel robot = Load(folder, "filename=\"body." + ending + "\" scale=\"2 1 -3\"");
    ASSERT_EQ(robot.links[0].shapes.size(), 2u);  // of the base, and the tool's sphere
    for (const PosedShape& posed : robot.links[0].shapes) {
      if (posed.shape.type != ShapeType::kConvexMesh) continue;
      EXPECT_EQ(posed.shape.vertices.size(), 8u);
      EXPECT_NEAR(HullOfPoints(posed.shape.vertices).Volume(), 6 * 0.2 * 0.3 * 0.1, 1e-8);
      const Eigen::AlignedBox3d bounds = posed.shape.Bounds(posed.X_PS);
      EXPECT_TRUE(bounds.min().isApprox(Eigen::Vector3d(0, 0, -0.3), 1e-6));
      EXPECT_TRUE(bounds.max().isApprox(Eigen::Vector3d(0.4, 0.3, 0), 1e-6));
    }
  }
}

TEST(MeshShapes, ALinkOnAFixedJointBringsItsMesh) {
  const TemporaryFolder folder;
  folder.Write("body.stl", testing::BinaryStl(kBody));
  folder.Write("robot.urdf", Replaced(TwoLeggedUrdf(), "<sphere radius=\"0.05\"/>",
                                      "<mesh filename=\"body.stl\"/>"));
  const RobotModel robot = LoadRobotModel(folder.Write("robot.yaml", TwoLeggedYaml()));
  ASSERT_EQ(robot.links[0].shapes.size(), 2u);
  // The tool is 0.3 m above the base, turned by 0.5 rad about y.
  const Eigen::AlignedBox3d bounds =
      robot.links[0].shapes[1].shape.Bounds(robot.links[0].shapes[1].X_PS);
  EXPECT_NEAR(bounds.max().x(), 0.2 * std::cos(0.5) + 0.1 * std::sin(0.5), 1e-6);
  EXPECT_NEAR(bounds.max().z(), 0.3 + 0.1 * std::cos(0.5), 1e-6);
}

TEST(MeshShapes, WhatTheYamlReplacesIsNotRead) {
  const TemporaryFolder folder;
  const std::string yaml = Replaced(TwoLeggedYaml(), "shapes:\n",
                                    "shapes:\n  base:\n    - {shape: sphere, radius: 0.1, "
                                    "position: [0, 0, 0]}\n");
  const RobotModel robot = Load(folder, "filename=\"missing.stl\"", yaml);
  ASSERT_EQ(robot.links[0].shapes.size(), 1u);
  EXPECT_EQ(robot.content_hash, RobotContentHash(folder.path() / "robot.yaml"));
}

TEST(MeshShapes, VisualsAreNeverRead) {
  const TemporaryFolder folder;
  folder.Write("robot.urdf",
               Replaced(TwoLeggedUrdf(), "<link name=\"tool\">",
                        "<link name=\"tool\"><visual><geometry><mesh "
                        "filename=\"package://none/a.stl\"/></geometry><material/></visual>"));
  const RobotModel robot = LoadRobotModel(folder.Write("robot.yaml", TwoLeggedYaml()));
  EXPECT_EQ(robot.content_hash, RobotContentHash(robot.file));
}

TEST(MeshShapes, TheHashFollowsTheBytesOfTheMesh) {
  const TemporaryFolder folder;
  folder.Write("body.stl", testing::BinaryStl(kBody));
  const RobotModel one = Load(folder, "filename=\"body.stl\"");
  EXPECT_EQ(one.content_hash, RobotContentHash(one.file));
  folder.Write("body.stl", testing::TextStl(kBody));
  EXPECT_NE(one.content_hash, RobotContentHash(one.file));
}

TEST(MeshShapes, PackagesAreFoundAboveTheUrdfOrWhereTheYamlSays) {
  const TemporaryFolder folder;
  WriteInto(folder.path() / "bodies/meshes/a.stl", testing::BinaryStl(kBody));
  WriteInto(folder.path() / "checkout/package.xml", "<package><name>other</name></package>");
  WriteInto(folder.path() / "checkout/b.stl", testing::BinaryStl(kBody));
  const fs::path urdf = folder.path() / "bodies/urdf/robot.urdf";
  WriteInto(urdf, "");
  const auto resolved = [&](const std::string& name, const std::vector<fs::path>& packages = {}) {
    return ResolveMeshPath(name, urdf, packages, "robot.urdf");
  };
  EXPECT_TRUE(
      fs::equivalent(resolved("package://bodies/meshes/a.stl"), resolved("../meshes/a.stl")));
  EXPECT_TRUE(fs::equivalent(resolved("package://other/b.stl", {folder.path() / "checkout"}),
                             folder.path() / "checkout/b.stl"));
  const auto error = [&](const std::string& name) {
    return MessageOf<InputError>([&] { resolved(name); });
  };
  EXPECT_EQ(error("package://bodies/../checkout/b.stl"),
            "robot.urdf: 'package://bodies/../checkout/b.stl' leaves its package");
  EXPECT_EQ(error("package://../checkout/b.stl"),
            "robot.urdf: expected package://NAME/FILE, got 'package://../checkout/b.stl'");
  EXPECT_EQ(error("../../checkout/b.stl"),
            "robot.urdf: '../../checkout/b.stl' is outside of the URDF's folder, the one above and "
            "those under 'packages'");
  EXPECT_EQ(error("package://bodies"),
            "robot.urdf: expected package://NAME/FILE, got "
            "'package://bodies'");
}

// Robots are published without the folder of their package, or under another name.
TEST(MeshShapes, WithoutItsPackageAFileIsFoundBesideTheUrdf) {
  const TemporaryFolder folder;
  WriteInto(folder.path() / "robot/meshes/a.stl", testing::BinaryStl(kBody));
  WriteInto(folder.path() / "robot/urdf/b.stl", testing::BinaryStl(kBody));
  WriteInto(folder.path() / "c.stl", testing::BinaryStl(kBody));
  const auto resolved = [&](const std::string& name) {
    return ResolveMeshPath(name, folder.path() / "robot/urdf/robot.urdf", {}, "robot.urdf");
  };
  EXPECT_TRUE(fs::equivalent(resolved("package://elsewhere/meshes/a.stl"),
                             folder.path() / "robot/meshes/a.stl"));
  EXPECT_TRUE(
      fs::equivalent(resolved("package://elsewhere/b.stl"), folder.path() / "robot/urdf/b.stl"));
  EXPECT_THROW(resolved("package://elsewhere/c.stl"), InputError);
  EXPECT_THROW(resolved("package://elsewhere/../../c.stl"), InputError);
}

TEST(MeshShapes, ALinkOfTheFileSystemLeadsNowhereElse) {
  const TemporaryFolder folder;
  WriteInto(folder.path() / "secret/a.stl", testing::BinaryStl(kBody));
  WriteInto(folder.path() / "robot/urdf/robot.urdf", "");
  fs::create_symlink(folder.path() / "secret/a.stl", folder.path() / "robot/urdf/a.stl");
  EXPECT_THROW(ResolveMeshPath("a.stl", folder.path() / "robot/urdf/robot.urdf", {}, ""),
               InputError);
  EXPECT_NO_THROW(ResolveMeshPath("a.stl", folder.path() / "robot/urdf/robot.urdf",
                                  {folder.path() / "secret"}, ""));
}

TEST(MeshShapes, AFlatMeshIsRefusedWithItsLink) {
  const TemporaryFolder folder;
  folder.Write("flat.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const std::string error = ErrorOf(folder, "filename=\"flat.obj\"");
  EXPECT_NE(error.find("robot.urdf: link 'base': mesh: "), std::string::npos) << error;
  EXPECT_NE(error.find("flat.obj: convex hull: the points lie in one plane"), std::string::npos)
      << error;
}

TEST(MeshShapes, SpoiltMeshesGiveOneLine) {
  const TemporaryFolder folder;
  std::mt19937 random(21);
  int refused = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const std::string ending = trial % 3 == 0 ? "stl" : trial % 3 == 1 ? "obj" : "dae";
    std::string bytes = ending == "stl"   ? testing::TextStl(kBody)
                        : ending == "obj" ? testing::Obj(kBody)
                                          : testing::Collada(kBody, 1, "Z_UP");
    for (int i = 0; i < 3; ++i) bytes[random() % bytes.size()] = static_cast<char>(random() % 256);
    if (trial % 4 == 0) bytes.resize(random() % bytes.size());
    folder.Write("body." + ending, bytes);
    const std::string error = ErrorOf(folder, "filename=\"body." + ending + "\"");
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    refused += error.find("robot.urdf: link 'base': mesh: ") != std::string::npos;
  }
  EXPECT_GT(refused, 60);
}

}  // namespace
}  // namespace possibility::models
