#include "experiments/viewer/viewer_margins.h"

#include <cmath>
#include <limits>

namespace possibility::experiments {
namespace {

constexpr int kDistances = 4;  // of the numbers, at the front: less is worse

double ValueOf(const actions::Margin& margin) {
  return margin.segment < 0 ? std::numeric_limits<double>::quiet_NaN() : margin.value;
}

double RoundedTo(double value, double parts) { return std::round(value * parts) / parts; }

FrameMargins::Numbers NumbersOf(const actions::PlanMargins& margins) {
  FrameMargins::Numbers numbers;
  numbers << ValueOf(margins.zmp), ValueOf(margins.ground_edge), ValueOf(margins.self_distance),
      ValueOf(margins.obstacle_distance), ValueOf(margins.torque), ValueOf(margins.friction),
      ValueOf(margins.joint_speed);
  return numbers;
}

}  // namespace

FrameMargins::FrameMargins(const models::RobotModel& robot, const models::Environment& environment)
    : ground_(environment, robot.friction), instants_(robot, environment, ground_) {}

FrameMargins::Numbers FrameMargins::Worst(const actions::Phase& phase, std::size_t first,
                                          std::size_t last) {
  Numbers worst = Numbers::Constant(std::numeric_limits<double>::quiet_NaN());
  for (std::size_t k = first; k <= last; ++k) {
    const Numbers here = NumbersOf(instants_.At(0, phase, phase.knots[k]));
    for (int i = 0; i < kDistances; ++i) worst[i] = std::fmin(worst[i], here[i]);
    for (int i = kDistances; i < worst.size(); ++i) worst[i] = std::fmax(worst[i], here[i]);
  }
  for (int i = 0; i < worst.size(); ++i) {
    worst[i] = RoundedTo(worst[i], i < kDistances ? 1e5 : 1e4);
  }
  return worst;
}

}  // namespace possibility::experiments
