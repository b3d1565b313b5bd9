#pragma once

#include <algorithm>
#include <string>
#include <vector>

namespace possibility::experiments::testing {

/// Whether `text` is one XML element whose elements nest and close, attributes are quoted, and &
/// begins entities only. (XHTML's <meta charset> and <img/> close themselves.)
inline bool IsWellFormed(const std::string& text) {
  std::vector<std::string> open;
  std::size_t roots = 0, at = 0;
  while (at < text.size()) {
    if (text[at] == '&') {
      const std::size_t end = text.find(';', at);
      if (end == std::string::npos || end - at > 6) return false;
    }
    if (text[at] == '>') return false;
    if (text[at] != '<') {
      if (open.empty() && text[at] != '\n') return false;
      ++at;
      continue;
    }
    const std::size_t end = text.find('>', at);
    if (end == std::string::npos) return false;
    const std::string tag = text.substr(at + 1, end - at - 1);
    at = end + 1;
    if (tag.find('<') != std::string::npos) return false;
    if (std::count(tag.begin(), tag.end(), '"') % 2 != 0) return false;
    if (tag.front() == '/') {
      if (open.empty() || open.back() != tag.substr(1)) return false;
      open.pop_back();
      continue;
    }
    if (open.empty()) ++roots;
    if (tag.back() != '/') open.push_back(tag.substr(0, tag.find_first_of(" \n")));
  }
  return open.empty() && roots == 1;
}

}  // namespace possibility::experiments::testing
