#include "experiments/viewer/simpler_mesh.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <vector>

namespace possibility::experiments {
namespace {

using Corner = unsigned int;

/// x, y and z of each vertex, as meshoptimizer takes them.
std::vector<float> Coordinates(const models::TriangleMesh& mesh) {
  std::vector<float> coordinates;
  coordinates.reserve(3 * mesh.vertices.size());
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    for (const double x : vertex) coordinates.push_back(static_cast<float>(x));
  }
  return coordinates;
}

std::vector<Corner> Corners(const models::TriangleMesh& mesh) {
  std::vector<Corner> corners;
  corners.reserve(3 * mesh.triangles.size());
  for (const auto& triangle : mesh.triangles) {
    corners.insert(corners.end(), triangle.begin(), triangle.end());
  }
  return corners;
}

/// These triangles of the mesh, with the vertices that they use.
models::TriangleMesh Part(const models::TriangleMesh& mesh, const std::vector<Corner>& corners) {
  models::TriangleMesh part;
  std::vector<int> place(mesh.vertices.size(), -1);
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
    std::array<int, 3> triangle;
    for (int k = 0; k < 3; ++k) {
      int& at = place[corners[i + k]];
      if (at < 0) {
        at = static_cast<int>(part.vertices.size());
        part.vertices.push_back(mesh.vertices[corners[i + k]]);
      }
      triangle[k] = at;
    }
    part.triangles.push_back(triangle);
  }
  return part;
}

}  // namespace

models::TriangleMesh SimplerMesh(const models::TriangleMesh& mesh, std::size_t most_triangles) {
  constexpr float kAnyError = 1;  // of the mesh's extent
  constexpr std::size_t kStride = 3 * sizeof(float);
  if (mesh.triangles.size() <= most_triangles) return mesh;
  const std::vector<float> coordinates = Coordinates(mesh);
  std::vector<Corner> corners = Corners(mesh);
  const std::size_t most = 3 * most_triangles, vertices = mesh.vertices.size();
  std::vector<Corner> fewer(corners.size());
  std::size_t count =
      meshopt_simplify(fewer.data(), corners.data(), corners.size(), coordinates.data(), vertices,
                       kStride, most, kAnyError, 0, nullptr);
  if (count >
      most) {  // open edges and vertices of several surfaces are kept by it, but not by this
    count = meshopt_simplifySloppy(fewer.data(), corners.data(), corners.size(), coordinates.data(),
                                   vertices, kStride, most, kAnyError, nullptr);
  }
  fewer.resize(count);
  return Part(mesh, fewer);
}

void SimplifyTogether(std::size_t most_triangles, std::vector<models::TriangleMesh>* meshes) {
  constexpr std::size_t kFewest = 100;  // enough for an outline
  std::size_t all = 0;
  for (const models::TriangleMesh& mesh : *meshes) all += mesh.triangles.size();
  if (all <= most_triangles) return;
  const double share = static_cast<double>(most_triangles) / static_cast<double>(all);
  for (models::TriangleMesh& mesh : *meshes) {
    const auto most = static_cast<std::size_t>(share * static_cast<double>(mesh.triangles.size()));
    mesh = SimplerMesh(mesh, std::max(most, kFewest));
  }
}

}  // namespace possibility::experiments
