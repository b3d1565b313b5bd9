#pragma once

#include <string>

#include "models/mesh/triangle_mesh.h"

namespace possibility::models {

/// The bytes of a binary STL file, in single precision and with normals of zero: they follow from
/// the corners.
std::string BinaryStl(const TriangleMesh& mesh);

}  // namespace possibility::models
