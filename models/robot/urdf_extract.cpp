#include "models/robot/urdf_extract.h"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "models/input/input_error.h"

namespace possibility::models {
namespace {

constexpr char kPercent = '\x1a';  // XML 1.0 forbids control characters except white space
constexpr int kMostElements = 2000;

/// An element to copy, with the attributes and children to copy with it.
struct Element {
  std::string_view name;  ///< empty: any name
  std::vector<const char*> names;
  std::vector<const char*> values;
  std::vector<Element> children;
};

const Element& Robot() {
  static const Element origin{"origin", {}, {"xyz", "rpy"}, {}};
  static const Element geometry{
      "geometry",
      {},
      {},
      {{"mesh", {}, {"scale"}, {}}, {"", {}, {"size", "radius", "length"}, {}}}};
  static const Element inertial{"inertial",
                                {},
                                {},
                                {origin,
                                 {"mass", {}, {"value"}, {}},
                                 {"inertia", {}, {"ixx", "ixy", "ixz", "iyy", "iyz", "izz"}, {}}}};
  static const Element link{
      "link", {"name"}, {}, {inertial, {"collision", {}, {}, {origin, geometry}}}};
  static const Element joint{"joint",
                             {"name"},
                             {"type"},
                             {origin,
                              {"parent", {"link"}, {}, {}},
                              {"child", {"link"}, {}, {}},
                              {"axis", {}, {"xyz"}, {}},
                              {"limit", {}, {"lower", "upper", "effort", "velocity"}, {}},
                              {"mimic", {"joint"}, {"multiplier", "offset"}, {}}}};
  static const Element robot{"robot", {"name"}, {"version"}, {link, joint}};
  return robot;
}

bool HoldsACapsule(const tinyxml2::XMLElement& collision) {
  const tinyxml2::XMLElement* geometry = collision.FirstChildElement("geometry");
  return geometry != nullptr && geometry->FirstChildElement("capsule") != nullptr;
}

bool IsControl(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return byte == 0x7f || (byte < 0x20 && c != '\t' && c != '\n' && c != '\r');
}

/// Quoted for a message of one line.
std::string Quoted(std::string_view text) {
  constexpr std::size_t kLongest = 60;
  std::string quoted(text.substr(0, kLongest));
  for (char& c : quoted) {
    if (IsControl(c) || c == '\n' || c == '\r') c = ' ';
  }
  return fmt::format("'{}{}'", quoted, text.size() > kLongest ? "..." : "");
}

std::string Described(tinyxml2::XMLError error) {
  switch (error) {
    case tinyxml2::XML_ERROR_PARSING:
      return "an element has no end";
    case tinyxml2::XML_ERROR_MISMATCHED_ELEMENT:
      return "an element ends that another one has begun after";
    case tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED:
      return "elements are nested too deeply";
    default:
      return fmt::format("no XML ({})", tinyxml2::XMLDocument::ErrorIDToName(error));
  }
}

class Extraction {
 public:
  Extraction(const std::filesystem::path& file, UrdfGeometry geometry)
      : file_(file.string()), geometry_(geometry) {}

  const std::vector<std::string>& mesh_files() const { return mesh_files_; }

  std::string Run(const std::string& text) {
    tinyxml2::XMLDocument document;
    if (const tinyxml2::XMLError error = document.Parse(text.data(), text.size());
        error != tinyxml2::XML_SUCCESS) {
      Fail(document.ErrorLineNum(), fmt::format("not a valid URDF: {}", Described(error)));
    }
    const tinyxml2::XMLElement* robot = document.FirstChildElement("robot");
    if (robot == nullptr) Fail(1, "not a valid URDF: expected a <robot> element");
    Copy(*robot, Robot());
    return printer_.CStr();
  }

 private:
  [[noreturn]] void Fail(int line, const std::string& what) const {
    throw InputError(fmt::format("{}:{}: {}", file_, std::max(line, 1), what));
  }

