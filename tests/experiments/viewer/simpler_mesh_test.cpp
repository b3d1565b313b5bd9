#include "experiments/viewer/simpler_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "tests/models/mesh/mesh_files.h"

namespace possibility::experiments {
namespace {

using Eigen::Vector3d;
using models::TriangleMesh;

/// A unit sphere: a tetrahedron whose triangles are cut into four again and again.
TriangleMesh Sphere(int cuts) {
  TriangleMesh mesh;
  mesh.vertices = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  mesh.triangles = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}};
  for (int cut = 0; cut < cuts; ++cut) {
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
      const auto [known, is_new] =
          middles.try_emplace(std::minmax(a, b), static_cast<int>(mesh.vertices.size()));
      if (is_new) mesh.vertices.push_back((mesh.vertices[a] + mesh.vertices[b]) / 2);
      return known->second;
    };
    std::vector<std::array<int, 3>> triangles;
    for (const auto& [a, b, c] : mesh.triangles) {
      const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      triangles.insert(triangles.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    mesh.triangles = triangles;
    for (Vector3d& vertex : mesh.vertices) vertex.normalize();
  }
  return mesh;
}

std::size_t NumUsed(const TriangleMesh& mesh) {
  std::set<int> used;
  for (const auto& triangle : mesh.triangles) used.insert(triangle.begin(), triangle.end());
  return used.size();
}

TEST(SimplerMeshTest, ASphereStaysOneAndTurnsItsFacesOutwards) {
  const TriangleMesh sphere = Sphere(6);
  ASSERT_EQ(sphere.triangles.size(), 16384u);
  for (const std::size_t most : {4000, 1000, 300}) {
    const TriangleMesh simpler = SimplerMesh(sphere, most);
    EXPECT_LE(simpler.triangles.size(), most);
    EXPECT_GT(simpler.triangles.size(), most / 2);
    EXPECT_EQ(NumUsed(simpler), simpler.vertices.size());
    for (const Vector3d& vertex : simpler.vertices) EXPECT_NEAR(vertex.norm(), 1, 1e-6);
    EXPECT_NEAR(models::testing::EnclosedVolume(simpler), 4 * M_PI / 3, 0.05 * 4 * M_PI / 3)
        << most;
  }
}

TEST(SimplerMeshTest, AMeshWithFewTrianglesStaysAsItIs) {
  const TriangleMesh sphere = Sphere(2);
  const TriangleMesh same = SimplerMesh(sphere, sphere.triangles.size());
  EXPECT_EQ(same.vertices, sphere.vertices);
  EXPECT_EQ(same.triangles, sphere.triangles);
}

/// Edges of a single triangle cannot be collapsed; something simpler has to be found all the same.
TEST(SimplerMeshTest, LooseTrianglesBecomeFewer) {
  const TriangleMesh sphere = Sphere(5);
  TriangleMesh loose;
  for (const auto& triangle : sphere.triangles) {
    for (const int i : triangle) loose.vertices.push_back(sphere.vertices[i]);
    const int end = static_cast<int>(loose.vertices.size());
    loose.triangles.push_back({end - 3, end - 2, end - 1});
  }
  const TriangleMesh simpler = SimplerMesh(loose, 500);
  EXPECT_LE(simpler.triangles.size(), 500u);
  EXPECT_GT(simpler.triangles.size(), 50u);
}

}  // namespace
}  // namespace possibility::experiments
