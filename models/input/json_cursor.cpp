#include "models/input/json_cursor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <vector>

#include "models/input/input_error.h"

namespace possibility::models {
namespace {

/// A key, fit for a one-line message.
std::string QuotedKey(const std::string& key) {
  const nlohmann::ordered_json json(key.substr(0, 40));
  return AsciiJsonText(json);
}

/// Rejects duplicate keys of an object.
class DuplicateKeyGuard {
 public:
  explicit DuplicateKeyGuard(const std::filesystem::path& file) : file_(&file) {}

  bool operator()(int, nlohmann::json::parse_event_t event, const nlohmann::json& parsed) {
    using Event = nlohmann::json::parse_event_t;
    if (event == Event::object_start) keys_.emplace_back();
    if (event == Event::object_end) keys_.pop_back();
    if (event == Event::key && !keys_.back().insert(parsed).second) {
      throw InputError(fmt::format("{}: key {} stands twice in one object, expected once",
                                   file_->string(), QuotedKey(parsed)));
    }
    return true;
  }

 private:
  const std::filesystem::path* file_;
  std::vector<std::set<std::string>> keys_;
};

}  // namespace

nlohmann::json ParseJson(const std::string& text, const std::filesystem::path& file,
                         std::string_view kind) {
  try {
    DuplicateKeyGuard guard(file);
    return nlohmann::json::parse(text, std::ref(guard));
  } catch (const nlohmann::json::parse_error& error) {
    throw InputError(fmt::format("{}: not valid JSON at byte {} of {}, expected {}", file.string(),
                                 error.byte, text.size(), kind));
  } catch (const nlohmann::json::exception&) {
    throw InputError(fmt::format("{}: not valid JSON (a number is out of range), expected {}",
                                 file.string(), kind));
  }
}

void JsonCursor::ExpectFormat(std::string_view format) const {
  if (!value_->is_object() || !value_->contains("format")) {
    Fail(fmt::format("no \"format\", expected \"{}\"", format));
  }
  const JsonCursor cursor = (*this)["format"];
  const std::string found = cursor.String();
  if (found != format) {
    cursor.Fail(fmt::format("{}, expected \"{}\"", QuotedKey(found), format));
  }
}

void JsonCursor::ExpectKeys(std::initializer_list<std::string_view> keys,
                            std::initializer_list<std::string_view> optional) const {
  if (!value_->is_object()) {
    Fail(fmt::format("expected an object, got {}", value_->type_name()));
  }
  for (const std::string_view key : keys) {
    if (!value_->contains(key)) Fail(fmt::format("missing key \"{}\"", key));
  }
  const auto is_among = [](const std::string& key, const auto& names) {
    return std::find(names.begin(), names.end(), key) != names.end();
  };
  for (const auto& [key, ignored] : value_->items()) {
    if (!is_among(key, keys) && !is_among(key, optional)) {
      Fail(fmt::format("unknown key {}, expected {}", QuotedKey(key), fmt::join(keys, ", ")));
    }
  }
}

bool JsonCursor::Has(const char* key) const { return value_->is_object() && value_->contains(key); }

JsonCursor JsonCursor::operator[](const char* key) const {
  JsonCursor cursor(value_->at(key), *this);
  cursor.key_ = key;
  return cursor;
}

JsonCursor JsonCursor::operator[](std::size_t index) const {
  JsonCursor cursor((*value_)[index], *this);
  cursor.index_ = index;
  return cursor;
}

double JsonCursor::Number() const {
  if (!value_->is_number()) Fail(fmt::format("expected a number, got {}", value_->type_name()));
  const double number = value_->get<double>();
  if (!std::isfinite(number)) Fail("expected a finite number");
  return number;
}

std::int64_t JsonCursor::Integer(std::int64_t lowest, std::int64_t highest) const {
  const bool fits = value_->is_number_unsigned()
                        ? value_->get<std::uint64_t>() <= static_cast<std::uint64_t>(INT64_MAX)
                        : value_->is_number_integer();
  if (!fits || value_->get<std::int64_t>() < lowest || value_->get<std::int64_t>() > highest) {
    Fail(fmt::format("expected an integer from {} to {}", lowest, highest));
  }
  return value_->get<std::int64_t>();
}

std::uint64_t JsonCursor::Unsigned() const {
  if (!value_->is_number_unsigned()) Fail("expected an integer, zero or more");
  return value_->get<std::uint64_t>();
}

std::string JsonCursor::String() const {
  if (!value_->is_string()) Fail(fmt::format("expected a string, got {}", value_->type_name()));
  return value_->get<std::string>();
}

bool JsonCursor::Bool() const {
  if (!value_->is_boolean()) {
    Fail(fmt::format("expected true or false, got {}", value_->type_name()));
  }
  return value_->get<bool>();
}

std::size_t JsonCursor::ArraySize() const {
  if (!value_->is_array()) Fail(fmt::format("expected an array, got {}", value_->type_name()));
  return value_->size();
}

void JsonCursor::Fail(const std::string& message) const {
  const std::string path = Path();
  throw InputError(
      fmt::format("{}: {}{}{}", file_->string(), path, path.empty() ? "" : ": ", message));
}

std::string JsonCursor::Path() const {
  if (parent_ == nullptr) return {};
  const std::string parent = parent_->Path();
  if (key_ == nullptr) return fmt::format("{}[{}]", parent, index_);
  return parent.empty() ? key_ : fmt::format("{}.{}", parent, key_);
}

}  // namespace possibility::models
