#pragma once

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cstdint>
#include <cstring>
#include <string>

#include "models/mesh/triangle_mesh.h"

namespace possibility::models::testing {

/// Bytes of a number as little-endian machines store it.
template <typename Number>
std::string BytesOf(Number number) {
  std::string bytes(sizeof(number), '\0');
  std::memcpy(bytes.data(), &number, sizeof(number));
  return bytes;
}

inline std::string TextStl(const TriangleMesh& mesh) {
  std::string text = "solid test\n";
  for (const auto& triangle : mesh.triangles) {
    text += "facet normal 0 0 0\n outer loop\n";
    for (const int i : triangle) {
      const Eigen::Vector3d& p = mesh.vertices[i];
      text += fmt::format("  vertex {:.9g} {:.9g} {:.9g}\n", p.x(), p.y(), p.z());
    }
    text += " endloop\nendfacet\n";
  }
  return text + "endsolid test\n";
}

inline std::string BinaryStl(const TriangleMesh& mesh) {
  std::string bytes(80, ' ');
  bytes += BytesOf(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const auto& triangle : mesh.triangles) {
    for (int i = 0; i < 3; ++i) bytes += BytesOf(0.0f);
    for (const int i : triangle) {
      for (const double c : mesh.vertices[i]) bytes += BytesOf(static_cast<float>(c));
    }
    bytes += BytesOf(std::uint16_t{0});
  }
  return bytes;
}

inline std::string Obj(const TriangleMesh& mesh) {
  std::string text = "# test\nmtllib none.mtl\n";
  for (const Eigen::Vector3d& p : mesh.vertices) {
    text += fmt::format("v {:.9g} {:.9g} {:.9g}\n", p.x(), p.y(), p.z());
  }
  for (const auto& t : mesh.triangles)
    text += fmt::format("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
  return text;
}

inline std::string PlyHead(const TriangleMesh& mesh, const std::string& format) {
  return fmt::format(
      "ply\nformat {} 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float "
      "z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
      format, mesh.vertices.size(), mesh.triangles.size());
}

inline std::string TextPly(const TriangleMesh& mesh) {
  std::string text = PlyHead(mesh, "ascii");
  for (const Eigen::Vector3d& p : mesh.vertices) {
    text += fmt::format("{:.9g} {:.9g} {:.9g}\n", p.x(), p.y(), p.z());
  }
  for (const auto& t : mesh.triangles) text += fmt::format("3 {} {} {}\n", t[0], t[1], t[2]);
  return text;
}

inline std::string BinaryPly(const TriangleMesh& mesh) {
  std::string bytes = PlyHead(mesh, "binary_little_endian");
  for (const Eigen::Vector3d& p : mesh.vertices) {
    for (const double c : p) bytes += BytesOf(static_cast<float>(c));
  }
  for (const auto& t : mesh.triangles) {
    bytes += '\3';
    for (const int i : t) bytes += BytesOf(static_cast<std::int32_t>(i));
  }
  return bytes;
}

/// `metres`: the file's unit. `up`: "X_UP", "Y_UP" or "Z_UP".
inline std::string Collada(const TriangleMesh& mesh, double metres, const std::string& up) {
  std::string numbers, triangles;
  for (const Eigen::Vector3d& p : mesh.vertices) {
    numbers += fmt::format("{:.9g} {:.9g} {:.9g} ", p.x(), p.y(), p.z());
  }
  for (const auto& t : mesh.triangles) triangles += fmt::format("{} {} {} ", t[0], t[1], t[2]);
  return fmt::format(
      "<?xml version=\"1.0\"?>\n<COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" "
      "version=\"1.4.1\"><asset><unit name=\"unit\" meter=\"{}\"/><up_axis>{}</up_axis></asset>"
      "<library_geometries><geometry id=\"body\"><mesh><source id=\"places\"><float_array "
      "id=\"numbers\" count=\"{}\">{}</float_array><technique_common><accessor source=\"#numbers\" "
      "count=\"{}\" stride=\"3\"><param name=\"X\" type=\"float\"/><param name=\"Y\" "
      "type=\"float\"/><param name=\"Z\" type=\"float\"/></accessor></technique_common></source>"
      "<vertices id=\"corners\"><input semantic=\"POSITION\" source=\"#places\"/></vertices>"
      "<triangles count=\"{}\"><input semantic=\"VERTEX\" source=\"#corners\" "
      "offset=\"0\"/><p>{}</p></triangles></mesh></geometry></library_geometries>"
      "<library_visual_scenes><visual_scene id=\"scene\"><node><instance_geometry "
      "url=\"#body\"/></node></visual_scene></library_visual_scenes><scene>"
      "<instance_visual_scene url=\"#scene\"/></scene></COLLADA>\n",
      metres, up, 3 * mesh.vertices.size(), numbers, mesh.vertices.size(), mesh.triangles.size(),
      triangles);
}

/// A box with its lowest corner at the origin, normals outwards.
inline TriangleMesh BoxMesh(const Eigen::Vector3d& size) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.emplace_back((i & 1) * size.x(), (i >> 1 & 1) * size.y(), (i >> 2) * size.z());
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

/// Of a closed mesh; negative if its normals point inwards.
inline double EnclosedVolume(const TriangleMesh& mesh) {
  double volume = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    volume += mesh.AreaVector(static_cast<int>(i)).dot(mesh.vertices[mesh.triangles[i][0]]) / 6;
  }
  return volume;
}

/// Puts the triangles of `other` beside those of `mesh`, without joining corners.
inline void Append(const TriangleMesh& other, TriangleMesh* mesh) {
  const auto first = static_cast<int>(mesh->vertices.size());
  mesh->vertices.insert(mesh->vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const auto& t : other.triangles) {
    mesh->triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
}

}  // namespace possibility::models::testing
