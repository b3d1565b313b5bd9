#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <string>

#include "models/input/input_error.h"

namespace possibility::models {

/// @throws InputError that names the file and says what is wrong in it.
[[noreturn]] inline void FailAt(const std::filesystem::path& file, const std::string& what) {
  throw InputError(fmt::format("{}: {}", file.string(), what));
}

}  // namespace possibility::models
