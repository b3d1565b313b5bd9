#pragma once

#include <string>
#include <utility>

namespace possibility::experiments::testing {

/// Width and height in the header of a PNG; (0, 0) if it is none.
inline std::pair<int, int> PngSize(const std::string& png) {
  if (png.size() < 24 || png.substr(0, 8) != "\x89PNG\r\n\x1a\n") return {0, 0};
  const auto number = [&png](std::size_t at) {
    int value = 0;
    for (std::size_t i = at; i < at + 4; ++i)
      value = value << 8 | static_cast<unsigned char>(png[i]);
    return value;
  };
  return {number(16), number(20)};
}

}  // namespace possibility::experiments::testing
