#include "actions/plan/plan_digits.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <string_view>

namespace possibility::actions {
namespace {

constexpr int kSignificant = 12;
/// Positions keep their decimals even far from the origin: the quintics between knots a few
/// milliseconds apart would turn rounding errors into accelerations.
constexpr int kSignificantOfPosition = 15;
constexpr double kLargestFixed = 1e15;
constexpr double kPowers[] = {1, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10};

int Significant(int decimals) {
  // More digits than a double guarantees would not read back to the same text.
  return decimals == PlanDigits::kPosition ? kSignificantOfPosition : kSignificant;
}

void RequireFinite(double x) {
  if (!std::isfinite(x)) throw std::invalid_argument("a plan holds a number that is not finite");
}

/// Decimal exponent of x != 0 rounded to `significant` digits.
int DecimalExponent(double x, int significant) {
  char text[32];
  const auto end =
      std::to_chars(text, text + sizeof text, x, std::chars_format::scientific, significant - 1)
          .ptr;
  *end = '\0';
  return std::atoi(std::find(text, end, 'e') + 1);
}

}  // namespace

void AppendRounded(double x, int decimals, std::string* text) {
  RequireFinite(x);
  if (std::abs(x) >= kLargestFixed) return AppendExact(x, text);
  const int significant = Significant(decimals);
  if (x != 0) {
    decimals = std::clamp(significant - 1 - DecimalExponent(x, significant), 0, decimals);
  }
  char digits[40];
  const char* end =
      std::to_chars(digits, digits + sizeof digits, x, std::chars_format::fixed, decimals).ptr;
  std::string_view number(digits, end - digits);
  if (decimals > 0) {
    number = number.substr(0, number.find_last_not_of('0') + 1);
    if (number.ends_with('.')) number.remove_suffix(1);
  }
  *text += number == "-0" ? "0" : number;
}

double Rounded(double x, int decimals) {
  // Scaled by the power of ten, such a number is an integer that a double holds exactly, and the
  // quotient is the double next to the decimal number.
  const double power = kPowers[decimals];
  if (std::abs(x) < kPowers[Significant(decimals) - 1 - decimals]) {
    return std::nearbyint(x * power) / power + 0.0;  // not -0, which is written as 0
  }
  std::string text;
  AppendRounded(x, decimals, &text);
  return std::strtod(text.c_str(), nullptr);
}

void AppendExact(double x, std::string* text) {
  RequireFinite(x);
  char digits[32];
  text->append(digits, std::to_chars(digits, digits + sizeof digits, x).ptr);
}

}  // namespace possibility::actions
