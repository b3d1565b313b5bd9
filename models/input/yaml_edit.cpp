#include "models/input/yaml_edit.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <charconv>
#include <cstddef>

#include "models/input/input_error.h"

namespace possibility::models {
namespace {

/// A piece of the text that gives way to another.
struct Replacement {
  std::size_t begin = 0;
  std::size_t length = 0;
  std::string text;
};

class Editor {
 public:
  Editor(const std::string& text, const std::filesystem::path& file) : text_(text), file_(file) {}

  Replacement Of(const YAML::Node& root, const YamlEdit& edit) const {
    YAML::Node node = root;
    for (std::size_t i = 0; i < edit.path.size(); ++i) {
      const bool is_last = i + 1 == edit.path.size();
      const YAML::Node child = Child(node, edit.path[i]);
      if (!child.IsDefined()) {
        if (is_last && node.IsMap()) return Insertion(node, edit);
        Fail(edit, "no such key");
      }
      node.reset(child);
    }
    if (!node.IsScalar()) Fail(edit, "expected a number");
    const std::size_t begin = Position(node, edit);
    const std::string& scalar = node.Scalar();
    if (text_.compare(begin, scalar.size(), scalar) != 0) Fail(edit, "expected a plain number");
    return {begin, scalar.size(), edit.value};
  }

 private:
  [[noreturn]] void Fail(const YamlEdit& edit, const std::string& what) const {
    throw InputError(fmt::format("{}: {}: {}", file_.string(), fmt::join(edit.path, "."), what));
  }

  static YAML::Node Child(const YAML::Node& node, const std::string& key) {
    if (node.IsMap()) return node[key];
    std::size_t index = 0;
    const auto [end, error] = std::from_chars(key.data(), key.data() + key.size(), index);
    const bool is_index = error == std::errc() && end == key.data() + key.size();
    if (!node.IsSequence() || !is_index || index >= node.size()) {
      return YAML::Node(YAML::NodeType::Undefined);
    }
    return node[index];
  }

  std::size_t Position(const YAML::Node& node, const YamlEdit& edit) const {
    const YAML::Mark mark = node.Mark();
    if (mark.pos < 0 || static_cast<std::size_t>(mark.pos) >= text_.size()) {
      Fail(edit, "its place in the file is unknown");
    }
    return static_cast<std::size_t>(mark.pos);
  }

  Replacement Insertion(const YAML::Node& map, const YamlEdit& edit) const {
    const std::size_t begin = Position(map, edit);
    const std::string entry = fmt::format("\"{}\": {}", edit.path.back(), edit.value);
    if (text_[begin] == '{') return {begin + 1, 0, entry + (map.size() > 0 ? ", " : "")};
    return {begin, 0, entry + "\n" + std::string(static_cast<std::size_t>(map.Mark().column), ' ')};
  }

  const std::string& text_;
  const std::filesystem::path& file_;
};

}  // namespace

std::string WithYamlEdits(const std::string& text, const std::filesystem::path& file,
                          const std::vector<YamlEdit>& edits) {
  YAML::Node root;
  try {
    root = YAML::Load(text);
  } catch (const YAML::Exception& error) {
    throw InputError(fmt::format("{}: not valid YAML: {}", file.string(), error.msg));
  }
  const Editor editor(text, file);
  std::vector<Replacement> replacements;
  replacements.reserve(edits.size());
  for (const YamlEdit& edit : edits) replacements.push_back(editor.Of(root, edit));
  std::stable_sort(replacements.begin(), replacements.end(),
                   [](const Replacement& a, const Replacement& b) { return a.begin > b.begin; });
  std::string edited = text;
  for (const Replacement& replacement : replacements) {
    edited.replace(replacement.begin, replacement.length, replacement.text);
  }
  return edited;
}

}  // namespace possibility::models
