#pragma once

#include <string>
#include <string_view>

namespace possibility::experiments {

/// Base64 with padding (RFC 4648, section 4).
std::string Base64(std::string_view bytes);

}  // namespace possibility::experiments
