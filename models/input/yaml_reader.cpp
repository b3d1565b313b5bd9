#include "models/input/yaml_reader.h"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <set>
#include <sstream>

#include "models/input/input_error.h"
#include "models/input/nearest_name.h"

namespace possibility::models {
namespace {

bool IsPrintable(const std::string& text) {
  return std::none_of(text.begin(), text.end(),
                      [](unsigned char c) { return c < 0x20 || c == 0x7f; });
}

// Messages are one line, whatever the file contains.
std::string Printable(std::string text) {
  constexpr std::size_t kLongest = 60;
  if (text.size() > kLongest) text.replace(kLongest, std::string::npos, "...");
  for (char& c : text) {
    if (const auto u = static_cast<unsigned char>(c); u < 0x20 || u == 0x7f) c = ' ';
  }
  return text;
}

// Lengths, angles and forces beyond this are typing errors and would overflow when squared.
constexpr double kLargestNumber = 1e6;

// Ignores what a parser finds.
class NullHandler : public YAML::EventHandler {
 public:
  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
  void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t,
                const std::string&) override {}
  void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {}
  void OnMapEnd() override {}
};

// YAML::Load silently stops after the first document. YAML::LoadAll never returns for a text that
// goes on with a stray comma or bracket.
bool IsSingleDocument(const std::string& text) {
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  NullHandler ignore;
  return parser.HandleNextDocument(ignore) && !parser.HandleNextDocument(ignore);
}

std::string WithoutTrailingStop(std::string text) {
  while (!text.empty() && text.back() == '.') text.pop_back();
  return text;
}

}  // namespace

YamlNode::YamlNode(const YAML::Node& node, int line, std::shared_ptr<const std::string> file,
                   std::string path)
    : node_(std::make_shared<YAML::Node>(node)),
      line_(line),
      file_(std::move(file)),
      path_(std::move(path)) {}

YamlNode YamlNode::Child(const YAML::Node& node, int line, std::string path) const {
  return YamlNode(node, line, file_, std::move(path));
}

YamlNode YamlNode::Parse(const std::string& text, const std::filesystem::path& file) {
  const auto name = std::make_shared<const std::string>(file.string());
  try {
    const YAML::Node document = YAML::Load(text);
    if (document.IsNull()) throw InputError(*name + ": expected a YAML map, got nothing");
    if (!IsSingleDocument(text)) {
      throw InputError(*name + ": expected one YAML document and nothing after it");
    }
    return YamlNode(document, document.Mark().line, name, "");
  } catch (const YAML::Exception& error) {
    throw InputError(fmt::format("{}:{}: not valid YAML: {}", *name,
                                 std::max(error.mark.line, 0) + 1,
                                 Printable(WithoutTrailingStop(error.msg))));
  }
}

void YamlNode::Fail(const std::string& what) const {
  throw InputError(fmt::format("{}{}: {}{}", *file_, line_ < 0 ? "" : fmt::format(":{}", line_ + 1),
                               path_.empty() ? "" : path_ + ": ", what));
}

void YamlNode::FailExpected(const std::string& expected) const {
  Fail(fmt::format("expected {}, got {}", expected, Described()));
}

std::string YamlNode::Described() const {
  switch (node_->Type()) {
    case YAML::NodeType::Scalar:
      return node_->Scalar().empty() ? "an empty text" : Printable(node_->Scalar());
    case YAML::NodeType::Sequence:
      return node_->size() == 0 ? "an empty list" : fmt::format("a list of {}", node_->size());
    case YAML::NodeType::Map:
      return "a map";
    default:
      return "nothing";
  }
}

std::vector<std::pair<YamlNode, YamlNode>> YamlNode::KeysAndValues() const {
  if (!node_->IsMap()) FailExpected("a map");
  std::vector<std::pair<YamlNode, YamlNode>> pairs;
  std::set<std::string> seen;
  for (const auto& entry : *node_) {
    const YAML::Node& key_node = entry.first;
    const YAML::Node& value_node = entry.second;
    const int key_line = key_node.Mark().line;
    const YamlNode key = Child(key_node, key_line, path_);
    if (!key_node.IsScalar()) key.FailExpected("a key");
    const std::string name = Printable(key_node.Scalar());
    if (!seen.insert(key_node.Scalar()).second) {
      key.Fail(fmt::format("the key '{}' appears twice", name));
    }
    // The mark of an absent value is where the next token starts.
    const int line = value_node.IsNull() ? key_line : value_node.Mark().line;
    pairs.emplace_back(key, Child(value_node, line, path_.empty() ? name : path_ + "." + name));
  }
  return pairs;
}

std::vector<std::pair<std::string, YamlNode>> YamlNode::Entries() const {
  std::vector<std::pair<std::string, YamlNode>> entries;
  for (const auto& [key, value] : KeysAndValues()) entries.emplace_back(key.node_->Scalar(), value);
  return entries;
}

