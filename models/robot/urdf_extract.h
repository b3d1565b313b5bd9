#pragma once

#include <filesystem>
#include <string>

namespace possibility::models {

/// What we use of a URDF, as a URDF of its own: links with mass properties and collision shapes,
/// joints with origin, axis, limits and mimic. Nothing else is copied.
///
/// urdfdom 3 hands texts of the file to printf as formats, so no '%' may get there, and no element
/// nested deeper than its parser's stack. The extract holds no '%': in names, where it is legal, a
/// byte that XML forbids stands for it; elsewhere it is an error.
/// @throws InputError if the text is not XML, or something we use cannot be in any URDF.
std::string ExtractUrdf(const std::string& text, const std::filesystem::path& file);

/// A name of the extract, or a message about it, as in the file.
std::string DecodeUrdfName(std::string name);

}  // namespace possibility::models
