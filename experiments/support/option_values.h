#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace possibility::experiments {

/// The value of an option as a decimal integer.
/// @throws InputError naming the option unless all of `text` is an integer within [least,
/// greatest].
std::uint64_t ParseInteger(const std::string& option, const std::string& text, std::uint64_t least,
                           std::uint64_t greatest);

/// The value of an option as a time, s.
/// @throws InputError naming the option unless all of `text` is a finite number above zero.
double ParseSeconds(const std::string& option, const std::string& text);

/// The names in a list separated by commas.
/// @throws InputError naming the option if a name is empty or occurs twice.
std::vector<std::string> ParseNames(const std::string& option, const std::string& text);

}  // namespace possibility::experiments
