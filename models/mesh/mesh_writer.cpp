#include "models/mesh/mesh_writer.h"

#include <bit>
#include <cstdint>
#include <type_traits>

namespace possibility::models {
namespace {

static_assert(std::endian::native == std::endian::little, "STL files are little-endian");

template <typename Number>
void Append(Number number, std::string* bytes) {
  static_assert(std::is_arithmetic_v<Number>);
  bytes->append(reinterpret_cast<const char*>(&number), sizeof number);
}

}  // namespace

std::string BinaryStl(const TriangleMesh& mesh) {
  constexpr std::size_t kHead = 80, kTriangle = 50;
  std::string bytes(kHead, ' ');
  bytes.reserve(kHead + 4 + kTriangle * mesh.triangles.size());
  Append(static_cast<std::uint32_t>(mesh.triangles.size()), &bytes);
  for (const auto& triangle : mesh.triangles) {
    for (int k = 0; k < 3; ++k) Append(0.0f, &bytes);
    for (const int corner : triangle) {
      for (const double x : mesh.vertices[corner]) Append(static_cast<float>(x), &bytes);
    }
    Append(std::uint16_t{0}, &bytes);
  }
  return bytes;
}

}  // namespace possibility::models
