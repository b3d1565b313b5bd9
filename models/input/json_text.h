#pragma once

#include <nlohmann/json.hpp>
#include <string>

// Instantiated in json_text.cpp only: every file that uses JSON would take a second longer to
// compile.
extern template class nlohmann::basic_json<nlohmann::ordered_map>;

namespace possibility::models {

/// The value as text. Bytes that are not UTF-8 become U+FFFD. `indent`: spaces per level; -1: one
/// line.
std::string JsonText(const nlohmann::ordered_json& json, int indent = -1);
std::string JsonText(const nlohmann::json& json);
/// The value on one line in ASCII.
std::string AsciiJsonText(const nlohmann::ordered_json& json);

}  // namespace possibility::models
