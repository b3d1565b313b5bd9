#pragma once

#include <string>

namespace possibility::experiments {

/// The text with '_' for whatever is no ASCII letter, digit or '-': a name that every file system
/// allows. Empty if the text is.
std::string SafeFileName(std::string text);

}  // namespace possibility::experiments
