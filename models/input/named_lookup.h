#pragma once

#include <fmt/format.h>

#include <string>
#include <vector>

#include "models/input/nearest_name.h"
#include "models/input/yaml_reader.h"

namespace possibility::models {

/// Index of the item (anything with a `name`) that the node's text names.
/// @throws InputError at the node with the nearest known name.
template <typename Named>
int IndexOfNamed(const YamlNode& node, const std::vector<Named>& items, const std::string& kind) {
  const std::string name = node.String();
  std::vector<std::string> known;
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (items[i].name == name) return static_cast<int>(i);
    known.push_back(items[i].name);
  }
  node.Fail(fmt::format("unknown {} '{}'{}", kind, name, DidYouMean(name, known)));
}

/// The same for every element of a list, each at most once.
template <typename Named>
std::vector<int> IndicesOfNamed(const YamlNode& list, const std::vector<Named>& items,
                                const std::string& kind) {
  std::vector<int> indices;
  for (const YamlNode& node : list.Items()) {
    const int index = IndexOfNamed(node, items, kind);
    for (const int other : indices) {
      if (other == index) node.Fail(fmt::format("{} '{}' is listed twice", kind, node.String()));
    }
    indices.push_back(index);
  }
  return indices;
}

}  // namespace possibility::models
