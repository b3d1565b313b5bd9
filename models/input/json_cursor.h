#pragma once

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>

#include "models/input/json_text.h"

namespace possibility::models {

/// Parses a JSON document. `kind`: what was expected, for messages, such as "a FORMAT file".
/// @throws InputError if the text is not JSON, or an object has a key twice (the parser alone would
/// keep the last one).
nlohmann::json ParseJson(const std::string& text, const std::filesystem::path& file,
                         std::string_view kind);

/// A position in a JSON document that knows its path from the root, so that errors there are
/// reported with file and path. The path is only built when an error occurs.
/// A cursor must not outlive the cursor it came from.
class JsonCursor {
 public:
  /// The root. `file` is only used in messages.
  JsonCursor(const nlohmann::json& value, const std::filesystem::path& file)
      : value_(&value), file_(&file) {}

  /// @throws InputError unless this is an object whose "format" is `format`.
  void ExpectFormat(std::string_view format) const;

  /// @throws InputError unless this is an object with all of `keys` and no others except
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
