#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace possibility::models {

/// The file that a URDF names as a mesh.
///
/// `package://NAME/REST` is REST in the folder NAME that the nearest folder above the URDF holds,
/// or in the nearest such folder whose package.xml says it is the package NAME; after these come
/// the folders `packages`, in the same two ways. If none holds the package, REST is looked for in
/// the URDF's folder and in the one above. Any other name is relative to the URDF's folder
/// and must stay within that folder, the one that holds it (unless that is the root of the file
/// system), or one of `packages`. Links of the file system are followed before this is checked.
/// @throws InputError, one line that begins with `owner`, if the package is unknown, the file is
/// missing or it lies outside of these folders.
std::filesystem::path ResolveMeshPath(const std::string& name,
                                      const std::filesystem::path& urdf_file,
                                      const std::vector<std::filesystem::path>& packages,
                                      const std::string& owner);

}  // namespace possibility::models
