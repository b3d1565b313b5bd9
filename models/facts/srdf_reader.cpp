#include "models/facts/srdf_reader.h"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <set>

#include "models/input/file_contents.h"
#include "models/input/input_error.h"

namespace possibility::models {
namespace {

using tinyxml2::XMLElement;

/// Short, printable, in one line.
std::string Shown(const std::string& text) {
  constexpr std::size_t kLongest = 60;
  std::string shown = text.substr(0, kLongest);
  for (char& c : shown) {
    if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) == 0x7f) c = ' ';
  }
  return shown;
}

class SrdfParser {
 public:
  SrdfParser(std::string file, const UrdfTree& tree) : file_(std::move(file)) {
    for (const UrdfLink& link : tree.links) links_.insert(link.name);
    for (const UrdfJoint& joint : tree.joints) {
      joints_.insert(joint.name);
      if (joint.type != "fixed") moving_.insert(joint.name);
    }
  }

  Srdf Parse(const std::string& text) {
    tinyxml2::XMLDocument document;
    if (const auto error = document.Parse(text.data(), text.size());
        error != tinyxml2::XML_SUCCESS) {
      Fail(document.ErrorLineNum(), fmt::format("not a valid SRDF: no XML ({})",
                                                tinyxml2::XMLDocument::ErrorIDToName(error)));
    }
    const XMLElement* robot = document.FirstChildElement("robot");
    if (robot == nullptr) Fail(1, "not a valid SRDF: expected a <robot> element");
    ForEach(*robot, "group", [this](const XMLElement& e) { ReadGroup(e); });
    ForEach(*robot, "group_state", [this](const XMLElement& e) { ReadState(e); });
    ForEach(*robot, "end_effector", [this](const XMLElement& e) { ReadEndEffector(e); });
    ForEach(*robot, "disable_collisions", [this](const XMLElement& e) { ReadDisabled(e); });
    return std::move(srdf_);
  }

 private:
  [[noreturn]] void Fail(int line, const std::string& what) const {
    throw InputError(fmt::format("{}:{}: {}", file_, std::max(line, 1), what));
  }
  [[noreturn]] void Fail(const XMLElement& e, const std::string& what) const {
    Fail(e.GetLineNum(), fmt::format("<{}>: {}", Shown(e.Name()), what));
  }

  template <typename Read>
  static void ForEach(const XMLElement& parent, const char* name, const Read& read) {
    for (const XMLElement* e = parent.FirstChildElement(name); e; e = e->NextSiblingElement(name)) {
      read(*e);
    }
  }

  std::string Name(const XMLElement& e, const char* attribute) const {
    const char* value = e.Attribute(attribute);
    if (value == nullptr || *value == '\0') Fail(e, fmt::format("expected a {}", attribute));
    return value;
  }

  std::string NameIn(const std::set<std::string>& known, const XMLElement& e, const char* attribute,
                     const char* kind) const {
    std::string name = Name(e, attribute);
    if (!known.contains(name)) Fail(e, fmt::format("unknown {} '{}'", kind, Shown(name)));
    return name;
  }

  void ReadGroup(const XMLElement& e) {
    SrdfGroup group;
    group.name = Name(e, "name");
    for (const SrdfGroup& other : srdf_.groups) {
      if (other.name == group.name)
        Fail(e, fmt::format("'{}' is already taken", Shown(group.name)));
    }
    ForEach(e, "joint", [&](const XMLElement& c) {
      // The joint to the world is no joint of the URDF.
      if (const std::string name = Name(c, "name"); joints_.contains(name)) {
        group.joints.push_back(name);
      }
    });
    ForEach(e, "link",
            [&](const XMLElement& c) { group.links.push_back(NameIn(links_, c, "name", "link")); });
    ForEach(e, "chain", [&](const XMLElement& c) {
      group.chains.emplace_back(NameIn(links_, c, "base_link", "link"),
                                NameIn(links_, c, "tip_link", "link"));
    });
    ForEach(e, "group", [&](const XMLElement& c) { group.groups.push_back(Name(c, "name")); });
    srdf_.groups.push_back(std::move(group));
  }

  /// None for several values.
  std::optional<double> Value(const XMLElement& e) const {
    const std::string text = Name(e, "value");
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    while (*end == ' ' || *end == '\t' || *end == '\n') ++end;
    const bool is_number = end != text.c_str() && std::isfinite(value) && std::abs(value) <= 1e6;
    if (is_number && *end == '\0') return value;
    if (is_number && (std::isdigit(static_cast<unsigned char>(*end)) != 0 || *end == '-')) {
      return std::nullopt;
    }
    Fail(e, fmt::format("value: expected a number, got '{}'", Shown(text)));
  }

  void ReadState(const XMLElement& e) {
    SrdfState state{Name(e, "name"), Name(e, "group"), {}};
    ForEach(e, "joint", [&](const XMLElement& c) {
      const std::string name = Name(c, "name");
      const std::optional<double> value = Value(c);
      if (value && moving_.contains(name)) state.joints[name] = *value;
    });
    srdf_.states.push_back(std::move(state));
  }

  void ReadEndEffector(const XMLElement& e) {
    srdf_.end_effectors.push_back(
        {Name(e, "name"), NameIn(links_, e, "parent_link", "link"), Name(e, "group")});
  }

  void ReadDisabled(const XMLElement& e) {
    const char* reason = e.Attribute("reason");
    SrdfDisabledPair pair{Name(e, "link1"), Name(e, "link2"),
                          reason == nullptr ? "" : Shown(reason)};
    // Files are shared by variants of a robot.
    if (!links_.contains(pair.link1) || !links_.contains(pair.link2)) return;
    srdf_.disabled.push_back(std::move(pair));
  }

  const std::string file_;
  std::set<std::string> links_, joints_, moving_;
  Srdf srdf_;
};

}  // namespace

Srdf ParseSrdf(const std::string& text, const std::filesystem::path& file, const UrdfTree& tree) {
  if (text.find('\0') != std::string::npos) {
    throw InputError(file.string() + ": not a text file, expected an SRDF");
  }
  return SrdfParser(file.string(), tree).Parse(text);
}

Srdf ReadSrdf(const std::filesystem::path& file, const UrdfTree& tree) {
  return ParseSrdf(ReadFileContents(file), file, tree);
}

}  // namespace possibility::models
