#pragma once

#include <cstddef>
#include <vector>

#include "models/mesh/triangle_mesh.h"

namespace possibility::experiments {

/// A mesh that looks like `mesh` with at most `most_triangles` triangles, by collapsing edges where
/// that changes the surface least (meshoptimizer). Only for the eye: it may lie on either side of
/// the surface.
models::TriangleMesh SimplerMesh(const models::TriangleMesh& mesh, std::size_t most_triangles);

/// Simplifies meshes that are seen together, so that all of them have about `most_triangles` in
/// all. Each keeps the same share of its triangles, but at least a hundred.
void SimplifyTogether(std::size_t most_triangles, std::vector<models::TriangleMesh>* meshes);

}  // namespace possibility::experiments
