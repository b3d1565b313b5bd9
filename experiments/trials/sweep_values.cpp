#include "experiments/trials/sweep_values.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <optional>
#include <sstream>

#include "models/input/input_error.h"

namespace possibility::experiments {
namespace {

std::optional<double> Number(const std::string& text) {
  double value = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool is_all = error == std::errc() && stop == text.data() + text.size();
  if (!is_all || !(std::abs(value) <= 1e6)) return std::nullopt;
  return value;
}

std::optional<std::vector<double>> Numbers(const std::string& text, char separator) {
  std::vector<double> values;
  std::istringstream stream(text + separator);
  for (std::string word; std::getline(stream, word, separator);) {
    const std::optional<double> value = Number(word);
    if (!value) return std::nullopt;
    values.push_back(*value);
  }
  return values;
}

/// Rounds to twelve digits, as written into the scenario.
double Rounded(double value) { return *Number(fmt::format("{:.12g}", value)); }

std::vector<double> Range(double first, double last, double step) {
  std::vector<double> values;
  const double count = std::floor((last - first) / step + 1e-9);
  for (int i = 0; i <= count && values.size() <= kMaxSweepValues; ++i) {
    values.push_back(Rounded(first + i * step));
  }
  return values;
}

}  // namespace

std::vector<double> ParseSweepValues(const std::string& option, const std::string& text) {
  const bool is_range = text.find(':') != std::string::npos;
  std::optional<std::vector<double>> values = Numbers(text, is_range ? ':' : ',');
  bool is_valid = values.has_value();
  if (is_valid && is_range) {
    is_valid = values->size() == 3 && (*values)[2] > 0 && (*values)[0] <= (*values)[1];
    if (is_valid) values = Range((*values)[0], (*values)[1], (*values)[2]);
  }
  for (std::size_t i = 1; is_valid && i < values->size(); ++i) {
    is_valid = (*values)[i] > (*values)[i - 1];
  }
  if (is_valid && values->size() <= kMaxSweepValues) return *values;
  throw InputError(fmt::format(
      "{}: '{}' is not valid, expected FIRST:LAST:STEP or ascending numbers and commas, at most {} "
      "values of at most 1e6",
      option, text, kMaxSweepValues));
}

}  // namespace possibility::experiments
