#include "experiments/support/base64.h"

#include <algorithm>
#include <cstdint>
#include <stdexcept>

namespace possibility::experiments {
namespace {

constexpr std::string_view kDigits =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

std::uint32_t ValueOf(char digit) {
  const std::size_t value = kDigits.find(digit);
  if (value == std::string_view::npos) throw std::invalid_argument("not base64");
  return static_cast<std::uint32_t>(value);
}

}  // namespace

std::string Base64(std::string_view bytes) {
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t j = 0; j < 3; ++j) {
      group = group << 8 | (j < count ? static_cast<unsigned char>(bytes[i + j]) : 0u);
    }
    for (std::size_t j = 0; j < 4; ++j) {
      text += j <= count ? kDigits[group >> (18 - 6 * j) & 63u] : '=';
    }
  }
  return text;
}

std::string FromBase64(std::string_view text) {
  if (text.size() % 4 != 0) throw std::invalid_argument("not base64");
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3);
  for (std::size_t i = 0; i < text.size(); i += 4) {
    const bool is_last = i + 4 == text.size();
    const std::size_t missing = !is_last               ? 0
                                : text.ends_with("==") ? 2
                                : text.ends_with("=")  ? 1
                                                       : 0;
    std::uint32_t group = 0;
    for (std::size_t j = 0; j < 4; ++j) {
      group = group << 6 | (j < 4 - missing ? ValueOf(text[i + j]) : 0u);
    }
    for (std::size_t j = 0; j < 3 - missing; ++j) {
      bytes += static_cast<char>(group >> (16 - 8 * j) & 255u);
    }
  }
  return bytes;
}

}  // namespace possibility::experiments
