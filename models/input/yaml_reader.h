#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace YAML {
class Node;
}

namespace possibility::models {

/// A value of a YAML file with its file, line and path. Every reader throws InputError "file:line:
/// path.to.key: expected this, got that"; nothing is converted or defaulted silently.
class YamlNode {
 public:
  /// The single document of `text`; `file` is for messages only.
  static YamlNode Parse(const std::string& text, const std::filesystem::path& file);

  /// Throws InputError about this value.
  [[noreturn]] void Fail(const std::string& what) const;
  /// Fail with "expected `expected`, got <this value>".
  [[noreturn]] void FailExpected(const std::string& expected) const;

  /// This value as a map with no keys other than `known`, each at most once.
  const YamlNode& MapOf(const std::vector<std::string>& known) const;
  /// A required key of a map.
  YamlNode At(const std::string& key) const;
  /// An optional key of a map.
  std::optional<YamlNode> Find(const std::string& key) const;
  /// Keys and values of a map in file order, each key once.
  std::vector<std::pair<std::string, YamlNode>> Entries() const;
  /// Elements of a list.
  std::vector<YamlNode> Items() const;

  std::string String() const;  ///< not empty, printable characters only
  std::vector<std::string> Strings() const;
  bool Boolean() const;                                ///< true or false
  double Number() const;                               ///< at most 1e6 in magnitude
  double Number(double lowest, double highest) const;  ///< bounds included
  double Positive() const;
  double NonNegative() const;
  double Degrees() const;  ///< degrees in the file; returns rad
  std::uint64_t Integer(std::uint64_t lowest, std::uint64_t highest) const;
  Eigen::Vector3d Vector3() const;
  Eigen::Vector3d PositiveVector3() const;
  /// A list [lowest, highest], lowest < highest.
  Eigen::Vector2d Interval() const;

 private:
  YamlNode(const YAML::Node& node, int line, std::shared_ptr<const std::string> file,
           std::string path);
  YamlNode Child(const YAML::Node& node, int line, std::string path) const;
  /// Keys as nodes at this value's path, and their values; each key once.
  std::vector<std::pair<YamlNode, YamlNode>> KeysAndValues() const;
  /// The `count` numbers of a list; nullopt unless all are numbers in range.
  std::optional<std::vector<double>> FiniteNumbers(std::size_t count, std::string* got) const;
  /// The scalar as a double (inf and nan included); nullopt if it is not a number.
  std::optional<double> ParsedNumber() const;
  std::string Described() const;

  std::shared_ptr<const YAML::Node> node_;
  int line_;  ///< from 0; negative if unknown
  std::shared_ptr<const std::string> file_;
  std::string path_;
};

}  // namespace possibility::models
