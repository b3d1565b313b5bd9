#pragma once

#include <fmt/format.h>

#include <string_view>
#include <utility>

namespace possibility::experiments {

/// Must be called first. Opens standard streams that are closed, so that the first file opened does
/// not take their place. Makes a closed pipe or a limit on file sizes give an error instead of a
/// signal.
void PrepareStandardStreams();

/// Writes to standard output, without buffering.
/// @throws InputError if it cannot be written: disk full, or reader closed.
void WriteStandardOutput(std::string_view text);

/// Writes to standard error, if it can be written.
void WriteStandardError(std::string_view text) noexcept;

/// WriteStandardOutput of a formatted text.
template <typename... Arguments>
void PrintOut(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  WriteStandardOutput(fmt::format(format, std::forward<Arguments>(arguments)...));
}

/// WriteStandardError of a formatted text.
template <typename... Arguments>
void PrintError(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  WriteStandardError(fmt::format(format, std::forward<Arguments>(arguments)...));
}

}  // namespace possibility::experiments
