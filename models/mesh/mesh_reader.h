#pragma once

#include <filesystem>
#include <string>

#include "models/mesh/triangle_mesh.h"

namespace possibility::models {

/// Reads an STL (binary or text), OBJ, PLY or Collada (.dae) file, told apart by the name's ending.
/// All parts of the file become one mesh, in the file's unit; Collada files name their unit, and
/// are read in metres, whatever they call up; polygons become triangles. Corners at the same
/// place become one vertex; triangles without area and vertices without a triangle are left out.
/// Coordinates are read in single precision. Nothing but the file itself is opened: material files
/// do not matter. The library that reads it runs in a process of its own, because it crashes over
/// some spoilt files.
/// @throws InputError, one line with the file, if it is missing or malformed, has an endless number
/// or no triangle with an area, or more than kMostTriangles triangles.
TriangleMesh ReadMesh(const std::filesystem::path& file);

/// The same from the file's bytes.
TriangleMesh ParseMesh(const std::string& bytes, const std::filesystem::path& file);

}  // namespace possibility::models
