#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace possibility::models {

/// Which of a link's geometry is read.
enum class UrdfGeometry { kCollision, kVisual };

/// What the extract calls a `<collision>` that is a capsule: its geometry is a cylinder there,
/// since urdfdom 3 knows no capsules. Its length leaves out the two half spheres.
inline constexpr char kCapsuleName[] = "capsule";

/// Copies the parts of a URDF that we use into a URDF of their own: links with mass properties and
/// collision shapes, joints with origin, axis, limits and mimic. Nothing else is copied.
///
/// urdfdom 3 passes texts of the file to printf as formats, and deeply nested elements overflow its
/// parser's stack. The extract therefore has no '%' and no deep nesting. In names, where '%' is
/// legal, a byte that XML forbids replaces it; elsewhere '%' is an error.
/// A mesh's file name may contain anything: the extract has a number in its place, which counts
/// from 0 in the order of the file. `mesh_files`, if given, gets the names. With `kVisual`,
/// `<visual>` elements take the place of the `<collision>` ones.
/// @throws InputError if the text is not XML, or a part that we use is not valid in any URDF.
std::string ExtractUrdf(const std::string& text, const std::filesystem::path& file,
                        std::vector<std::string>* mesh_files = nullptr,
                        UrdfGeometry geometry = UrdfGeometry::kCollision);

/// Restores the '%' in a name of the extract, or in a message about it.
std::string DecodeUrdfName(std::string name);

}  // namespace possibility::models
