#pragma once

#include <string>
#include <string_view>

namespace possibility::experiments {

/// Base64 with padding (RFC 4648, section 4).
std::string Base64(std::string_view bytes);
/// The bytes of such a text. @throws std::invalid_argument if it is none.
std::string FromBase64(std::string_view text);

}  // namespace possibility::experiments
