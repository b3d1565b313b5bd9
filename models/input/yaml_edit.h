#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace possibility::models {

/// A scalar of a YAML text and its new value.
struct YamlEdit {
  std::vector<std::string> path;  ///< keys, and numbers of list elements from 0
  std::string value;              ///< as it stands in the file
};

/// The text with these scalars replaced; all else, comments too, stays as it is. A last key that
/// its map has not yet is added at the map's beginning.
/// @throws InputError naming file and key where the path leads to no plain scalar of a map, or the
/// text is not YAML.
std::string WithYamlEdits(const std::string& text, const std::filesystem::path& file,
                          const std::vector<YamlEdit>& edits);

}  // namespace possibility::models
