#include "models/input/action_name.h"

#include <algorithm>

#include "models/input/yaml_reader.h"

namespace possibility::models {
namespace {

constexpr std::size_t kLongest = 64;

/// ASCII only, in any locale.
bool IsLetter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

bool IsDigit(char c) { return c >= '0' && c <= '9'; }

}  // namespace

bool IsActionName(std::string_view name) {
  if (name.empty() || name.size() > kLongest || !IsLetter(name.front())) return false;
  return std::all_of(name.begin(), name.end(),
                     [](char c) { return IsLetter(c) || IsDigit(c) || c == '_' || c == '-'; });
}

std::string ReadActionName(const YamlNode& node) {
  std::string name = node.String();
  if (!IsActionName(name)) node.FailExpected(kActionNameRule);
  return name;
}

}  // namespace possibility::models
