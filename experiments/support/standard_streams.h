#pragma once

#include <fmt/format.h>

#include <string_view>
#include <utility>

namespace possibility::experiments {

/// To be called first: a standard stream that the program was started without must not become the
/// first file that it opens, and a reader that is gone or a limit on file sizes gives an error in
/// place of a signal.
void PrepareStandardStreams();

/// Writes to standard output, at once.
/// @throws InputError if it cannot be written: its disk is full, its reader gone.
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
