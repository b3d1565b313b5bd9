#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace possibility::experiments::testing {

/// All bytes of a file; nothing if it cannot be read.
inline std::string ReadText(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

}  // namespace possibility::experiments::testing
