#include "actions/wholebody/signal.h"

#include <algorithm>
#include <cmath>

namespace possibility::actions {

ScalarSignal RestToRest(double t, double duration) {
  const double s = std::clamp(t / duration, 0.0, 1.0);
  return {s * s * s * (10 + s * (6 * s - 15)),        //
          30 * s * s * (1 - s) * (1 - s) / duration,  //
          60 * s * (1 - s) * (1 - 2 * s) / (duration * duration)};
}

ScalarSignal EvenRestToRest(double t, double duration, double evenness) {
  if (evenness == 1) return RestToRest(t, duration);
  const double u = 1 - 2 * std::clamp(t / duration, 0.0, 1.0);
  const double n = 2 * evenness + 1;
  const double power = u * std::pow(std::abs(u), n - 1);
  // Integrals of the acceleration from the ends, and of the speed from the middle.
  const double speed = (1 - u * u) / 2 - (1 - u * power) / (n + 1);
  const double way = u / 2 - u * u * u / 6 - (u - u * u * power / (n + 2)) / (n + 1);
  const double mean = 1.0 / 3 - 1 / (n + 2);  // of `speed`
  return {0.5 - way / (2 * mean),             //
          speed / (mean * duration),          //
          2 * (u - power) / (mean * duration * duration)};
}

double RestToRestDuration(double distance, double acceleration) {
  // The quintic's acceleration peaks at s = (3 - sqrt(3)) / 6, with 10 / sqrt(3) d / T^2.
  return std::sqrt(10 / std::sqrt(3.0) * std::abs(distance) / acceleration);
}

ScalarSignal Bump(double t, double duration) {
  const double s = std::clamp(t / duration, 0.0, 1.0);
  const double u = s * (1 - s);
  const double du = 1 - 2 * s;
  return {64 * u * u * u,                  //
          64 * 3 * u * u * du / duration,  //
          64 * (6 * u * du * du - 6 * u * u) / (duration * duration)};
}

ScalarSignal Blend(double from, double to, const ScalarSignal& s) {
  const double change = to - from;
  return {from + s.value * change, s.rate * change, s.acceleration * change};
}

}  // namespace possibility::actions
