#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>

#include "models/mesh/triangle_mesh.h"

namespace possibility::models {

/// More samples than this would become more than kMostTriangles triangles.
inline constexpr std::size_t kMostSamples = kMostTriangles / 2;

/// Reads a map of heights: a PNG (grey, 8 or 16 bits) or a CSV (a row of numbers on each line, with
/// commas), told apart by the name's ending. Rows and columns are those of the picture or text: the
/// first row is the topmost one.
/// @throws InputError, one line with the file, if it is missing or malformed, its rows differ in
/// length, a number is endless, the picture has colours, a palette or transparency, or there are
/// fewer than 2 x 2 or more than kMostSamples samples.
Eigen::MatrixXd ReadHeights(const std::filesystem::path& file);

/// Whether a file's name ends in .png, in small letters or capitals.
bool EndsInPng(const std::filesystem::path& file);

/// The same as ReadHeights from the file's bytes.
Eigen::MatrixXd ParseHeights(const std::string& bytes, const std::filesystem::path& file);

/// The surface through all samples, `cell` (m) apart: x along the rows to the right, y up the
/// picture, the bottom left sample at the origin. Each cell becomes two triangles; their common
/// side joins the corners that differ less in height, so that a flat cell stays flat and a corner
/// that sticks out takes only its own triangle along.
TriangleMesh MeshOfHeights(const Eigen::MatrixXd& heights, double cell);

}  // namespace possibility::models
