#pragma once

#include <stdexcept>
#include <string>

namespace possibility {

/// Thrown for input errors that the user can fix: a malformed file, an unknown key, a number out of
/// range, a start in collision. The message is one line that names the file, the line or key, the
/// error and what was expected. The program prints it and exits with 1.
class InputError : public std::runtime_error {
 public:
  explicit InputError(const std::string& message) : std::runtime_error(message) {}
};

}  // namespace possibility
