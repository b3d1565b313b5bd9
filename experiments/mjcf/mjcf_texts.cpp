#include "experiments/mjcf/mjcf_texts.h"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>
#include <string_view>

namespace possibility::experiments {
namespace {

constexpr int kDeepest = 20;  // files that include each other for ever

/// What stands between two quotes behind `mark`.
std::optional<std::string> QuotedAfter(const std::string& text, const std::string& mark) {
  const std::size_t at = text.find(mark + "'");
  if (at == std::string::npos) return std::nullopt;
  const std::size_t begin = at + mark.size() + 1;
  const std::size_t end = text.find('\'', begin);
  if (end == std::string::npos || end == begin) return std::nullopt;
  return text.substr(begin, end - begin);
}

bool IsBlank(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }

/// One attribute of a tag: from its name to behind its closing quote.
struct Attribute {
  std::size_t begin = 0, end = 0;
  std::string_view name, value;
};

/// The next attribute at or after `at`; nothing at the tag's end.
std::optional<Attribute> NextAttribute(std::string_view text, std::size_t at) {
  while (at < text.size() && IsBlank(text[at])) ++at;
  if (at >= text.size() || text[at] == '>' || text[at] == '/') return std::nullopt;
  Attribute attribute;
  attribute.begin = at;
  while (at < text.size() && !IsBlank(text[at]) && text[at] != '=' && text[at] != '>') ++at;
  attribute.name = text.substr(attribute.begin, at - attribute.begin);
  while (at < text.size() && (IsBlank(text[at]) || text[at] == '=')) ++at;
  if (at >= text.size() || (text[at] != '"' && text[at] != '\'')) return std::nullopt;
  const std::size_t end = text.find(text[at], at + 1);
  if (end == std::string_view::npos) return std::nullopt;
  attribute.value = text.substr(at + 1, end - at - 1);
  attribute.end = end + 1;
  return attribute;
}

/// Blanks the attributes of all tags of `element` that are `unwanted`.
template <typename Predicate>
bool Blank(const std::string& element, const Predicate& unwanted, std::string* text) {
  bool found = false;
  const std::string tag = "<" + element;
  for (std::size_t at = 0; (at = text->find(tag, at)) != std::string::npos;) {
    at += tag.size();
    if (at >= text->size() || !IsBlank((*text)[at])) continue;
    while (const std::optional<Attribute> attribute = NextAttribute(*text, at)) {
      at = attribute->end;
      if (!unwanted(*attribute)) continue;
      std::replace_if(
          text->begin() + attribute->begin, text->begin() + attribute->end,
          [](char c) { return c != '\n'; }, ' ');
      found = true;
    }
  }
  return found;
}

/// Calls `visit` with all elements.
template <typename Visit>
void ForAll(const tinyxml2::XMLElement* element, int depth, const Visit& visit) {
  for (; element != nullptr && depth < 500; element = element->NextSiblingElement()) {
    visit(*element);
    ForAll(element->FirstChildElement(), depth + 1, visit);
  }
}

}  // namespace

void MjcfTexts::Add(const std::filesystem::path& file, int depth) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream || depth > kDeepest) return;
  std::string bytes{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  tinyxml2::XMLDocument document;
  if (document.Parse(bytes.data(), bytes.size()) != tinyxml2::XML_SUCCESS) return;
  texts_.push_back({file.filename().string(), std::move(bytes), false});
  ForAll(document.FirstChildElement(), 0, [&](const tinyxml2::XMLElement& element) {
    const std::string_view kind = element.Name();
    if (const char* included = element.Attribute("file");
        kind == "include" && included != nullptr) {
      Add(file.parent_path() / included, depth + 1);
    }
    const char* name = element.Attribute("name");
    const char* range = element.Attribute("actuatorfrcrange");
    if (kind != "joint" || name == nullptr || range == nullptr) return;
    std::istringstream numbers(range);
    double low = 0, high = 0;
    if (numbers >> low >> high) efforts_[name] = std::max(std::abs(low), std::abs(high));
  });
}

bool MjcfTexts::LimitByRanges() {
  if (texts_.empty() || texts_.front().bytes.find("autolimits") != std::string::npos) return false;
  std::string& text = texts_.front().bytes;
  const std::size_t root = text.find("<mujoco");
  const std::size_t end = root == std::string::npos ? root : text.find('>', root);
  if (end == std::string::npos || text[end - 1] == '/') return false;
  text.insert(end + 1, std::string_view("<compiler autolimits=\"true\"/>"));
  return texts_.front().has_changed = true;
}

bool MjcfTexts::LeaveOutMaterial(const std::string& material, std::vector<std::string>* findings) {
  const auto is_material = [&](const Attribute& attribute) {
    return attribute.name == "material" && attribute.value == material;
  };
  bool found = false;
  for (Text& text : texts_) {
    for (const char* element : {"geom", "site"}) {
      if (Blank(element, is_material, &text.bytes)) text.has_changed = found = true;
    }
  }
  if (found)
    findings->push_back(fmt::format("material '{}' is not defined, and left out", material));
  return found;
}

bool MjcfTexts::Mend(const std::string& message, std::vector<std::string>* findings) {
  if (message.find("autolimits") != std::string::npos) return LimitByRanges();
  if (const std::optional<std::string> material = QuotedAfter(message, "material ")) {
    return LeaveOutMaterial(*material, findings);
  }
  const std::optional<std::string> element = QuotedAfter(message, "Element ");
  const std::optional<std::string> name = QuotedAfter(message, "unrecognized attribute: ");
  const std::optional<std::string> value = QuotedAfter(message, "invalid keyword: ");
  if (!element || (!name && !value)) return false;
  bool found = false;
  for (Text& text : texts_) {
    const auto is_unknown = [&](const Attribute& attribute) {
      return (name && attribute.name == *name) || (value && attribute.value == *value);
    };
    if (Blank(*element, is_unknown, &text.bytes)) text.has_changed = found = true;
  }
  if (found && name != "actuatorfrcrange") {
    findings->push_back(fmt::format("'{}' of <{}> is left out: this MuJoCo does not know it",
                                    name ? *name : *value, *element));
  }
  return found;
}

std::vector<NamedBytes> MjcfTexts::Changed() const {
  std::vector<NamedBytes> changed;
  for (const Text& text : texts_) {
    if (text.has_changed) changed.push_back({text.name, text.bytes});
  }
  return changed;
}

}  // namespace possibility::experiments
