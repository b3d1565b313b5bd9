#include "experiments/support/option_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

#include "models/input/input_error.h"

namespace possibility::experiments {
namespace {

template <typename Number>
bool ParseAll(const std::string& text, Number* value) {
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, *value);
  return error == std::errc() && stop == end;
}

}  // namespace

std::uint64_t ParseInteger(const std::string& option, const std::string& text, std::uint64_t least,
                           std::uint64_t greatest) {
  std::uint64_t value = 0;
  if (!ParseAll(text, &value) || value < least || value > greatest) {
    throw InputError(fmt::format("{}: '{}' is not valid, expected an integer from {} to {}", option,
                                 text, least, greatest));
  }
  return value;
}

double ParseSeconds(const std::string& option, const std::string& text) {
  double value = 0;
  if (!ParseAll(text, &value) || !std::isfinite(value) || value <= 0) {
    throw InputError(fmt::format(
        "{}: '{}' is not valid, expected a finite number of seconds above 0", option, text));
  }
  return value;
}

std::vector<std::string> ParseNames(const std::string& option, const std::string& text) {
  std::vector<std::string> names;
  std::istringstream list(text + ",");
  for (std::string name; std::getline(list, name, ',');) {
    if (name.empty()) {
      throw InputError(fmt::format("{}: '{}' has an empty name, expected names separated by commas",
                                   option, text));
    }
    if (std::find(names.begin(), names.end(), name) != names.end()) {
      throw InputError(
          fmt::format("{}: '{}' names '{}' twice, expected each once", option, text, name));
    }
    names.push_back(name);
  }
  return names;
}

}  // namespace possibility::experiments
