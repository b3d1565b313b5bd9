#pragma once

#include <Eigen/Core>

namespace possibility::actions {

/// Value and its first two time derivatives.
template <typename T>
struct Signal {
  T value{};
  T rate{};
  T acceleration{};
};

using ScalarSignal = Signal<double>;

inline ScalarSignal Constant(double value) { return {value, 0, 0}; }

template <typename Vector>
Signal<Vector> ConstantVector(const Vector& value) {
  return {value, Vector::Zero(value.size()), Vector::Zero(value.size())};
}

/// The rest-to-rest quintic 10 s^3 - 15 s^4 + 6 s^5 of s = t / duration, from 0 to 1.
ScalarSignal RestToRest(double t, double duration);

/// Shortest time in which the quintic covers `distance` with peak acceleration `acceleration`.
double RestToRestDuration(double distance, double acceleration);

/// The bump 64 s^3 (1 - s)^3, 0 at both ends with zero rate and acceleration, 1 in the middle.
ScalarSignal Bump(double t, double duration);

/// from + s (to - from).
ScalarSignal Blend(double from, double to, const ScalarSignal& s);

template <typename Vector>
Signal<Vector> BlendVector(const Vector& from, const Vector& to, const ScalarSignal& s) {
  const Vector change = to - from;
  return {Vector(from + s.value * change), Vector(s.rate * change),
          Vector(s.acceleration * change)};
}

}  // namespace possibility::actions