const YamlNode& YamlNode::MapOf(const std::vector<std::string>& known) const {
  for (const auto& [key, value] : KeysAndValues()) {
    const std::string& name = key.node_->Scalar();
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    key.Fail(fmt::format("unknown key '{}'{}", Printable(name), DidYouMean(name, known)));
  }
  return *this;
}

std::optional<YamlNode> YamlNode::Find(const std::string& key) const {
  for (auto& [name, value] : Entries()) {
    if (name == key) return std::move(value);
  }
  return std::nullopt;
}

YamlNode YamlNode::At(const std::string& key) const {
  std::optional<YamlNode> value = Find(key);
  if (!value) Fail(fmt::format("the key '{}' is missing", key));
  return *std::move(value);
}

std::vector<YamlNode> YamlNode::Items() const {
  if (!node_->IsSequence()) FailExpected("a list");
  std::vector<YamlNode> items;
  for (const YAML::Node& item : *node_) {
    const int line = item.IsNull() ? line_ : item.Mark().line;
    items.push_back(Child(item, line, fmt::format("{}[{}]", path_, items.size())));
  }
  return items;
}

std::string YamlNode::String() const {
  if (!node_->IsScalar() || node_->Scalar().empty()) FailExpected("a text");
  if (!IsPrintable(node_->Scalar())) FailExpected("a text without control characters");
  return node_->Scalar();
}

std::vector<std::string> YamlNode::Strings() const {
  std::vector<std::string> strings;
  for (const YamlNode& item : Items()) strings.push_back(item.String());
  return strings;
}

bool YamlNode::Boolean() const {
  if (node_->IsScalar() && node_->Scalar() == "true") return true;
  if (node_->IsScalar() && node_->Scalar() == "false") return false;
  FailExpected("true or false");
}

std::optional<double> YamlNode::ParsedNumber() const {
  if (!node_->IsScalar()) return std::nullopt;
  std::string_view text = node_->Scalar();
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

double YamlNode::Number() const {
  const std::optional<double> value = ParsedNumber();
  if (!value) FailExpected("a number");
  if (!std::isfinite(*value)) FailExpected("a finite number");
  if (std::abs(*value) > kLargestNumber) FailExpected("a number of at most 1e6 in magnitude");
  return *value;
}

double YamlNode::Number(double lowest, double highest) const {
  const double value = Number();
  if (value < lowest || value > highest) {
    FailExpected(fmt::format("a number from {} to {}", lowest, highest));
  }
  return value;
}

double YamlNode::Positive() const {
  const double value = Number();
  if (!(value > 0)) FailExpected("a positive number");
  return value;
}

double YamlNode::NonNegative() const {
  const double value = Number();
  if (value < 0) FailExpected("a number of at least 0");
  return value;
}

double YamlNode::Degrees() const { return Number() * std::numbers::pi / 180; }

std::uint64_t YamlNode::Integer(std::uint64_t lowest, std::uint64_t highest) const {
  const std::string& text = node_->IsScalar() ? node_->Scalar() : std::string();
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || error != std::errc() || end != text.data() + text.size() || value < lowest ||
      value > highest) {
    FailExpected(fmt::format("a whole number from {} to {}", lowest, highest));
  }
  return value;
}

std::optional<std::vector<double>> YamlNode::FiniteNumbers(std::size_t count,
                                                           std::string* got) const {
  *got = Described();
  if (!node_->IsSequence() || node_->size() != count) return std::nullopt;
  std::vector<double> numbers;
  for (const YamlNode& item : Items()) {
    const std::optional<double> number = item.ParsedNumber();
    if (!number || !(std::abs(*number) <= kLargestNumber)) {
      *got = item.Described();
      return std::nullopt;
    }
    numbers.push_back(*number);
  }
  return numbers;
}

Eigen::Vector3d YamlNode::Vector3() const {
  std::string got;
  const auto numbers = FiniteNumbers(3, &got);
  if (!numbers) Fail("expected three numbers, got " + got);
  return Eigen::Vector3d::Map(numbers->data());
}

Eigen::Vector3d YamlNode::PositiveVector3() const {
  std::string got;
  const auto numbers = FiniteNumbers(3, &got);
  if (!numbers) Fail("expected three positive numbers, got " + got);
  for (const YamlNode& item : Items()) {
    if (!(item.Number() > 0)) Fail("expected three positive numbers, got " + item.Described());
  }
  return Eigen::Vector3d::Map(numbers->data());
}

Eigen::Vector2d YamlNode::Interval() const {
  std::string got;
  const auto numbers = FiniteNumbers(2, &got);
  if (!numbers) Fail("expected [lowest, highest], got " + got);
  if (!((*numbers)[0] < (*numbers)[1])) {
    Fail(fmt::format("expected [lowest, highest], got [{}, {}]", (*numbers)[0], (*numbers)[1]));
  }
  return Eigen::Vector2d::Map(numbers->data());
}

}  // namespace possibility::models
