#pragma once

#include <string>
#include <string_view>

namespace possibility::models {

class YamlNode;

/// The rule for action names, for messages.
inline constexpr const char* kActionNameRule =
    "a name of at most 64 letters, digits, '_' and '-' that begins with a letter";

/// Whether a gait, jump or manoeuvre may have this name. Such names are safe in terminals, web
/// pages, paths and "a->b".
bool IsActionName(std::string_view name);

/// Reads an action's name. @throws InputError at the node if the text may not be one.
std::string ReadActionName(const YamlNode& node);

}  // namespace possibility::models
