#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <string_view>
#include <utility>

namespace possibility::fuzz {

enum class Syntax { kYaml, kJson, kXml };

/// Spoils texts as people, editors, disks and attackers do. The same seed spoils a text in the same
/// way.
class Mutator {
 public:
  Mutator(Syntax syntax, std::uint64_t seed) : syntax_(syntax), random_(seed) {}

  /// One to three mutations.
  std::string operator()(std::string text);

 private:
  /// Begin and length; a length of 0 if nothing was found.
  using Stretch = std::pair<std::size_t, std::size_t>;

  void MutateOnce(std::string* text);
  void MutateNumber(std::string* text);
  void MutateWord(std::string* text);
  void MutateGroup(std::string* text);
  void MutateLine(std::string* text);
  void MutateBytes(std::string* text);
  void PlantBomb(std::string* text);

  std::size_t Below(std::size_t n) { return n == 0 ? 0 : random_() % n; }
  template <typename Array>
  std::string OneOf(const Array& array) {
    return std::string(array[Below(std::size(array))]);
  }
  std::string SpecialNumber();
  std::string SpecialText();
  std::string Nested(const std::string& inside);

  /// An occurrence behind a random place.
  Stretch Number(std::string_view text);
  Stretch Word(std::string_view text);
  /// A list or map in brackets, an XML element, or a YAML key with the lines indented below it.
  Stretch Group(std::string_view text);
  Stretch Line(std::string_view text);

  Syntax syntax_;
  std::mt19937_64 random_;
};

}  // namespace possibility::fuzz
