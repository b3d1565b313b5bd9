#include "actions/json_cursor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "models/input_error.h"

namespace possibility::actions {
namespace {

/// A key as it may stand in a one-line message.
std::string Printable(const std::string& key) {
  const nlohmann::json json(key.substr(0, 40));
  return json.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
}

}  // namespace

void JsonCursor::ExpectKeys(std::initializer_list<std::string_view> keys) const {
  if (!value_->is_object()) {
    Fail(fmt::format("expected an object, got {}", value_->type_name()));
  }
  for (const std::string_view key : keys) {
    if (!value_->contains(key)) Fail(fmt::format("missing key \"{}\"", key));
  }
  for (const auto& [key, ignored] : value_->items()) {
    if (std::find(keys.begin(), keys.end(), key) == keys.end()) {
      Fail(fmt::format("unknown key {}, expected {}", Printable(key), fmt::join(keys, ", ")));
    }
  }
}

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

}  // namespace possibility::actions
