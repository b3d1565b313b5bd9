#include "models/mesh/mesh_reader.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "models/input/input_error.h"
#include "tests/message_of.h"
#include "tests/models/mesh/mesh_files.h"
#include "tests/models/temporary_folder.h"
#include "tests/replaced.h"

namespace possibility::models {
namespace {

using Eigen::Vector3d;
using testing::BoxMesh;

const TriangleMesh kReadBox = BoxMesh({1.25, 2.5, 0.125});

std::string ErrorOfMesh(const std::string& bytes, const std::string& name) {
  return MessageOf<InputError>([&] { ParseMesh(bytes, name); });
}

/// The triangles as corners, each from its lowest corner on, in order.
std::vector<std::array<std::array<double, 3>, 3>> Corners(const TriangleMesh& mesh) {
  std::vector<std::array<std::array<double, 3>, 3>> all;
  for (const auto& triangle : mesh.triangles) {
    std::array<std::array<double, 3>, 3> corners;
    for (int i = 0; i < 3; ++i) {
      Eigen::Map<Vector3d>(corners[i].data()) = mesh.vertices[triangle[i]];
    }
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    all.push_back(corners);
  }
  std::sort(all.begin(), all.end());
  return all;
}

TEST(MeshReader, EveryFormatGivesTheSameMesh) {
  const TemporaryFolder folder;
  const std::vector<std::pair<std::string, std::string>> files = {
      {"text.stl", testing::TextStl(kReadBox)},
      {"binary.STL", testing::BinaryStl(kReadBox)},
      {"box.obj", testing::Obj(kReadBox)},
      {"text.ply", testing::TextPly(kReadBox)},
      {"binary.ply", testing::BinaryPly(kReadBox)},
      {"box.dae", testing::Collada(kReadBox, 1, "Z_UP")}};
  for (const auto& [name, contents] : files) {
    const TriangleMesh mesh = ReadMesh(folder.Write(name, contents));
    EXPECT_EQ(mesh.vertices.size(), 8u) << name;
    EXPECT_EQ(Corners(mesh), Corners(kReadBox)) << name;
  }
}

TEST(MeshReader, ColladaIsReadInMetresAndNotTurned) {
  for (const std::string up : {"X_UP", "Y_UP", "Z_UP"}) {
    const TriangleMesh mesh = ParseMesh(testing::Collada(kReadBox, 0.5, up), "box.dae");
    EXPECT_EQ(Corners(mesh), Corners(BoxMesh({0.625, 1.25, 0.0625}))) << up;
  }
}

TEST(MeshReader, ColladaWithoutIndicesIsNamed) {
  EXPECT_EQ(
      ErrorOfMesh(Replaced(testing::Collada(kReadBox, 1, "Z_UP"), "<p>0", "<p>zero"), "a.dae"),
      "a.dae: not a valid mesh: line 2: expected whole numbers");
}

TEST(MeshReader, BinaryStlMayBeginLikeText) {
  std::string bytes = testing::BinaryStl(kReadBox);
  bytes.replace(0, 5, "solid");
  EXPECT_EQ(Corners(ParseMesh(bytes, "box.stl")), Corners(kReadBox));
}

TEST(MeshReader, PolygonsBecomeTriangles) {
  // A notched hexagon: not convex, so that a fan from the first corner would leave it.
  const TriangleMesh mesh = ParseMesh(
      "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 1 0.5 0\nv 0 2 0\nv 5 5 5\nf 1 2 3 4 5\nl 1 6\n", "notch.obj");
  double area = 0;
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
    EXPECT_GT(mesh.AreaVector(t).z(), 0);
    area += mesh.AreaVector(t).z() / 2;
  }
  EXPECT_EQ(mesh.triangles.size(), 3u);
  EXPECT_NEAR(area, 4 - 1.5, 1e-6);
  EXPECT_EQ(mesh.vertices.size(), 5u);
}

TEST(MeshReader, PartsAreMerged) {
  const TriangleMesh mesh = ParseMesh(
      "o one\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\no two\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 4 5 6\n"
      "g three\nf 1 2 2\n",
      "parts.obj");
  EXPECT_EQ(mesh.triangles.size(), 2u);
  EXPECT_EQ(mesh.vertices.size(), 4u);
}

TEST(MeshReader, BrokenFilesGiveOneLine) {
  const std::string ply = testing::TextPly(kReadBox);
  const std::string stl = testing::BinaryStl(kReadBox);
  EXPECT_EQ(ErrorOfMesh("", "a.stl"), "a.stl: is empty, expected a mesh");
  EXPECT_EQ(ErrorOfMesh(stl, "a.fbx"),
            "a.fbx: expected a mesh whose name ends in .stl, .obj, .ply or .dae");
  EXPECT_EQ(ErrorOfMesh(stl, "a"),
            "a: expected a mesh whose name ends in .stl, .obj, .ply or .dae");
  EXPECT_EQ(MessageOf<InputError>([] { ReadMesh("/nowhere/a.stl"); }),
            "/nowhere/a.stl: no such file");
  EXPECT_EQ(ErrorOfMesh("v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", "a.obj"),
            "a.obj: no triangle has an area");
  EXPECT_EQ(ErrorOfMesh(Replaced(ply, "3 0 2 1", "3 0 2 8"), "a.ply"),
            "a.ply: face 0 names corner 8, but there are 8");
  EXPECT_EQ(
      ErrorOfMesh(Replaced(ply, "vertex 8", "vertex 4000000000"), "a.ply"),
      fmt::format("a.ply: cannot hold 4000000000 elements 'vertex' in {} bytes", ply.size() + 9));
  EXPECT_EQ(ErrorOfMesh(Replaced(ply, "end_header", "end"), "a.ply"),
            "a.ply: expected a line 'end_header'");
  const std::vector<std::pair<std::string, std::string>> others = {
      {"a.obj", "v 0 0 0\nv 1 0 nan\nv 0 1 0\nf 1 2 3\n"},
      {"a.obj", "v 0 0 0\nv 1 0 1e999\nv 0 1 0\nf 1 2 3\n"},
      {"a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n"},
      {"a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n"},
      {"a.obj", "hello\n"},
      {"a.obj", testing::TextPly(kReadBox)},
      {"a.stl", testing::TextPly(kReadBox)},
      {"a.stl", stl.substr(0, 300)},
      {"a.stl", "solid a\nendsolid a\n"},
      {"a.ply", stl},
      {"a.dae", stl},
      {"a.dae", testing::Collada(kReadBox, 1, "Z_UP").substr(0, 700)},
      {"a.dae", Replaced(testing::Collada(kReadBox, 1, "Z_UP"), "#places", "#nowhere")},
      {"a.ply", ply.substr(0, 200)},
      {"a.ply",
       "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float "
       "y\nproperty float z\nend_header\n0 0 0\n"}};
  for (const auto& [name, contents] : others) {
    const std::string error = ErrorOfMesh(contents, name);
    EXPECT_EQ(error.substr(0, 7), name + ": ") << contents.substr(0, 80);
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
  }
}

TEST(MeshReader, NumbersThatAreNotFiniteAreRefused) {
  TriangleMesh mesh = kReadBox;
  for (const double number : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    mesh.vertices[3].y() = number;
    for (const std::string name : {"a.stl", "a.ply"}) {
      const std::string bytes =
          name == "a.stl" ? testing::BinaryStl(mesh) : testing::BinaryPly(mesh);
      EXPECT_NE(ErrorOfMesh(bytes, name).find("is not finite, expected numbers"),
                std::string::npos);
    }
  }
}

TEST(MeshReader, TooManyTrianglesAreRefused) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles.assign(kMostTriangles + 1, {0, 1, 2});
  EXPECT_EQ(
      ErrorOfMesh(testing::BinaryStl(mesh), "a.stl"),
      "a.stl: has 200001 triangles, expected at most 200000: thin it out or cut it into parts");
}

}  // namespace
}  // namespace possibility::models
