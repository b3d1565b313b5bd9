#include "actions/motion/swing_path.h"

#include <algorithm>

namespace possibility::actions {
namespace {

/// Shares of a high swing's duration: up until, down from, and across in between. Where the patch
/// is 6 % across, it is 93 % up.
constexpr double kUp = 0.45;
constexpr double kDown = 1 - kUp;
constexpr double kAcross = 0.25;

}  // namespace

ScalarSignal SwingPath::Progress(double t) const {
  if (!IsHigh()) return EvenRestToRest(t, duration, evenness);
  return RestToRest(t - kAcross * duration, (1 - 2 * kAcross) * duration);
}

Signal<Eigen::Vector3d> SwingPath::At(double t) const {
  Signal<Eigen::Vector3d> position = BlendVector<Eigen::Vector3d>(from, to, Progress(t));
  ScalarSignal height;
  if (IsHigh()) {
    const double top = std::max(from.z(), to.z()) + std::max(lift, clearance);
    height = Blend(from.z(), top, RestToRest(t, kUp * duration)) +
             Blend(0, to.z() - top, RestToRest(t - kDown * duration, (1 - kDown) * duration));
  } else {
    height = Blend(from.z(), from.z() + clearance, Bump(t, duration));
    if (on_slope) height = height + Blend(0, to.z() - from.z(), Progress(t));
  }
  position.value.z() = height.value;
  position.rate.z() = height.rate;
  position.acceleration.z() = height.acceleration;
  return position;
}

}  // namespace possibility::actions
