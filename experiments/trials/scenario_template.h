#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

namespace possibility::experiments {

/// A scenario YAML with placeholders (docs/experiments.md):
///   ${gap + 0.5}                       the value of an expression
///   ${actions of walk, crawl, jump}    the first so many of the words
///   - posts: {count: ${count}, ...}    in a list: a field of obstacles (post_field.h)
class ScenarioTemplate {
 public:
  /// @throws InputError if the file cannot be read.
  explicit ScenarioTemplate(std::filesystem::path file);

  const std::filesystem::path& file() const { return file_; }
  const std::string& content_hash() const { return content_hash_; }
  /// Whether some placeholder uses the name.
  bool Mentions(const std::string& name) const;

  /// The text of a scenario to be saved in `folder`: placeholders replaced, obstacle fields
  /// generated from `seed`, and the paths of the robot, of meshes and of height maps
  /// relative to that folder.
  /// @throws InputError naming file and line.
  std::string Instantiate(const std::map<std::string, double>& names, std::uint64_t seed,
                          const std::filesystem::path& folder) const;

 private:
  std::filesystem::path file_;
  std::string text_;
  std::string content_hash_;
};

}  // namespace possibility::experiments
