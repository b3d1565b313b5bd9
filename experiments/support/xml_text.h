#pragma once

#include <string>

namespace possibility::experiments {

/// Escapes text between XML tags or in an attribute's quotes.
std::string XmlText(const std::string& text);

}  // namespace possibility::experiments