  /// Null: left out.
  const char* NameInExtract(const tinyxml2::XMLElement& source) const {
    const std::string_view name = source.Name();
    const bool is_visual = geometry_ == UrdfGeometry::kVisual;
    if (name == "visual") return is_visual ? "collision" : nullptr;
    if (name == "collision") return is_visual ? nullptr : "collision";
    return name == "capsule" ? "cylinder" : source.Name();
  }

  void Copy(const tinyxml2::XMLElement& source, const Element& element) {
    printer_.OpenElement(NameInExtract(source), true);
    if (element.name == "collision" && HoldsACapsule(source)) {
      printer_.PushAttribute("name", kCapsuleName);
    }
    for (const char* name : element.names) CopyAttribute(source, name, true);
    for (const char* name : element.values) CopyAttribute(source, name, false);
    for (const auto* child = source.FirstChildElement(); child != nullptr;
         child = child->NextSiblingElement()) {
      CopyChild(*child, element);
    }
    printer_.CloseElement(true);
  }

  void CopyChild(const tinyxml2::XMLElement& source, const Element& parent) {
    const char* name = NameInExtract(source);
    if (name == nullptr) return;
    const auto found = std::find_if(
        parent.children.begin(), parent.children.end(),
        [&](const Element& child) { return child.name.empty() || child.name == name; });
    if (found == parent.children.end()) return;
    if (&parent == &Robot() && ++num_elements_ > kMostElements) {
      Fail(source.GetLineNum(), fmt::format("expected at most {} links and joints", kMostElements));
    }
    if (found->name != "mesh") return Copy(source, *found);
    printer_.OpenElement("mesh", true);
    CopyMeshName(source);
    for (const char* name : found->values) CopyAttribute(source, name, false);
    printer_.CloseElement(true);
  }

  void CopyMeshName(const tinyxml2::XMLElement& mesh) {
    const char* value = mesh.Attribute("filename");
    const std::string name = value == nullptr ? "" : value;
    if (name.empty()) Fail(mesh.GetLineNum(), "<mesh>: expected a filename");
    if (std::any_of(name.begin(), name.end(), &IsControl)) {
      FailAt(mesh, "filename", name, "no control characters");
    }
    printer_.PushAttribute("filename", static_cast<unsigned>(mesh_files_.size()));
    mesh_files_.push_back(name);
  }

  void CopyAttribute(const tinyxml2::XMLElement& source, const char* name, bool is_name) {
    const char* value = source.Attribute(name);
    if (value == nullptr) return;
    std::string copy = value;
    if (std::any_of(copy.begin(), copy.end(), &IsControl)) {
      FailAt(source, name, copy, "no control characters");
    }
    if (!is_name && copy.find('%') != std::string::npos) {
      FailAt(source, name, copy, "no percent sign");
    }
    std::replace(copy.begin(), copy.end(), '%', kPercent);
    printer_.PushAttribute(name, copy.c_str());
  }

  [[noreturn]] void FailAt(const tinyxml2::XMLElement& source, const char* attribute,
                           std::string_view value, std::string_view expected) const {
    Fail(source.GetLineNum(),
         fmt::format("<{} {}={}>: expected {}", source.Name(), attribute, Quoted(value), expected));
  }

  const std::string file_;
  const UrdfGeometry geometry_;
  std::vector<std::string> mesh_files_;
  tinyxml2::XMLPrinter printer_{nullptr, true};
  int num_elements_ = 0;
};

}  // namespace

std::string ExtractUrdf(const std::string& text, const std::filesystem::path& file,
                        std::vector<std::string>* mesh_files, UrdfGeometry geometry) {
  Extraction extraction(file, geometry);
  std::string extract = extraction.Run(text);
  if (mesh_files != nullptr) *mesh_files = extraction.mesh_files();
  return extract;
}

std::string DecodeUrdfName(std::string name) {
  std::replace(name.begin(), name.end(), kPercent, '%');
  return name;
}

}  // namespace possibility::models
