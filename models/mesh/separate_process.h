#pragma once

#include <functional>
#include <optional>
#include <string>

namespace possibility::models {

/// Runs `work` in a process of its own and returns its result. Nothing if it crashed, took more
/// than `seconds` of processor time or too much memory, or if no process could be started; what it
/// prints is discarded. For libraries that do not survive every file.
std::optional<std::string> InSeparateProcess(const std::function<std::string()>& work,
                                             unsigned seconds);

}  // namespace possibility::models
