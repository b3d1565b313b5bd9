#pragma once

#include <string>

namespace possibility::actions {

/// Decimals of the numbers of a plan file (docs/file_formats.md, "Digits").
struct PlanDigits {
  static constexpr int kPosition = 10;     ///< m, rad, and components of unit quaternions
  static constexpr int kRate = 9;          ///< m/s, rad/s
  static constexpr int kAcceleration = 8;  ///< m/s^2, rad/s^2
  static constexpr int kForce = 7;         ///< N, N m, N s
};

/// Appends x as JSON, rounded to `decimals` decimals and at most 12 significant digits (15 for
/// positions).
/// @throws std::invalid_argument if x is not finite.
void AppendRounded(double x, int decimals, std::string* text);

/// x as AppendRounded writes it. @throws std::invalid_argument likewise.
double Rounded(double x, int decimals = PlanDigits::kPosition);

/// Appends x as JSON that reads back to the same bits. @throws std::invalid_argument likewise.
void AppendExact(double x, std::string* text);

}  // namespace possibility::actions
