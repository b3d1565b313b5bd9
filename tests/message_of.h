#pragma once

#include <functional>
#include <stdexcept>
#include <string>

namespace possibility {

/// What the Error that a call throws says, or "no error".
template <typename Error = std::invalid_argument>
std::string MessageOf(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace possibility
