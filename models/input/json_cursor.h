#pragma once

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace possibility::models {

/// A JSON document. `kind` says what was expected, in messages: "a FORMAT file".
/// @throws InputError if the text is not JSON, or an object holds a key twice (of which the parser
/// alone would keep the last).
nlohmann::json ParseJson(const std::string& text, const std::filesystem::path& file,
                         std::string_view kind);

/// A place in a JSON document that knows its way from the root, so that whatever is wrong there
/// can be reported with file and path. The path is only spelled out when something is wrong.
/// A cursor must not outlive the cursor it came from.
class JsonCursor {
 public:
  /// The root. `file` is only named in messages.
  JsonCursor(const nlohmann::json& value, const std::filesystem::path& file)
      : value_(&value), file_(&file) {}

  /// @throws InputError unless this is an object whose "format" is this.
  void ExpectFormat(std::string_view format) const;

  /// @throws InputError unless this is an object with all of `keys` and none but them and
  /// `optional`, in any order.
  void ExpectKeys(std::initializer_list<std::string_view> keys,
                  std::initializer_list<std::string_view> optional = {}) const;

  /// Whether this is an object with such a key.
  bool Has(const char* key) const;

  /// Members; the key or index must exist.
  JsonCursor operator[](const char* key) const;
  JsonCursor operator[](std::size_t index) const;

  const nlohmann::json& value() const { return *value_; }

  /// Values of the expected type. @throws InputError otherwise.
  double Number() const;
  std::int64_t Integer(std::int64_t lowest, std::int64_t highest) const;
  std::uint64_t Unsigned() const;
  std::string String() const;
  bool Bool() const;
  std::size_t ArraySize() const;

  /// @throws InputError "FILE: PATH: MESSAGE".
  [[noreturn]] void Fail(const std::string& message) const;

 private:
  JsonCursor(const nlohmann::json& value, const JsonCursor& parent)
      : value_(&value), file_(parent.file_), parent_(&parent) {}

  std::string Path() const;

  const nlohmann::json* value_;
  const std::filesystem::path* file_;
  const JsonCursor* parent_ = nullptr;
  const char* key_ = nullptr;
  std::size_t index_ = 0;
};

}  // namespace possibility::models
