#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <string>

namespace possibility {

/// `text` with `to` for the first `from`, which must be there; `to` alone if `from` is empty.
inline std::string Replaced(std::string text, const std::string& from, const std::string& to) {
  if (from.empty()) return to;
  const std::size_t place = text.find(from);
  EXPECT_NE(place, std::string::npos) << from;
  if (place != std::string::npos) text.replace(place, from.size(), to);
  return text;
}

/// `text` with `to` for every `from`, of which there may be none.
inline std::string ReplacedEverywhere(std::string text, const std::string& from,
                                      const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size()) {
    text.replace(at, from.size(), to);
  }
  return text;
}

}  // namespace possibility
