#pragma once

#include <string>
#include <string_view>

namespace possibility::models {

class YamlNode;

/// What an action's name has to be, for messages.
inline constexpr const char* kActionNameRule =
    "a name of at most 64 letters, digits, '_' and '-' that begins with a letter";

/// Whether gaits, jumps and manoeuvres may be called so: names that neither a terminal nor a page,
/// a path or "a->b" takes for something else.
bool IsActionName(std::string_view name);

/// The text of a node. @throws InputError at it unless it may be an action's name.
std::string ReadActionName(const YamlNode& node);

}  // namespace possibility::models
