#include "models/robot/mesh_path.h"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <optional>
#include <system_error>

#include "models/input/input_error.h"

namespace possibility::models {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPackageScheme = "package://";
constexpr std::string_view kFileScheme = "file://";

bool IsFolder(const fs::path& path) {
  std::error_code error;
  return fs::is_directory(path, error);
}

fs::path Canonical(const fs::path& path) {
  std::error_code error;
  const fs::path absolute = fs::absolute(path, error);
  const fs::path canonical = fs::weakly_canonical(absolute, error);
  return error ? absolute.lexically_normal() : canonical;
}

/// Whether a canonical path is in a canonical folder.
bool IsWithin(const fs::path& path, const fs::path& folder) {
  const auto [end, rest] = std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
  return end == folder.end() && rest != path.end();
}

/// The name that a folder's package.xml gives; empty if there is none.
std::string PackageName(const fs::path& folder) {
  std::error_code error;
  const fs::path file = folder / "package.xml";
  constexpr std::uintmax_t kLargest = 1 << 20;
  if (!fs::is_regular_file(file, error) || fs::file_size(file, error) > kLargest) return "";
  tinyxml2::XMLDocument document;
  if (document.LoadFile(file.c_str()) != tinyxml2::XML_SUCCESS) return "";
  const tinyxml2::XMLElement* package = document.FirstChildElement("package");
  const tinyxml2::XMLElement* name = package ? package->FirstChildElement("name") : nullptr;
  return name && name->GetText() ? name->GetText() : "";
}

std::vector<fs::path> FoldersAbove(const fs::path& urdf_folder) {
  std::vector<fs::path> folders;
  for (fs::path folder = urdf_folder;; folder = folder.parent_path()) {
    folders.push_back(folder);
    if (folder == folder.parent_path()) return folders;
  }
}

/// The folder of a package, looked for in `folders` in order.
std::optional<fs::path> FindPackage(const std::string& name, const std::vector<fs::path>& folders) {
  for (const fs::path& folder : folders) {
    if (IsFolder(folder / name)) return Canonical(folder / name);
    if (PackageName(folder) == name) return Canonical(folder);
  }
  return std::nullopt;
}

/// Where robots are published without their package's folder: beside the URDF, or one folder above.
std::optional<fs::path> FolderOfPartialPackage(const fs::path& rest, const fs::path& urdf_folder) {
  std::error_code error;
  const fs::path above = urdf_folder.parent_path();
  if (fs::is_regular_file(urdf_folder / rest, error)) return urdf_folder;
  if (above != above.root_path() && fs::is_regular_file(above / rest, error)) return above;
  return std::nullopt;
}

bool IsPlainName(const std::string& name) {
  return !name.empty() && name != "." && name != ".." && name.find('/') == std::string::npos;
}

fs::path InPackage(const std::string& name, const fs::path& urdf_folder,
                   const std::vector<fs::path>& packages, const std::string& owner) {
  // Some write package:///NAME.
  const std::string rest =
      name.substr(std::min(name.size(), name.find_first_not_of('/', kPackageScheme.size())));
  const std::size_t slash = rest.find('/');
  const std::string package = rest.substr(0, slash);
  if (!IsPlainName(package) || slash == std::string::npos) {
    throw InputError(fmt::format("{}: expected package://NAME/FILE, got '{}'", owner, name));
  }
  std::vector<fs::path> folders = FoldersAbove(urdf_folder);
  folders.insert(folders.end(), packages.begin(), packages.end());
  const fs::path in_package = fs::path(rest.substr(slash + 1)).relative_path();
  std::optional<fs::path> folder = FindPackage(package, folders);
  if (!folder) folder = FolderOfPartialPackage(in_package, urdf_folder);
  if (!folder) {
    throw InputError(fmt::format(
        "{}: no folder above the URDF holds the package '{}' of '{}': name one under 'packages'",
        owner, package, name));
  }
  const fs::path file = Canonical(*folder / in_package);
  if (!IsWithin(file, *folder)) {
    throw InputError(fmt::format("{}: '{}' leaves its package", owner, name));
  }
  return file;
}

fs::path BesideUrdf(const std::string& name, const fs::path& urdf_folder,
                    const std::vector<fs::path>& packages, const std::string& owner) {
  const bool is_url = name.starts_with(kFileScheme);
  const fs::path file = Canonical(urdf_folder / (is_url ? name.substr(kFileScheme.size()) : name));
  std::vector<fs::path> allowed = {urdf_folder};
  const fs::path above = urdf_folder.parent_path();
  if (above != above.root_path()) allowed.push_back(above);
  for (const fs::path& folder : packages) allowed.push_back(Canonical(folder));
  const auto holds_it = [&file](const fs::path& folder) { return IsWithin(file, folder); };
  if (!std::any_of(allowed.begin(), allowed.end(), holds_it)) {
    throw InputError(fmt::format(
        "{}: '{}' is outside of the URDF's folder, the one above and those under 'packages'", owner,
        name));
  }
  return file;
}

}  // namespace

fs::path ResolveMeshPath(const std::string& name, const fs::path& urdf_file,
                         const std::vector<fs::path>& packages, const std::string& owner) {
  const fs::path urdf_folder = Canonical(urdf_file).parent_path();
  const fs::path file = name.starts_with(kPackageScheme)
                            ? InPackage(name, urdf_folder, packages, owner)
                            : BesideUrdf(name, urdf_folder, packages, owner);
  std::error_code error;
  if (!fs::is_regular_file(file, error)) {
    throw InputError(fmt::format("{}: no such file: {}", owner, file.string()));
  }
  return file;
}

}  // namespace possibility::models
