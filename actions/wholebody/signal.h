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

/// From rest to rest, 0 to 1, by the acceleration u - u |u|^(2m) times a constant, with u from 1 to
/// -1 and m the `evenness`. 1: the quintic. The greater it is, the more evenly the speed is spread:
/// its peak falls from 1.875 to 1.5 times the mean, that of the acceleration rises from 5.77 to 6.
/// `evenness`: at least 1.
ScalarSignal EvenRestToRest(double t, double duration, double evenness);

/// Shortest time in which the quintic covers `distance` with peak acceleration `acceleration`.
double RestToRestDuration(double distance, double acceleration);

/// The bump 64 s^3 (1 - s)^3, 0 at both ends with zero rate and acceleration, 1 in the middle.
ScalarSignal Bump(double t, double duration);

/// The quintic that begins at `value` with `rate` and zero acceleration, and rests at 0 from
/// `duration` on.
template <typename T>
Signal<T> DyingOut(const T& value, const T& rate, double t, double duration) {
  const double s = t < duration ? t / duration : 1;
  const double s2 = s * s;
  const double s3 = s2 * s;
  return {T(value * (1 - s3 * (10 - 15 * s + 6 * s2)) +
            rate * (duration * (s - s3 * (6 - 8 * s + 3 * s2)))),
          T(value * (-30 * s2 * (1 - s) * (1 - s) / duration) +
            rate * (1 - s2 * (18 - 32 * s + 15 * s2))),
          T(value * (-60 * s * (1 - s) * (1 - 2 * s) / (duration * duration)) +
            rate * (-s * (36 - 96 * s + 60 * s2) / duration))};
}

/// The quintic that equals `from` at t = 0 and `to` at t = `duration`, in value and both
/// derivatives.
template <typename T>
Signal<T> Quintic(const Signal<T>& from, const Signal<T>& to, double t, double duration) {
  const double s = t / duration;
  const double d2 = duration * duration;
  const T c1 = from.rate * duration;
  const T c2 = from.acceleration * (d2 / 2);
  const T value = to.value - from.value - c1 - c2;
  const T rate = to.rate * duration - c1 - 2 * c2;
  const T acceleration = to.acceleration * d2 - 2 * c2;
  const T c3 = 10 * value - 4 * rate + acceleration / 2;
  const T c4 = -15 * value + 7 * rate - acceleration;
  const T c5 = 6 * value - 3 * rate + acceleration / 2;
  return {T(from.value + s * (c1 + s * (c2 + s * (c3 + s * (c4 + s * c5))))),
          T((c1 + s * (2 * c2 + s * (3 * c3 + s * (4 * c4 + s * 5 * c5)))) / duration),
          T((2 * c2 + s * (6 * c3 + s * (12 * c4 + s * 20 * c5))) / d2)};
}

template <typename T>
Signal<T> operator+(const Signal<T>& a, const Signal<T>& b) {
  return {T(a.value + b.value), T(a.rate + b.rate), T(a.acceleration + b.acceleration)};
}

/// from + s (to - from).
ScalarSignal Blend(double from, double to, const ScalarSignal& s);

template <typename Vector>
Signal<Vector> BlendVector(const Vector& from, const Vector& to, const ScalarSignal& s) {
  const Vector change = to - from;
  return {Vector(from + s.value * change), Vector(s.rate * change),
          Vector(s.acceleration * change)};
}

}  // namespace possibility::actions
