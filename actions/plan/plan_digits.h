#pragma once

#include <string>

namespace possibility::actions {

/// Decimals of the numbers of a plan file (docs/file_formats.md, "Digits").
struct PlanDigits {
  static constexpr int kPosition = 10;     ///< m, rad, and parts of unit quaternions
  static constexpr int kRate = 9;          ///< m/s, rad/s
  static constexpr int kAcceleration = 8;  ///< m/s^2, rad/s^2
  static constexpr int kForce = 7;         ///< N, N m, N s
};

/// Appends x as JSON, rounded to so many decimals and to 12 significant digits at most, positions
/// to 15.
/// @throws std::invalid_argument if x is not finite.
void AppendRounded(double x, int decimals, std::string* text);

/// Appends x as JSON that reads back to the same bits. @throws std::invalid_argument likewise.
void AppendExact(double x, std::string* text);

}  // namespace possibility::actions
